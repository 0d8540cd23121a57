// The command line of `pellicle extract`: every option's value, and the structures in it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "tests/fuzz/input.h"
#include "tools/command/extract_options.h"
#include "tools/command/option_values.h"

namespace fuzz {

namespace {

std::vector<std::string> words_of(Bytes bytes) {
  std::vector<std::string> words(1);
  for (const uint8_t byte : bytes) {
    if (byte == 0) {
      words.emplace_back();
    } else {
      words.back() += static_cast<char>(byte);
    }
  }
  return words;
}

}  // namespace

void options(Bytes words) {
  CLI::App app;
  plc::tools::ExtractOptions options;
  plc::tools::add_extract_options(app, options);
  plc::tools::demand_file_names(app);
  std::vector<std::string> reversed = words_of(words);
  std::reverse(reversed.begin(), reversed.end());  // as CLI11 wants them
  try {
    app.parse(reversed);
    plc::tools::read_structures(options);
  } catch (const CLI::ParseError& error) {
    require(error.what()[0] != '\0', "an error without a message");
    return;
  }
  require(!options.output.empty(), "no output, and no error");
  require(options.parameters.levels >= -1 && options.parameters.levels < PLC_MAX_LEVELS,
          "levels out of range");
  require(options.parameters.level_iso_count <= PLC_MAX_LEVELS, "too many iso-values of levels");
  require(!plc::tools::init_text(options).empty(), "a start without a name");
  require(!plc::tools::rest_length_text(options.parameters).empty(), "a length without a text");
  for (const plc_seed& seed : options.seeds) require(seed.radius > 0, "a seed without a radius");
}

}  // namespace fuzz
