// Metadata of Zarr hierarchies, and what is asked of them.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/volume/zarr_store.h"

namespace plc::tools {

using ZarrJson = nlohmann::json;

// The value of a key as JSON; nothing where there is none. Throws Failure.
std::optional<ZarrJson> read_zarr_json(const ZarrStore& store, const std::string& key);

// A member of an object; a null value where it is no object or has none.
const ZarrJson& member(const ZarrJson& object, const std::string& name);
// Its text, or "" where it is none.
std::string text_member(const ZarrJson& object, const std::string& name);
// Lengths of axes, each from 1 to 2^31 - 1, or nothing.
std::optional<std::vector<int64_t>> lengths_of(const ZarrJson& list);

// "0/zarr.json" of "0" and "zarr.json".
std::string zarr_key(const std::string& path, const std::string& name);

}  // namespace plc::tools
