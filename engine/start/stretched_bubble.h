// Bubbles (3.6) that are much longer than thick. An icosahedron that is refined as the long axis
// asks for is so crowded around the short ones that the search for what is near takes quadratic
// time.
#pragma once
#include <array>

#include "engine/base/schedule.h"
#include "engine/mesh/mesh.h"
#include "pyramid/status.h"

namespace plc {

// From here on, longest axis to shortest.
inline constexpr double kStretched = 8;
bool is_stretched(const std::array<double, 3>& half);

// The mesh becomes |x / half[0]|^power + ... = 1 around the middle, by conform() of an iso-surface
// of it, with edges of 1.3 to 3.3 delta. power: 2 or 4. Each half >= kSmallestBubble * delta. A rim
// that is thinner than (3) allows is torn. Errors: those of conform().
Status make_stretched_bubble(Mesh& mesh, const std::array<double, 3>& middle,
                             const std::array<double, 3>& half, int power, double delta,
                             const Schedule& schedule);

}  // namespace plc
