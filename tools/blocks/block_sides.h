// On which side of the coarse levels' surface blocks lie that it does not come near.
#pragma once
#include <cstdint>
#include <vector>

#include "tools/blocks/block_grid.h"

namespace plc::tools {

// The blocks whose middle lies inside a closed surface, ascending. xyz: voxel indices.
std::vector<int64_t> blocks_inside(const BlockGrid& grid, const std::vector<double>& xyz,
                                   const std::vector<uint32_t>& abc);

}  // namespace plc::tools
