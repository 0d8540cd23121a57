#include "engine/detect/tiny_components.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/base/constants.h"
#include "pyramid/memory.h"

namespace plc {

double signed_volume(const Mesh& mesh, const Vector<uint32_t>& component) {
  const Vec3 origin = mesh.at(component[0]);
  double six_volume = 0;
  for (const uint32_t v : component) {
    const uint32_t d = mesh.valence(v);
    for (uint32_t k = 0; k < d; ++k) {
      const uint32_t a = mesh.neighbor(v, k);
      const uint32_t b = mesh.neighbor(v, k + 1 == d ? 0 : k + 1);
      if (v > a || v > b) continue;
      six_volume += static_cast<double>(
          dot(mesh.at(v) - origin, cross(mesh.at(a) - origin, mesh.at(b) - origin)));
    }
  }
  return six_volume / 6;
}

bool is_tetrahedron(const Mesh& mesh, uint32_t v) {
  if (mesh.valence(v) != 3) return false;
  for (uint32_t k = 0; k < 3; ++k) {
    if (mesh.valence(mesh.neighbor(v, k)) != 3) return false;
  }
  return true;
}

void delete_tetrahedron(Mesh& mesh, uint32_t v) {
  assert(is_tetrahedron(mesh, v));
  const Neighbors ring = mesh.ring(v);
  for (const uint32_t w : ring) mesh.destroy(w);
  mesh.destroy(v);
}

const Vector<uint32_t>& TinyComponents::flood(const Mesh& mesh, uint32_t v) {
  component_.clear();
  if (v >= mesh.slots() || !mesh.alive(v) || seen(v)) return component_;
  component_.push_back(v);
  seen_[v] = ++flood_;
  bool whole = true;
  for (size_t next = 0; next < component_.size() && whole; ++next) {
    const uint32_t u = component_[next];
    const uint32_t d = mesh.valence(u);
    for (uint32_t k = 0; k < d; ++k) {
      const uint32_t w = mesh.neighbor(u, k);
      if (seen_[w] == flood_) continue;
      // Met by an earlier flood of this update, which took the whole component or found it large.
      whole = whole && !seen(w);
      seen_[w] = flood_;
      component_.push_back(w);
    }
    whole = whole && component_.size() <= kTinyComponent;
  }
  if (!whole) component_.clear();
  std::sort(component_.begin(), component_.end());
  return component_;
}

void TinyComponents::restore(StateReader& from, uint32_t slots) {
  from.read_all(watched_);
  seen_.assign(slots, 0);
  flood_ = 0;
}

void TinyComponents::start(Mesh& mesh) {
  watched_.clear();
  seen_.clear();
  flood_ = 0;
  start_floods(mesh);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const auto& component = flood(mesh, v);
    if (component.empty()) continue;
    watched_.push_back({component[0], signed_volume(mesh, component) > 0 ? 1U : 0U});
  }
}

void TinyComponents::start_floods(const Mesh& mesh) {
  seen_.resize(mesh.slots(), 0);
  first_flood_ = flood_ + 1;
}

int64_t TinyComponents::delete_turned_over(Mesh& mesh, const Stays& stays) {
  start_floods(mesh);
  int64_t deleted = 0;
  for (const Watched& w : watched_) {
    const auto& component = flood(mesh, w.vertex);
    if (component.empty()) continue;  // only in a forged state
    if ((signed_volume(mesh, component) > 0) == (w.positive != 0)) continue;
    if (stays && stays(component)) continue;
    for (const uint32_t v : component) mesh.destroy(v);
    ++deleted;
  }
  return deleted;
}

int64_t TinyComponents::update(Mesh& mesh, const Vector<uint32_t>& changed, const Stays& stays) {
  start_floods(mesh);
  Vector<Watched> still;
  int64_t deleted = 0;
  const auto look = [&](uint32_t v, const Watched* known) {
    const auto& component = flood(mesh, v);
    if (component.empty()) return;
    const double volume = signed_volume(mesh, component);
    const auto size = static_cast<double>(mesh.size(component[0]));
    const double least = kTinyVolume * size * size * size;
    const bool positive = known != nullptr ? known->positive != 0 : volume > 0;
    const bool vanishes = (volume > 0) != positive || std::abs(volume) < least;
    if (vanishes && !(stays && stays(component))) {
      for (const uint32_t w : component) mesh.destroy(w);
      ++deleted;
    } else {
      still.push_back({component[0], positive ? 1U : 0U});
    }
  };
  // Followed components first: their sign is known.
  for (const Watched& w : watched_) look(w.vertex, &w);
  for (const uint32_t v : changed) look(v, nullptr);
  watched_ = std::move(still);
  return deleted;
}

}  // namespace plc
