// Numbers as people read them in what the command prints: six digits, and "not defined" for NaN.
#pragma once
#include <cmath>
#include <cstdio>
#include <string>

namespace plc::tools {

inline std::string rounded(double value) {
  if (std::isnan(value)) return "not defined";
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

inline std::string rounded_range(double low, double high) {
  return std::isnan(low) ? rounded(low) : rounded(low) + " .. " + rounded(high);
}

template <typename Triple>
std::string rounded_triple(const Triple& x) {
  if (std::isnan(x[0])) return rounded(x[0]);
  return rounded(x[0]) + ", " + rounded(x[1]) + ", " + rounded(x[2]);
}

}  // namespace plc::tools
