#include "engine/mesh/vertex_bytes.h"

#include <algorithm>

#include "engine/mesh/mesh.h"

namespace plc {

VertexBytes::VertexBytes(Mesh& mesh, uint8_t first, Reset reset)
    : mesh_(&mesh), first_(first), reset_(reset) {
  mesh.attach(*this);
}

VertexBytes::~VertexBytes() {
  if (mesh_ != nullptr) mesh_->detach(*this);
}

void VertexBytes::fill(uint8_t value) {
  std::fill(bytes_.begin(), bytes_.end(), value);
}

void VertexBytes::save(StateWriter& to) const {
  to.add_some(bytes_, mesh_->padded());
}

void VertexBytes::restore(StateReader& from) {
  from.read_all(bytes_);
  from.demand(bytes_.size() == mesh_->padded());
}

AttachedBytes::~AttachedBytes() {
  for (VertexBytes* bytes : list_) bytes->mesh_ = nullptr;
}

}  // namespace plc
