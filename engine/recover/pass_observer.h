// Who looks at the state of a run between its passes: the tests that ask which pass is the first in
// which two runs differ.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

namespace plc {

class Evolution;

// Called after a pass, by its name in the tables of dynamics.h and evolution.cpp, and the resources
// that it writes, while nothing runs; of passes that may run at the same time after the last, with
// all their names. The mesh may be changed from here: the next pass works on what it finds.
using PassObserver =
    std::function<void(const std::string& pass, uint32_t writes, const Evolution& evolution)>;

}  // namespace plc
