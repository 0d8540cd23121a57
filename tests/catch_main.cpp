// The main() of every test program.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#if PELLICLE_TBB
#include <oneapi/tbb/global_control.h>

namespace {

// oneTBB gives a process as many threads as there are cores; tests of many threads want them all.
const oneapi::tbb::global_control kThreads(oneapi::tbb::global_control::max_allowed_parallelism,
                                           16);

}  // namespace
#endif
