#include "tools/volume/nifti_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "tools/file/failure.h"

namespace plc::tools {
namespace {

// From voxel indices to RAS, row-major: three axes and the place of the first voxel.
using Affine = std::array<std::array<double, 4>, 3>;
using Point = std::array<double, 3>;

double millimetre_of(int units) {
  constexpr int kSpace = 7;  // the others are of time
  switch (units & kSpace) {
    case 1:
      return 1e3;
    case 3:
      return 1e-3;
    default:  // mm, or not told
      return 1;
  }
}

double determinant(const Affine& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

double length_of(const Affine& m, size_t axis) {
  return std::sqrt(m[0][axis] * m[0][axis] + m[1][axis] * m[1][axis] + m[2][axis] * m[2][axis]);
}

Affine sform_of(const NiftiHeader& header) {
  Affine m{};
  for (size_t i = 0; i < header.sform.size(); ++i) m[i / 4][i % 4] = header.sform[i];
  return m;
}

// A quaternion of a header is a, b, c, d with a >= 0 left out; one that roundings have made longer
// than 1 is brought back to it.
Affine qform_of(const NiftiHeader& header) {
  auto [b, c, d, x, y, z] = header.qform;
  const double squared = b * b + c * c + d * d;
  double a = 0;
  if (squared < 1) {
    a = std::sqrt(1 - squared);
  } else {
    const double norm = std::sqrt(squared);
    b /= norm;
    c /= norm;
    d /= norm;
  }
  const double rotation[3][3] = {
      {a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
      {2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)},
      {2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - c * c - b * b}};
  Affine m{};
  for (size_t row = 0; row < 3; ++row) {
    for (size_t axis = 0; axis < 3; ++axis) {
      m[row][axis] = rotation[row][axis] * std::abs(header.pixdim[axis + 1]);
    }
    if (header.pixdim[0] < 0) m[row][2] = -m[row][2];  // qfac
  }
  m[0][3] = x;
  m[1][3] = y;
  m[2][3] = z;
  return m;
}

// As nibabel and SPM have it.
Affine without_form(const NiftiHeader& header, const std::array<double, 3>& last) {
  Affine m{};
  for (size_t axis = 0; axis < 3; ++axis) {
    const double side = (axis == 0 ? -1 : 1) * std::abs(header.pixdim[axis + 1]);
    m[axis][axis] = side;
    m[axis][3] = -0.5 * side * last[axis];
  }
  return m;
}

bool is_frame(const Affine& m) {
  for (size_t axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(m[axis][3]) || !(length_of(m, axis) > 0)) return false;
  }
  constexpr double kFlat = 1e-2;  // the volume of a voxel over that of a box of its sides
  const double box = length_of(m, 0) * length_of(m, 1) * length_of(m, 2);
  return std::isfinite(box) && std::abs(determinant(m)) > kFlat * box;
}

Point at(const Affine& m, const Point& p) {
  Point out{};
  for (size_t row = 0; row < 3; ++row) {
    out[row] = m[row][0] * p[0] + m[row][1] * p[1] + m[row][2] * p[2] + m[row][3];
  }
  return out;
}

std::string text_of(const Point& p) {
  char text[120];
  // + 0: no zero has a sign.
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", p[0] + 0.0, p[1] + 0.0, p[2] + 0.0);
  return text;
}

struct Difference {
  double distance = 0;
  Point corner{};  // voxel indices
};

// Of the corner of the image that two frames put farthest from each other.
Difference largest_difference(const Affine& a, const Affine& b, const Point& last) {
  Difference largest;
  for (unsigned i = 0; i < 8; ++i) {
    Point corner;
    for (unsigned axis = 0; axis < 3; ++axis) corner[axis] = (i >> axis & 1U) * last[axis];
    const Point p = at(a, corner);
    const Point q = at(b, corner);
    const double distance =
        std::sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                  (p[2] - q[2]) * (p[2] - q[2]));
    if (distance > largest.distance) largest = {distance, corner};
  }
  return largest;
}

std::vector<std::string> compare_forms(const std::string& path, const Affine& sform,
                                       const Affine& qform, const Point& last) {
  constexpr double kMost = 0.5;  // of the smallest side of a voxel
  const Difference d = largest_difference(sform, qform, last);
  const double side = std::min({length_of(sform, 0), length_of(sform, 1), length_of(sform, 2)});
  if (!(d.distance > kMost * side)) return {};
  const bool mirrored = determinant(sform) * determinant(qform) < 0;
  return {path + ": its sform and its qform differ" +
          (mirrored ? ", one is a mirror image of the other" : "") + ": voxel " +
          text_of(d.corner) + " lies at " + text_of(at(sform, d.corner)) +
          " mm RAS by the sform, which is taken, and at " + text_of(at(qform, d.corner)) +
          " by the qform (--nifti-frame chooses)"};
}

Affine scaled(Affine m, double factor) {
  for (auto& row : m) {
    for (double& x : row) x *= factor;
  }
  return m;
}

void set_place(const Affine& ras, ItkHeader& header) {
  for (size_t axis = 0; axis < 3; ++axis) header.spacing[axis] = length_of(ras, axis);
  for (size_t row = 0; row < 3; ++row) {
    // LPS; 0 - x, so that no zero gets a sign.
    const auto turned = [&](double x) { return row < 2 ? 0 - x : x; };
    header.origin[row] = turned(ras[row][3]);
    for (size_t axis = 0; axis < 3; ++axis) {
      header.direction[3 * row + axis] = turned(ras[row][axis]) / header.spacing[axis];
    }
  }
}

}  // namespace

std::vector<std::string> place_nifti(const std::string& path, const NiftiHeader& nifti,
                                     NiftiFrame wanted, ItkHeader& header) {
  Point last{};  // voxel
  for (size_t axis = 0; axis < std::min<size_t>(3, nifti.dims.size()); ++axis) {
    last[axis] = static_cast<double>(nifti.dims[axis] - 1);
  }
  const double mm = millimetre_of(nifti.units);
  std::optional<Affine> sform;
  std::optional<Affine> qform;
  if (nifti.sform_code > 0) sform = scaled(sform_of(nifti), mm);
  if (nifti.qform_code > 0) qform = scaled(qform_of(nifti), mm);
  if ((wanted == NiftiFrame::kSform && !sform) || (wanted == NiftiFrame::kQform && !qform)) {
    throw Failure{path + ": has no " + (wanted == NiftiFrame::kSform ? "sform" : "qform") +
                  " (its code is 0), as --nifti-frame asks for"};
  }
  const bool by_sform = sform && wanted != NiftiFrame::kQform;
  const char* name = by_sform ? "its sform" : qform ? "its qform" : "its voxel spacing";
  const Affine used = by_sform ? *sform : qform ? *qform : scaled(without_form(nifti, last), mm);
  if (!is_frame(used)) {
    throw Failure{path + ": " + name + " is not usable (it is not finite, or its axes do not " +
                  "span space)"};
  }
  set_place(used, header);
  if (!sform && !qform) {
    return {path + ": says nothing of its place (its sform and its qform have the code 0): its " +
            "centre is taken for the origin, its first axis to run to the left"};
  }
  if (wanted == NiftiFrame::kAuto && sform && qform && is_frame(*qform)) {
    return compare_forms(path, *sform, *qform, last);
  }
  return {};
}

}  // namespace plc::tools
