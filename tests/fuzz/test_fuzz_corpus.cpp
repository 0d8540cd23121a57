// Every fuzz target over what was once wrong: tests/fuzz/corpus/TARGET/, a file each. What
// libFuzzer finds goes there when it is mended.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/targets.h"

namespace {

std::vector<std::filesystem::path> files_of(const std::string& target) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path folder = std::filesystem::path(PELLICLE_FUZZ_CORPUS) / target;
  if (!std::filesystem::exists(folder)) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_CASE("What was once wrong is right, and stays so", "[fuzz]") {
  size_t tried = 0;
  for (const fuzz::Target& target : fuzz::kTargets) {
    for (const std::filesystem::path& file : files_of(target.name)) {
      INFO(file.string());
      const std::vector<uint8_t> bytes = bytes_of(file);
      CHECK_NOTHROW(target.run(bytes));
      ++tried;
    }
  }
  CHECK(tried > 0);
}

TEST_CASE("Targets take nothing, and bytes that mean nothing", "[fuzz]") {
  uint64_t random = 1;
  for (const fuzz::Target& target : fuzz::kTargets) {
    INFO(target.name);
    for (size_t size = 0; size < 300; size = 2 * size + 1) {
      std::vector<uint8_t> bytes(size);
      for (uint8_t& byte : bytes) {
        random = random * 6364136223846793005U + 1442695040888963407U;
        byte = static_cast<uint8_t>(random >> 56);
      }
      CHECK_NOTHROW(target.run(bytes));
    }
  }
}

TEST_CASE("Every folder of the corpus is that of a target", "[fuzz]") {
  for (const auto& entry : std::filesystem::directory_iterator(PELLICLE_FUZZ_CORPUS)) {
    const std::string name = entry.path().filename().string();
    INFO(name);
#ifdef PELLICLE_FUZZ_READERS
    CHECK(std::any_of(std::begin(fuzz::kTargets), std::end(fuzz::kTargets),
                      [&](const fuzz::Target& target) { return name == target.name; }));
#endif
  }
}
