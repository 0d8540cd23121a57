// What a user adds to the forces of the model (3.8, 6): attachment points, pins, own forces.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/mesh/mesh.h"
#include "pyramid/executor.h"
#include "pyramid/status.h"

namespace plc {

// A place that draws the surface near it along its normals until the surface goes through it.
struct Attachment {
  Vec3 place;      // mesh units
  float radius;    // mm: vertices at least this far away do not feel it
  float strength;  // stiffness, relative to the attraction of the image; >= 0
};

// A ball in which no vertex moves. Transformations still keep the constraints there.
struct Pin {
  Vec3 place;    // mesh units
  float radius;  // mm
};

// Adds a force to that of every living vertex: mass times mesh units per time squared. Called on
// the calling thread. An error ends the evolution.
using UserForce = std::function<Status(const Mesh& mesh, const Float4* position, Streams3& force)>;

// On one level.
struct UserConstraints {
  std::vector<Attachment> attachments;
  std::vector<Pin> pins;
  UserForce force;
  std::array<float, 3> millimetres{1, 1, 1};  // of a mesh unit on each axis
  // Of the angles between the axes x and y, y and z, z and x; 0 unless the image is sheared.
  std::array<float, 3> cosines{};

  // The most that attachments add to the stiffness of a vertex: see attach().
  float stiffness() const;
};

// What (4) knows of the vertices: mesh units per time, m, gamma.
struct Motion {
  const Streams3& velocity;
  float mass, damping;
};

// Adds the force of the attachments to the vertices begin .. end-1:
//   f += [sum_i w_i s_i (a_i - x) . n / W - max(0, 2 sqrt(m k) - gamma) v . n] n
//   w_i = (1 - d_i^2 / r_i^2)^2,  W = max(1, sum_i w_i),  k = sum_i w_i s_i / W
// with d_i the distance in mm: smooth at the radius, never stiffer than the strongest, and damped
// critically together with gamma. With gamma alone strengths of 4 and more did not come to rest in
// 500 iterations: neighbours swing, as the normal of each follows the others. With this 4 takes 49
// and 20 takes 91.
void attach(const UserConstraints& user, const Motion& motion, const Float4* position,
            const Streams3& normal, uint32_t begin, uint32_t end, Streams3& force);

// Whether p lies in one of the pins.
bool pinned(const UserConstraints& user, Vec3 p);

}  // namespace plc
