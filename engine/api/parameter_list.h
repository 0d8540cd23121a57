// The one list of what plc_parameters holds: defaults, ranges, the hash of what a state was made
// with, Python's fields and what hosts are told are made from it.
#pragma once
#include <span>

#include "engine/pellicle.h"

namespace plc {

// In the order of the fields.
std::span<const plc_parameter_info> parameter_list();

// One of a field's values, 0 <= i < info.count.
double parameter_value(const plc_parameters& parameters, const plc_parameter_info& info, int i);
void set_parameter(plc_parameters& parameters, const plc_parameter_info& info, int i, double value);

// How many of a field's values are given: all, but of level_iso as many as level_iso_count says.
int given_values(const plc_parameters& parameters, const plc_parameter_info& info);

}  // namespace plc
