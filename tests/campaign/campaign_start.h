// Where the evolution of a case starts from, and what else a host may give.
#pragma once
#include "tests/campaign/campaign_case.h"

namespace campaign {

// init, bubbles, and the seeds, mask or mesh of it. Before it: the image, its values, the levels.
void choose_start(Case& c);

// Attachments, pins, a force, what the callbacks answer.
void choose_extras(Case& c);

// The mesh of voxel indices in the space of the extras, its faces turned where that mirrors.
samples::Soup in_space(const Case& c, samples::Soup mesh);

// An ellipsoid in voxel indices; about 8 * 4^fineness faces.
samples::Soup ellipsoid(const Point& centre, const Point& radii, int fineness);

}  // namespace campaign
