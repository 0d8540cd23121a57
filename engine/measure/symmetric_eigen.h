// Eigenvalues and axes of a symmetric 3 x 3 matrix by Jacobi's rotations: accurate to a few
// roundings of the largest eigenvalue, for any matrix, and always the same for the same bits.
#pragma once
#include <array>

namespace plc {

// xx, yy, zz, xy, yz, zx.
using SymmetricMatrix = std::array<double, 6>;

struct SymmetricEigen {
  std::array<double, 3> value;  // the largest first
  // A right-handed frame of unit axes, axis[i] of value[i]. The component of largest magnitude (the
  // first of equal ones) of the first two axes is positive. Axes of equal values are any frame.
  std::array<std::array<double, 3>, 3> axis;
};

// NaN in every value and axis where the matrix has one or an infinity.
SymmetricEigen symmetric_eigen(const SymmetricMatrix& matrix);

}  // namespace plc
