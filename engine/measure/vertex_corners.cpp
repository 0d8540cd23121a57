#include "engine/measure/vertex_corners.h"

namespace plc {

VertexCorners::VertexCorners(const uint32_t* abc, size_t face_count, size_t vertex_count) {
  begin_.resize(vertex_count + 1);
  const auto for_corners = [&](const auto& visit) {
    for (size_t f = face_count; f-- > 0;) {  // backwards, as places are taken
      if (has_repeated_vertex(abc + 3 * f)) continue;
      for (size_t c = 3 * f + 3; c-- > 3 * f;) visit(abc[c], static_cast<uint32_t>(c));
    }
  };
  for_corners([&](uint32_t v, uint32_t) { ++begin_[v]; });
  uint32_t total = 0;
  for (uint32_t& b : begin_) {
    total += b;
    b = total;
  }
  corners_.resize_uninitialized(total);
  for_corners([&](uint32_t v, uint32_t c) { corners_[--begin_[v]] = c; });
}

}  // namespace plc
