#include "tools/file/atomic_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <climits>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/tools/tool_fixtures.h"
#include "tools/file/failure.h"

namespace {

using plc::tools::AtomicFile;
using plc::tools::AtomicFiles;

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void write_to(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("Two writers of one file do not disturb each other", "[atomic_file]") {
  const fixtures::Folder folder;
  const std::string path = folder / "a.ply";
  std::optional<AtomicFile> first(std::in_place, path);
  first->write("first");
  {
    AtomicFile second(path);
    second.write("second");
    CHECK(names_in(folder.path()) == Names{".a.ply.pellicle-0", ".a.ply.pellicle-1"});
    second.commit();
  }
  CHECK(names_in(folder.path()) == Names{".a.ply.pellicle-0", "a.ply"});
  CHECK(fixtures::contents(folder / "a.ply") == "second");
  first->commit();
  CHECK(fixtures::contents(folder / "a.ply") == "first");
  first.reset();
  CHECK(names_in(folder.path()) == Names{"a.ply"});
}

TEST_CASE("What a killed process has left of a file is taken away", "[atomic_file]") {
  const fixtures::Folder folder;
  for (const char* left : {".a.ply.pellicle-0", ".a.ply.pellicle-2", ".b.ply.pellicle-0"}) {
    folder.put(left, "left");
  }
  folder.put(".a.ply.pellicle-x", "another's");
  write_to(folder / "a.ply", "new");
  CHECK(names_in(folder.path()) == Names{".a.ply.pellicle-x", ".b.ply.pellicle-0", "a.ply"});
  CHECK(fixtures::contents(folder / "a.ply") == "new");
}

TEST_CASE("A name may be as long as the file system lets it", "[atomic_file]") {
  const fixtures::Folder folder;
  const std::string name = std::string(NAME_MAX - 4, 'n') + ".ply";
  const std::string other = std::string(NAME_MAX - 4, 'n') + ".obj";
  const std::string umlauts = [] {
    std::string text = "x";
    while (text.size() < NAME_MAX) text += "\xc3\xa4";
    return text;
  }();
  for (const std::string& long_name : {name, other, umlauts}) {
    AtomicFile file(folder / long_name);
    file.write(long_name);
    for (const std::string& made : names_in(folder.path())) {
      if (made[0] != '.') continue;
      CHECK(made.size() <= NAME_MAX);
      // No character of two bytes is cut in two.
      CHECK(std::count(made.begin(), made.end(), '\xc3') ==
            std::count(made.begin(), made.end(), '\xa4'));
    }
    file.commit();
    CHECK(fixtures::contents(folder / long_name) == long_name);
  }
  CHECK(names_in(folder.path()).size() == 3);
}

TEST_CASE("Files that belong together are all renamed or none", "[atomic_file]") {
  const fixtures::Folder folder;
  AtomicFiles files;
  for (int i = 0; i < 40; ++i) files.add(folder / std::to_string(i)).write("text");
  CHECK_FALSE(std::filesystem::exists(folder / "0"));
  SECTION("all") {
    files.commit();
    CHECK(files.size() == 0);
    const Names names = names_in(folder.path());
    CHECK(names.size() == 40);
    CHECK(std::none_of(names.begin(), names.end(), [](const auto& n) { return n[0] == '.'; }));
    CHECK(fixtures::contents(folder / "39") == "text");
  }
  SECTION("none") {
    files.add("/dev/full").write("text");
    CHECK_THROWS_AS(files.commit(), plc::tools::Failure);
    const Names names = names_in(folder.path());
    CHECK(std::all_of(names.begin(), names.end(), [](const auto& n) { return n[0] == '.'; }));
  }
}

TEST_CASE("A file keeps its permissions, a new one has those that the umask leaves",
          "[atomic_file]") {
  const fixtures::Folder folder;
  const std::string path = folder / "a.ply";
  const mode_t before = umask(027);
  write_to(path, "new");
  umask(before);
  struct stat status {};
  REQUIRE(stat(path.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777U) == 0640U);
  REQUIRE(chmod(path.c_str(), 0604) == 0);
  write_to(path, "again");
  REQUIRE(stat(path.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777U) == 0604U);
}
