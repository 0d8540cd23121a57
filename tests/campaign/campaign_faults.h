// Inputs that are wrong on purpose.
#pragma once
#include "tests/campaign/campaign_case.h"

namespace campaign {

// Spoils one thing of a case that is complete; from then on the case must be refused.
void choose_fault(Case& c, Random& random);

}  // namespace campaign
