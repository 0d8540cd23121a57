#include "tools/volume/label_names.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "tools/file/failure.h"
#include "tools/file/path_suffix.h"
#include "tools/file/printable.h"
#include "tools/file/utf8.h"
#include "tools/volume/labels.h"

namespace plc::tools {

namespace {

constexpr uintmax_t kLargestFile = 16U << 20U;
constexpr size_t kLongestName = 200;
constexpr size_t kLutColours = 256;
constexpr const char* kFreeSurfer = "FreeSurferColorLUT.txt";

struct Word {
  std::string text;
  bool quoted = false;
};

std::optional<int32_t> to_label(const Word& word) {
  int32_t value = 0;
  const char* end = word.text.data() + word.text.size();
  const auto read = std::from_chars(word.text.data(), end, value);
  if (word.quoted || read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return value;
}

bool is_byte(const Word& word) {
  const std::optional<int32_t> value = to_label(word);
  return value && *value >= 0 && *value <= 255;
}

using Words = std::vector<Word>;

std::array<uint8_t, 3> rgb_of(const Words& words, size_t first) {
  std::array<uint8_t, 3> rgb{};
  for (size_t k = 0; k < 3; ++k) rgb[k] = static_cast<uint8_t>(*to_label(words[first + k]));
  return rgb;
}

std::string joined(const Words& words, size_t first, size_t last) {
  std::string text;
  for (size_t i = first; i < last; ++i) text += (i > first ? " " : "") + words[i].text;
  return text;
}

class TableReader {
 public:
  explicit TableReader(const std::string& path) : path_(path) {}

  LabelEntries read(std::string_view text) {
    while (!text.empty()) {
      ++line_;
      const size_t end = std::min(text.find('\n'), text.size());
      add(words_of(text.substr(0, end)));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (entries_.empty()) throw Failure{path_ + ": holds no names of labels"};
    return std::move(entries_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Failure{path_ + ": line " + std::to_string(line_) + ": " + message};
  }

  // Separated by white space, or within quotes; none of a comment.
  Words words_of(std::string_view line) const {
    Words words;
    constexpr std::string_view kSpace = " \t\r";
    for (;;) {
      const size_t begin = line.find_first_not_of(kSpace);
      if (begin == std::string_view::npos) return words;
      line.remove_prefix(begin);
      if (words.empty() && (line[0] == '#' || line.substr(0, 2) == "//")) return words;
      const bool quoted = line[0] == '"';
      if (quoted) line.remove_prefix(1);
      const size_t end =
          quoted ? line.find('"') : std::min(line.find_first_of(kSpace), line.size());
      if (end == std::string_view::npos) fail("a quote is not closed");
      words.push_back({std::string(line.substr(0, end)), quoted});
      line.remove_prefix(end + (quoted ? 1 : 0));
    }
  }

  void add(const Words& words) {
    if (words.empty()) return;
    if (const auto label = to_label(words[0])) {
      add(*label, words);
      return;
    }
    const std::optional<int32_t> code = words.size() == 3 ? to_label(words[2]) : std::nullopt;
    if (!code) fail("begins with \"" + printable(words[0].text) + "\", expected a label");
    enter(*code, {words[1].text, std::nullopt});
  }

  void add(int32_t label, const Words& words) {
    constexpr size_t kSnapWords = 8;
    if (words.size() == kSnapWords && words.back().quoted) {
      for (size_t i = 1; i < 4; ++i) require_byte(words[i]);
      enter(label, {words.back().text, rgb_of(words, 1)});
      return;
    }
    if (words.size() < 2) fail("label " + std::to_string(label) + " has no name");
    size_t numbers = 0;  // at the end
    while (numbers < 4 && numbers + 2 < words.size() &&
           is_byte(words[words.size() - 1 - numbers])) {
      ++numbers;
    }
    if (numbers >= 3) {
      const size_t first = words.size() - numbers;
      enter(label, {joined(words, 1, first), rgb_of(words, first)});
    } else {
      const bool has_code = words.size() == 3 && to_label(words[2]);
      enter(label, {joined(words, 1, words.size() - (has_code ? 1 : 0)), std::nullopt});
    }
  }

  void require_byte(const Word& word) const {
    if (!is_byte(word)) fail("a colour is \"" + printable(word.text) + "\", expected 0 to 255");
  }

  void enter(int32_t label, const LabelEntry& entry) {
    if (entry.name.size() > kLongestName) {
      fail("a name of " + std::to_string(entry.name.size()) + " bytes, at most " +
           std::to_string(kLongestName) + " are possible");
    }
    if (!is_printable(entry.name)) fail("a name has control characters in it");
    if (!is_utf8(entry.name)) fail("a name is not UTF-8");
    entries_.try_emplace(label, entry);
    if (entries_.size() > kMaxLabels + 1) {
      throw Failure{path_ + ": more than " + std::to_string(kMaxLabels) + " labels"};
    }
  }

  const std::string& path_;
  LabelEntries entries_;
  int line_ = 0;
};

std::string contents(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw Failure{path + ": there is no such file"};
  if (!std::filesystem::is_regular_file(status)) throw Failure{path + ": is not a file"};
  const uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw Failure{path + ": cannot be read: " + error.message()};
  if (size > kLargestFile) {
    throw Failure{path + ": is too large for names of labels (" + std::to_string(size) + " bytes)"};
  }
  std::ifstream file(path, std::ios::binary);
  std::string data(size, '\0');
  if (!file.read(data.data(), static_cast<std::streamsize>(size))) {
    throw Failure{path + ": cannot be read"};
  }
  return data;
}

// Zero bytes, or bytes beyond text: a table of bytes, not of lines.
bool is_lut(const std::string& data) {
  const auto is_binary = [](char c) {
    return is_control(c) && c != '\n' && c != '\r' && c != '\t';
  };
  return data.size() == 3 * kLutColours && std::any_of(data.begin(), data.end(), is_binary);
}

LabelEntries lut_of(const std::string& data) {
  LabelEntries entries;
  for (size_t i = 1; i < kLutColours; ++i) {
    std::array<uint8_t, 3> rgb{};
    for (size_t k = 0; k < 3; ++k) rgb[k] = static_cast<uint8_t>(data[i + k * kLutColours]);
    entries[static_cast<int32_t>(i)] = {"", rgb};
  }
  return entries;
}

bool is_file(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

}  // namespace

LabelEntries read_label_names(const std::string& path) {
  const std::string data = contents(path);
  return is_lut(data) ? lut_of(data) : TableReader(path).read(data);
}

std::vector<std::string> label_tables_beside(const std::string& image) {
  std::vector<std::string> stems;
  const std::string suffix = path_suffix(image);
  stems.push_back(image.substr(0, image.size() - suffix.size()));
  if (suffix == ".nii.gz") stems.push_back(image.substr(0, image.size() - 3));
  std::vector<std::string> found;
  for (const char* end : {".label", ".ctbl", ".txt", ".lut"}) {
    for (const std::string& stem : stems) {
      if (std::string path = stem + end; is_file(path) && path != image) found.push_back(path);
    }
    if (suffix == ".nii" && is_file(image + end)) found.push_back(image + end);
  }
  const auto common = std::filesystem::path(image).parent_path() / kFreeSurfer;
  if (found.empty() && is_file(common)) found.push_back(common.string());
  return found;
}

LabelEntries label_names_beside(const std::string& image, std::vector<std::string>& warnings) {
  LabelEntries all;
  for (const std::string& path : label_tables_beside(image)) {
    try {
      for (auto& [label, entry] : read_label_names(path)) {
        LabelEntry& known = all[label];
        if (known.name.empty()) known.name = entry.name;
        if (!known.rgb) known.rgb = entry.rgb;
      }
    } catch (const Failure& failure) {
      warnings.push_back(failure.message + ": names of labels are not taken from it");
    }
  }
  return all;
}

}  // namespace plc::tools
