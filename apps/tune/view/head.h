// Status of the robot in a few lines: for the head of the full screen and for `watch`.
#pragma once

#include "apps/tune/model/model.h"
#include "apps/tune/view/picture.h"

namespace footfall::apps {

inline constexpr double kLongSilence = 1.5;  // s: the engine sends its values twice a second

// `running`, `fallen`, ...; empty before the first message.
std::string condition_text(const TuneModel& model);
// The active atomic states, separated by blanks.
std::string states_text(const TuneModel& model);
// Behavior, robot, time, condition; state; feet and tick; tasks; faults.
std::vector<StyledLine> head_lines(const TuneModel& model, double silence, int width);

}  // namespace footfall::apps
