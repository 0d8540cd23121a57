// The images of the campaign: families of random shapes, sharp or soft.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tests/campaign/campaign_case.h"

namespace campaign {

// About the distance to the surface in mm, positive inside the object; in mm from the middle.
using Field = std::function<double(const Point&)>;

struct Phantom {
  const char* name;
  Field (*make)(Random& random, const samples::Volume& shape);
};
const std::vector<Phantom>& phantoms();

// Values about 0 outside and 1 inside, soft over `softness` mm on either side; 0: either 0 or 1.
samples::Volume drawn(const samples::Volume& shape, const Field& field, double softness);

}  // namespace campaign
