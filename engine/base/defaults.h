// What is asked for where nobody says otherwise. The engine's own records and the list of what the
// C API offers both begin with these numbers, so that a test of the engine tests what is shipped.
#pragma once

namespace plc::defaults {

inline constexpr double kCurvature = 0.4;      // alpha_c (5)
inline constexpr double kSpring = 0;           // alpha_e (6)
inline constexpr double kRestLength = 1.5;     // of RestLength::kValue, in delta
inline constexpr double kAttraction = 1;       // |alpha_I| (7)
inline constexpr double kGradientBound = 0.1;  // of (8), in window per U_h
inline constexpr double kMass = 1;             // m (4)
inline constexpr double kDamping = 0.5;        // gamma (4)
inline constexpr double kTimeStep = 1.5;       // dt
inline constexpr double kMaxMove = 0.4;        // in delta
inline constexpr double kEpsilon = 5e-6;       // of the energy at which a level has converged
inline constexpr double kCalmSpeed = 0;        // the fastest vertex is not asked about
inline constexpr int kMaxIterations = 1000;    // of a level

}  // namespace plc::defaults
