#include "tools/volume/ome_zarr.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "tools/file/checked_sizes.h"
#include "tools/file/failure.h"
#include "tools/file/printable.h"
#include "tools/volume/volume_io_formats.h"
#include "tools/volume/volume_io_memory.h"
#include "tools/volume/zarr_gather.h"
#include "tools/volume/zarr_json.h"

namespace plc::tools {
namespace {

// mm of a unit of length; 1 where there is none that we know.
double millimetres(const std::string& unit) {
  static const std::map<std::string, double> known = {
      {"angstrom", 1e-7},  {"nanometer", 1e-6}, {"micrometer", 1e-3}, {"millimeter", 1},
      {"centimeter", 10},  {"decimeter", 100},  {"meter", 1e3},       {"inch", 25.4},
      {"picometer", 1e-9}, {"kilometer", 1e6}};
  const auto found = known.find(unit);
  return found == known.end() ? 1 : found->second;
}

struct Axis {
  std::string name;
  bool is_space = true;
  double unit = 1;              // mm
  double step = 1, origin = 0;  // between voxels, and of the first one, in units
};

// A path in a hierarchy that stays in it.
bool is_inner_path(const std::string& path) {
  if (!is_printable(path) || path.empty() || path.size() > 255 || path[0] == '/') return false;
  for (const auto& part : std::filesystem::path(path)) {
    if (part == ".." || part == ".") return false;
  }
  return true;
}

class Multiscale {
 public:
  Multiscale(const ZarrStore& store, const ZarrJson& json) : store_(store), json_(json) {}

  // "" is the first one, the finest.
  const ZarrJson& dataset(const std::string& path) const {
    const ZarrJson& datasets = member(json_, "datasets");
    if (!datasets.is_array() || datasets.empty()) fail("has no datasets");
    for (const ZarrJson& item : datasets) {
      if (!is_inner_path(text_member(item, "path"))) fail("has a path that is not usable");
      if (path.empty() || text_member(item, "path") == path) return item;
    }
    fail("has no resolution " + printable(path));
  }

  std::vector<Axis> axes(size_t count) const {
    const ZarrJson& list = member(json_, "axes");
    if (!list.is_array() || list.size() != count) {
      fail("has axes that are not those of its arrays");
    }
    std::vector<Axis> axes;
    for (const ZarrJson& item : list) {
      Axis axis;
      axis.name = item.is_string() ? item.get<std::string>() : text_member(item, "name");
      const std::string type = text_member(item, "type");
      axis.is_space = type == "space" || (type.empty() && axis.name != "t" && axis.name != "c");
      axis.unit = millimetres(text_member(item, "unit"));
      axes.push_back(axis);
    }
    return axes;
  }

  // Where the voxels lie, in the units of the axes.
  void place(const ZarrJson& dataset, std::vector<Axis>& axes) const {
    apply(member(dataset, "coordinateTransformations"), axes);
    apply(member(json_, "coordinateTransformations"), axes);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Failure{store_.name("") + ": its OME-Zarr image " + what};
  }
  std::vector<double> numbers(const ZarrJson& list, size_t count) const {
    std::vector<double> values;
    if (list.is_array() && list.size() == count) {
      for (const ZarrJson& item : list) {
        if (item.is_number()) values.push_back(item.get<double>());
      }
    }
    if (values.size() != count) fail("has coordinateTransformations that are not usable");
    return values;
  }
  void apply(const ZarrJson& list, std::vector<Axis>& axes) const {
    if (list.is_null()) return;
    if (!list.is_array()) fail("has coordinateTransformations that are not usable");
    for (const ZarrJson& item : list) {
      const std::string type = text_member(item, "type");
      if (type == "identity") continue;
      if (type != "scale" && type != "translation") {
        fail("has a coordinateTransformation of type \"" + printable(type) +
             "\", which is not supported");
      }
      const std::vector<double> values = numbers(member(item, type), axes.size());
      for (size_t i = 0; i < axes.size(); ++i) {
        if (type == "scale") {
          axes[i].step *= values[i];
          axes[i].origin *= values[i];
        } else {
          axes[i].origin += values[i];
        }
      }
    }
  }

  const ZarrStore& store_;
  const ZarrJson& json_;
};

// The metadata of the root's first image; nothing where there are none. OME-Zarr 0.5 has them under
// "ome", 0.4 in a file of their own.
std::optional<ZarrJson> multiscales_of(const ZarrStore& store) {
  if (const auto group = read_zarr_json(store, "zarr.json")) {
    const ZarrJson& ome = member(member(*group, "attributes"), "ome");
    const ZarrJson& list = member(ome, "multiscales");
    if (list.is_array() && !list.empty()) return list[0];
  }
  if (const auto attributes = read_zarr_json(store, ".zattrs")) {
    const ZarrJson& list = member(*attributes, "multiscales");
    if (list.is_array() && !list.empty()) return list[0];
  }
  return std::nullopt;
}

// The three axes of space, x first, and no more than one place along the others.
std::array<size_t, 3> space_of(const std::string& name, const std::vector<Axis>& axes,
                               const std::vector<int64_t>& shape) {
  std::vector<size_t> space;
  for (size_t axis = 0; axis < axes.size(); ++axis) {
    if (axes[axis].is_space) {
      space.push_back(axis);
    } else if (shape[axis] != 1) {
      throw Failure{name + ": has " + std::to_string(shape[axis]) + " images along its axis \"" +
                    printable(axes[axis].name) + "\"; one is needed"};
    }
  }
  if (space.size() != 3) {
    throw Failure{name + ": is " + std::to_string(space.size()) + "-D; a 3-D volume is needed"};
  }
  return {space[2], space[1], space[0]};
}

// Columns of the direction: that of a file whose axes are not z, y, x permutes them.
void place_axes(const std::vector<Axis>& axes, OmeZarrImage& image) {
  static const std::string letters = "xyz";
  std::array<size_t, 3> row{0, 1, 2};
  bool named = true;
  std::array<bool, 3> met{};
  for (size_t i = 0; i < 3; ++i) {
    const std::string& name = axes[image.space[i]].name;
    const size_t at = name.size() == 1 ? letters.find(name[0]) : std::string::npos;
    named = named && at != std::string::npos && !met[at];
    if (!named) break;
    met[at] = true;
    row[i] = at;
  }
  if (!named) row = {0, 1, 2};
  std::fill_n(image.header.direction, 9, 0.0);
  for (size_t i = 0; i < 3; ++i) {
    const Axis& axis = axes[image.space[i]];
    const double step = axis.step * axis.unit;
    image.header.spacing[i] = std::abs(step);
    image.header.origin[row[i]] = axis.origin * axis.unit;
    image.header.direction[3 * row[i] + i] = step < 0 ? -1 : 1;
  }
}

void set_dims(OmeZarrImage& image) {
  for (const size_t axis : image.space) image.header.dims.push_back(image.array.shape[axis]);
  image.header.component = image.array.component;
}

// The chunks of the array by numbers.
class ChunkGrid {
 public:
  explicit ChunkGrid(const ZarrArray& array) {
    for (size_t axis = 0; axis < array.shape.size(); ++axis) counts_.push_back(array.chunks(axis));
  }
  uint64_t count() const {
    uint64_t all = 1;
    for (const int64_t n : counts_) all = times(all, static_cast<uint64_t>(n));
    return all;
  }
  std::vector<int64_t> index(uint64_t number) const {
    std::vector<int64_t> at(counts_.size());
    for (size_t axis = counts_.size(); axis-- > 0;) {
      at[axis] = static_cast<int64_t>(number % static_cast<uint64_t>(counts_[axis]));
      number /= static_cast<uint64_t>(counts_[axis]);
    }
    return at;
  }

 private:
  std::vector<int64_t> counts_;
};

// Chunks may be missing. But where memory is taken for many voxels, some of them must be there:
// the first so many that are looked for tell.
void require_chunks(const ZarrStore& store, const OmeZarrImage& image, const ChunkGrid& grid) {
  constexpr uint64_t kMuch = uint64_t{1} << 26;
  constexpr uint64_t kLooks = 4096;
  uint64_t bytes = component_size(image.array.component);
  for (const int64_t dim : image.header.dims) bytes = times(bytes, static_cast<uint64_t>(dim));
  const uint64_t count = grid.count();
  // Keys and work of each chunk cost as much as many voxels do.
  if (count > (uint64_t{1} << 32)) {
    throw Failure{store.name(image.array.path) + ": has too many chunks"};
  }
  if (bytes <= kMuch) return;
  // Spread over the whole volume by a step that has no factor in common with lengths of axes.
  constexpr uint64_t kStep = 2654435761;
  ZarrArray outer = image.array;  // where there are shards, of them
  for (uint64_t look = 0; look < std::min(kLooks, count); ++look) {
    ZarrBytes none;
    if (read_zarr_chunk(store, outer, grid.index(look * kStep % count), none)) return;
  }
  throw Failure{store.name(image.array.path) + ": has no chunks where they were looked for"};
}

}  // namespace

bool is_zarr_folder(const std::string& path) {
  const auto has = [&](const char* name) {
    std::error_code error;
    return std::filesystem::exists(std::filesystem::path(path) / name, error);
  };
  return has("zarr.json") || has(".zgroup") || has(".zarray") || has(".zattrs");
}

OmeZarrPlace find_ome_zarr(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMostParents = 2;  // of paths such as "scale0/image"
  const ZarrFolder here(path);
  if (multiscales_of(here) || !is_zarr_array(here, "")) return {path, ""};
  std::error_code error;
  fs::path root = fs::weakly_canonical(path, error);
  fs::path dataset;
  for (int i = 0; i < kMostParents && !error; ++i) {
    dataset = dataset.empty() ? root.filename() : root.filename() / dataset;
    root = root.parent_path();
    const auto json = multiscales_of(ZarrFolder(root.string()));
    if (!json) continue;
    for (const ZarrJson& item : member(*json, "datasets")) {
      if (text_member(item, "path") == dataset.string()) return {root.string(), dataset.string()};
    }
  }
  return {path, ""};
}

OmeZarrImage open_ome_zarr(const ZarrStore& store, const std::string& dataset) {
  OmeZarrImage image;
  const std::string name = store.name("");
  const std::optional<ZarrJson> json = multiscales_of(store);
  if (json) {
    const Multiscale multiscale(store, *json);
    const ZarrJson& chosen = multiscale.dataset(dataset);
    image.array = read_zarr_array(store, text_member(chosen, "path"));
    std::vector<Axis> axes = multiscale.axes(image.array.shape.size());
    multiscale.place(chosen, axes);
    image.space = space_of(name, axes, image.array.shape);
    place_axes(axes, image);
  } else if (is_zarr_array(store, "")) {
    image.array = read_zarr_array(store, "");
    const size_t count = image.array.shape.size();
    std::vector<Axis> axes(count);
    for (size_t i = 0; i + 3 < count; ++i) axes[i].is_space = false;
    image.space = space_of(name, axes, image.array.shape);
  } else {
    throw Failure{name + ": holds no OME-Zarr image (a group with \"multiscales\") and no array"};
  }
  set_dims(image);
  image.header = checked_header(name, std::move(image.header));
  return image;
}

LoadedVolume read_ome_zarr(const ZarrStore& store, const OmeZarrImage& image, int threads) {
  const std::string name = store.name("");
  const ChunkGrid grid(image.array);
  require_chunks(store, image, grid);
  SharedBytes voxels = allocate_voxels(name, image.header);
  VoxelBox all{};
  for (size_t i = 0; i < 3; ++i) all.high[i] = image.header.dims[i] - 1;
  const ZarrGather gather(image, all, voxels.data());
  const uint64_t count = grid.count();
  const bool fill_is_zero = std::all_of(image.array.fill.begin(), image.array.fill.end(),
                                        [](std::byte b) { return b == std::byte{0}; });
  std::atomic<uint64_t> next{0};
  std::mutex lock;
  uint64_t failed = count;  // the first chunk that has
  std::string message;
  const auto fail = [&](uint64_t number, const std::string& what) {
    const std::lock_guard<std::mutex> guard(lock);
    if (number < failed) {
      failed = number;
      message = what;
    }
    next = count;
  };
  const auto work = [&] {
    ZarrBytes values;
    for (uint64_t number = next++; number < count; number = next++) {
      try {
        const std::vector<int64_t> index = grid.index(number);
        const bool there = read_zarr_chunk(store, image.array, index, values);
        if (there || !fill_is_zero) gather.put(index, there ? values.data() : nullptr);
      } catch (const Failure& failure) {
        fail(number, failure.message);
      } catch (const std::bad_alloc&) {
        fail(number, name + ": not enough memory for a chunk");
      }
    }
  };
  std::vector<std::thread> more;
  for (int i = 1; i < threads; ++i) more.emplace_back(work);
  work();
  for (std::thread& thread : more) thread.join();
  if (failed < count) throw Failure{message};
  return volume_from(name, image.header, std::move(voxels));
}

LoadedVolume read_ome_zarr(const std::string& path) {
  constexpr unsigned kMostThreads = 8;
  const OmeZarrPlace place = find_ome_zarr(path);
  const ZarrFolder folder(place.root);
  return read_ome_zarr(
      folder, open_ome_zarr(folder, place.dataset),
      static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, kMostThreads)));
}

}  // namespace plc::tools
