#include "engine/recover/frozen_sites.h"

#include <algorithm>

#include "engine/mesh/turns.h"

namespace plc {

namespace {

// The site that v belongs to: all vertices that can be reached from it over frozen ones, which are
// marked in `seen`.
FrozenSite site_around(const Mesh& mesh, uint32_t v, Vector<uint8_t>& seen) {
  FrozenSite site;
  double x = 0, y = 0, z = 0;
  Vector<uint32_t> open{v};
  seen[v] = 1;
  while (!open.empty()) {
    const uint32_t u = open.back();
    open.pop_back();
    const Vec3 p = mesh.at(u);
    x += static_cast<double>(p.x);
    y += static_cast<double>(p.y);
    z += static_cast<double>(p.z);
    ++site.vertices;
    for (uint32_t k = 0; k < mesh.valence(u); ++k) {
      const uint32_t w = mesh.neighbor(u, k);
      if (seen[w] != 0 || !frozen(mesh.turns[w])) continue;
      seen[w] = 1;
      open.push_back(w);
    }
  }
  const auto n = static_cast<double>(site.vertices);
  site.place = {static_cast<float>(x / n), static_cast<float>(y / n), static_cast<float>(z / n)};
  return site;
}

}  // namespace

Vector<FrozenSite> frozen_sites(const Mesh& mesh) {
  Vector<FrozenSite> sites;
  Vector<uint8_t> seen(mesh.slots(), 0);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (seen[v] != 0 || !mesh.alive(v) || !frozen(mesh.turns[v])) continue;
    sites.push_back(site_around(mesh, v, seen));
  }
  std::stable_sort(sites.begin(), sites.end(), [](const FrozenSite& l, const FrozenSite& r) {
    return l.vertices > r.vertices;
  });
  return sites;
}

}  // namespace plc
