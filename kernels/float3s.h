// Three streams of one vector quantity: x, y and z of every vertex.
#pragma once

namespace plc::kernels {

struct ConstFloat3s {
  const float *x, *y, *z;
};
struct Float3s {
  float *x, *y, *z;
  operator ConstFloat3s() const { return {x, y, z}; }
};

}  // namespace plc::kernels
