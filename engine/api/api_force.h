// The host's force callback as a force of the engine.
#pragma once
#include "engine/api/frame.h"
#include "engine/pellicle.h"
#include "engine/recover/recovery.h"
#include "pyramid/executor.h"

namespace plc {

// Empty where the extras have no force. All are borrowed.
LevelForce level_force(const plc_extras& extras, const Frame& frame, const Executor& executor);

}  // namespace plc
