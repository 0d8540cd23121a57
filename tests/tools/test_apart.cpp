#include "tools/file/apart.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>
#include <stdexcept>

#include "tests/samples/limited_memory.h"
#include "tests/samples/sample_files.h"
#include "tests/tools/tool_fixtures.h"
#include "tools/file/failure.h"
#include "tools/volume/volume_io.h"

namespace {

using fixtures::failure_of;
using plc::tools::apart;
using plc::tools::ApartLimits;
using plc::tools::Parcel;
using plc::tools::SharedBytes;

constexpr ApartLimits kLimits = {20, uint64_t{1} << 30};

std::string message_of(const std::function<Parcel()>& work, const ApartLimits& limits = kLimits) {
  return failure_of([&] { apart("a.tif", "cannot be read", limits, work); });
}

void be_busy() {
  while (std::clock() != static_cast<std::clock_t>(-1)) {
  }
}

}  // namespace

TEST_CASE("Text and bytes come back from the child", "[apart]") {
  const std::string text(100000, 'x');
  const Parcel parcel = apart("a", "fails", kLimits, [&] {
    Parcel made{text + std::to_string(getpid()), SharedBytes(5000000)};
    std::memset(made.bytes.data(), 7, made.bytes.size());
    return made;
  });
  CHECK(parcel.text.substr(0, text.size()) == text);
  CHECK(parcel.text.substr(text.size()) != std::to_string(getpid()));
  REQUIRE(parcel.bytes.size() == 5000000);
  CHECK(std::to_integer<int>(parcel.bytes.data()[4999999]) == 7);
  CHECK(apart("a", "fails", kLimits, [] { return Parcel{}; }).bytes.empty());
}

TEST_CASE("What the child throws is thrown", "[apart]") {
  CHECK(message_of([]() -> Parcel { throw plc::tools::Failure{"b.tif: is empty"}; }) ==
        "b.tif: is empty");
  CHECK(message_of([]() -> Parcel { throw std::runtime_error("no"); }) ==
        "a.tif: cannot be read (no)");
  CHECK(message_of([]() -> Parcel { throw std::bad_alloc(); }) ==
        "a.tif: cannot be read (not enough memory)");
  CHECK(message_of([]() -> Parcel { throw 7; }) == "a.tif: cannot be read");
}

TEST_CASE("A child that dies is one line", "[apart]") {
  const std::string failed = "a.tif: cannot be read (a library has failed)";
  CHECK(message_of([]() -> Parcel { std::abort(); }) == failed);
  CHECK(message_of([]() -> Parcel { std::terminate(); }) == failed);
  CHECK(message_of([]() -> Parcel { _exit(0); }) == failed);
  CHECK(message_of([]() -> Parcel { _exit(3); }) == failed);
  CHECK(message_of([] {
          std::raise(SIGSEGV);
          return Parcel{};
        }) == failed);
  CHECK_THAT(message_of([] {
               std::raise(SIGKILL);
               return Parcel{};
             }),
             Catch::Contains("the system has ended it"));
}

TEST_CASE("A child that does not end meets its limit of time, which can be raised", "[apart]") {
  CHECK(message_of(
            [] {
              be_busy();
              return Parcel{};
            },
            {0.5, kLimits.bytes}) == "a.tif: cannot be read (it takes too much time)");
  const auto longer = [] {
    plc::tools::raise_limits({20, 0});
    const std::clock_t begin = std::clock();
    while (std::clock() - begin < 3 * CLOCKS_PER_SEC / 2) {
    }
    return Parcel{};
  };
  CHECK(message_of(longer, {0.5, kLimits.bytes}).empty());
}

#if FIXTURES_CAN_LIMIT_MEMORY
TEST_CASE("A child that takes too much memory meets its limit, which can be raised", "[apart]") {
  constexpr size_t kMuch = size_t{300} << 20;
  constexpr ApartLimits kTight = {20, size_t{64} << 20};
  CHECK_THAT(message_of(
                 [] {
                   return Parcel{"", SharedBytes(kMuch)};
                 },
                 kTight),
             Catch::Contains("not enough memory"));
  const auto raised = [] {
    plc::tools::raise_limits({0, 2 * kMuch});
    return Parcel{"", SharedBytes(kMuch)};
  };
  CHECK(message_of(raised, kTight).empty());
}
#endif

TEST_CASE("A child leaves nothing of its limits behind", "[apart]") {
  rlimit before{};
  rlimit after{};
  getrlimit(RLIMIT_CPU, &before);
  apart("a", "fails", kLimits, [] { return Parcel{}; });
  plc::tools::raise_limits({1, 1});
  getrlimit(RLIMIT_CPU, &after);
  CHECK(before.rlim_cur == after.rlim_cur);
}

TEST_CASE("What is sent is not held by limits of files", "[apart]") {
  const auto work = [] {
    const rlimit none{0, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &none);
    return Parcel{"", SharedBytes(1000)};
  };
  CHECK(message_of(work).empty());
}

TEST_CASE("A volume read apart is the one that is read here, with its warnings", "[apart]") {
  const fixtures::Folder folder;
  samples::DicomSlice slice;
  slice.voxels.assign(12, 5);
  for (int i = 0; i < 5; ++i) {
    slice.number = i;
    slice.series = i < 3 ? "1.2.3.4" : "1.2.3.5";
    slice.position = "0\\0\\" + std::to_string(2 * i);
    folder.put("s" + std::to_string(i) + ".dcm", samples::dicom(slice));
  }
  const plc::tools::LoadedVolume here = plc::tools::read_volume(folder.path());
  const plc::tools::LoadedVolume there = plc::tools::read_volume_apart(folder.path());
  REQUIRE(there.bytes.size() == here.bytes.size());
  CHECK(std::equal(here.bytes.begin(), here.bytes.end(), there.bytes.begin()));
  CHECK(there.image.voxels == there.bytes.data());
  CHECK(there.image.type == here.image.type);
  CHECK(std::memcmp(there.image.dims, here.image.dims, sizeof here.image.dims) == 0);
  CHECK(std::equal(here.image.spacing, here.image.spacing + 3, there.image.spacing));
  CHECK(here.warnings.size() == 1);
  CHECK(there.warnings == here.warnings);
}
