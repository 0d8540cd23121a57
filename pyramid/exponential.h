// The exponential function that the surface depends on: C libraries give other last bits than each
// other, and one of them on processors with and without multiply-add.
#pragma once

namespace plc {

// e^x, rounded once from a result good to 2^-96 of it; 0 below the normal numbers, infinity above
// the finite ones, NaN of NaN. Made of + - * / and exact scaling alone: the same bits everywhere.
double exponential(double x);

}  // namespace plc
