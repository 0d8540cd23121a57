// The same of what takes the place of a compiler's vectors.
#define PLC_PLAIN_FOUR
#include "tests/base/test_four.cpp"
