// The page of `pellicle view` as it is before images and surfaces are put in: tools/view/build_page
// makes it from tools/view/page/ when the project is built.
#pragma once
#include <string_view>

namespace plc::tools {

struct PageSource {
  std::string_view before, after;  // what is written around the data
  std::string_view missing;        // where there is no page: what it has been missing, else empty
};

PageSource page_source();

}  // namespace plc::tools
