// Loader steps that build the control: signals, gains, torque loops, one ControlSpec for each
// configuration. Load time only.
#pragma once

#include "behaviors/load/context.h"

namespace footfall::behaviors {

void load_signals(LoadContext& context);       // signals.cc
void load_gains(LoadContext& context);         // gains.cc
void load_torque_loops(LoadContext& context);  // torque_loop.cc
void load_control(LoadContext& context);       // control.cc
// After load_control(), when all gains have their names: reports those of --set that are unknown.
void check_gain_settings(LoadContext& context);  // gains.cc

}  // namespace footfall::behaviors
