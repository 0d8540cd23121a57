// What an input is made of: its files, their size and age, and a hash of what is in them.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace plc::tools {

// XXH64 as 16 hexadecimal digits, as `xxh64sum` prints it.
std::string content_hash(std::string_view text);

// The files that reading `path` reads: itself, what the header of a .mhd or .nhdr names, the other
// half of an Analyze pair, or all of a folder. Sorted. Throws Failure where it is not there.
std::vector<std::string> files_of(const std::string& path);

// What tells without reading that an input is as it was.
struct Stamp {
  uint64_t bytes = 0;
  int64_t modified = 0;  // of the newest file, nanoseconds since 1970
  bool operator==(const Stamp&) const = default;
};

Stamp stamp_of(const std::string& path);

// Of one file the hash of its bytes; of several that of the lines "HASH  NAME", names relative to
// the folder. Throws Failure.
std::string hash_of(const std::string& path);

}  // namespace plc::tools
