#include "tools/blocks/block_plan.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"

namespace plc::tools {

namespace {

using Json = nlohmann::ordered_json;

// Doubles that are not finite have no form in JSON.
Json json_of(double value) {
  return std::isnan(value) ? Json(nullptr) : Json(value);
}

double number_of(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

// Value i of the field.
template <typename T>
char* place_of(plc_parameters& p, const plc_parameter_info& info, int i) {
  return reinterpret_cast<char*>(&p) + info.offset + sizeof(T) * static_cast<size_t>(i);
}

Json parameters_json(plc_parameters p) {
  Json json;
  for (int i = 0; const plc_parameter_info* info = plc_parameter_at(i); ++i) {
    Json values = Json::array();
    for (int k = 0; k < info->count; ++k) {
      if (info->kind == PLC_PARAMETER_REAL) {
        double value = 0;
        std::memcpy(&value, place_of<double>(p, *info, k), sizeof value);
        values.push_back(json_of(value));
      } else {
        int value = 0;
        std::memcpy(&value, place_of<int>(p, *info, k), sizeof value);
        values.push_back(value);
      }
    }
    json[info->name] = std::move(values);
  }
  return json;
}

plc_parameters parameters_of(const Json& json) {
  plc_parameters p;
  plc_parameters_defaults(&p);
  for (int i = 0; const plc_parameter_info* info = plc_parameter_at(i); ++i) {
    const Json& values = json.at(info->name);
    for (int k = 0; k < info->count; ++k) {
      const Json& given = values.at(static_cast<size_t>(k));
      if (info->kind == PLC_PARAMETER_REAL) {
        const double value = number_of(given);
        std::memcpy(place_of<double>(p, *info, k), &value, sizeof value);
      } else {
        const int value = given.get<int>();
        std::memcpy(place_of<int>(p, *info, k), &value, sizeof value);
      }
    }
  }
  return p;
}

template <typename T, size_t N>
void read_array(const Json& json, T (&to)[N]) {
  for (size_t i = 0; i < N; ++i) to[i] = json.at(i).get<T>();
}

// Of the longest edges to the mean, and how long that is in voxels where nothing else is said.
constexpr double kLongest = 1.68, kUniform = 1.25, kAdaptive = 5;

}  // namespace

bool too_many_blocks(const BlockGrid& grid) {
  const Int3& n = grid.blocks();
  return n[0] > kMostBlocks / n[1] || n[0] * n[1] > kMostBlocks / n[2];
}

// What has not been on its level before is of the level above.
double BlockPlan::band_of(const plc_parameters& p, const plc_image& image, int from_level) {
  const bool adaptive = p.mesh == PLC_MESH_ADAPTIVE;
  const double given = adaptive ? p.edge_max : p.edge;
  const double unit = *std::min_element(image.spacing, image.spacing + 3);
  const double edge = given > 0 ? given / unit : adaptive ? kAdaptive : kUniform;
  double voxels = (kHeldRings + 1) * kLongest * edge;
  for (int h = 0; h <= from_level; ++h) voxels *= p.reduction;
  return voxels;
}

int64_t margin_of(double band) {
  return static_cast<int64_t>(std::ceil(2 * band));
}

std::string block_path(const std::string& folder, const BlockPlan& plan, int step,
                       const Int3& block) {
  const std::string level = step < 0 ? "start" : "level" + std::to_string(plan.level_of(step));
  return folder + "/" + level + "/" + BlockGrid::name_of(block) + ".blk";
}

void write_plan(const std::string& folder, const BlockPlan& plan) {
  const plc_image& image = plan.image;
  Json json = {{"pellicle", plan.version},
               {"input", plan.input},
               {"hash", plan.hash},
               {"image",
                {{"type", static_cast<int>(image.type)},
                 {"dims", image.dims},
                 {"spacing", image.spacing},
                 {"origin", image.origin},
                 {"direction", image.direction},
                 {"range", {plan.low, plan.high}}}},
               {"side", plan.grid.side()},
               {"margin", plan.grid.margin()},
               {"from_level", plan.from_level},
               {"start", {{"vertices", plan.start_vertices}, {"faces", plan.start_faces}}},
               {"inside", plan.inside},
               {"parameters", parameters_json(plan.parameters)}};
  AtomicFile file(folder + "/plan.json");
  file.write(json.dump(1) + "\n");
  file.commit();
}

BlockPlan read_plan(const std::string& folder) {
  const std::string path = folder + "/plan.json";
  std::ifstream file(path);
  if (!file) throw Failure{path + ": cannot be read; is the folder that of a plan by blocks?"};
  std::ostringstream text;
  text << file.rdbuf();
  BlockPlan plan;
  try {
    const Json json = Json::parse(text.str());
    plan.version = json.at("pellicle").get<std::string>();
    plan.input = json.at("input").get<std::string>();
    plan.hash = json.at("hash").get<std::string>();
    plc_image_defaults(&plan.image);
    const Json& image = json.at("image");
    plan.image.type = static_cast<plc_voxel_type>(image.at("type").get<int>());
    read_array(image.at("dims"), plan.image.dims);
    read_array(image.at("spacing"), plan.image.spacing);
    read_array(image.at("origin"), plan.image.origin);
    read_array(image.at("direction"), plan.image.direction);
    plan.low = image.at("range").at(0).get<double>();
    plan.high = image.at("range").at(1).get<double>();
    plan.from_level = json.at("from_level").get<int>();
    plan.start_vertices = json.at("start").at("vertices").get<int64_t>();
    plan.start_faces = json.at("start").at("faces").get<int64_t>();
    plan.inside = json.at("inside").get<std::vector<int64_t>>();
    plan.parameters = parameters_of(json.at("parameters"));
    const auto side = json.at("side").get<int64_t>(), margin = json.at("margin").get<int64_t>();
    const int64_t* dims = plan.image.dims;
    const bool sound =
        std::all_of(dims, dims + 3, [](int64_t d) { return d >= 2 && d < int64_t{1} << 31U; }) &&
        margin >= 1 && margin < side && side < int64_t{1} << 31U && side >= 4 * margin &&
        plan.from_level >= 0 && plan.from_level < kMostBlockLevels &&
        plan.parameters.level_iso_count == plan.parameters.levels + 1 &&
        plan.parameters.levels > plan.from_level && plan.parameters.levels < PLC_MAX_LEVELS;
    if (!sound) throw Failure{path + ": is no plan by blocks"};
    plan.grid = BlockGrid({dims[0], dims[1], dims[2]}, side, margin);
    if (too_many_blocks(plan.grid)) throw Failure{path + ": is no plan by blocks"};
  } catch (const Json::exception&) {
    throw Failure{path + ": is no plan by blocks"};
  }
  if (plan.version != plc_version_string()) {
    throw Failure{path + ": was planned by Pellicle " + plan.version + ", this is " +
                  plc_version_string()};
  }
  return plan;
}

plc_parameters task_parameters(const BlockPlan& plan, int level) {
  plc_parameters p = plan.parameters;
  const int above = p.levels - level;
  p.levels = level;
  p.level_iso_count = level + 1;
  std::copy(p.level_iso + above, p.level_iso + above + p.level_iso_count, p.level_iso);
  p.init = PLC_INIT_MESH;
  return p;
}

}  // namespace plc::tools
