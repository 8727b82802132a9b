// The moments that a film strip shows.
#pragma once

#include <string>
#include <vector>

#include "lab/log/reader.h"

namespace footfall::lab {

inline constexpr int kStripColumns = 8;  // two rows

struct StripMoments {
  std::vector<double> times;  // s, of 2 kStripColumns pictures
  std::string caption;        // what the rows are
};

// A row over the whole run, and one over what matters most in it: its end if the robot fell or was
// stopped by a fault, else the last push, else the last steps. Of a part both rows are over the
// part. Of a log without rows nothing.
StripMoments strip_moments(const Log& log);

// A state's path below a picture, without its first part if two are left: `right_foot lift carry`.
// Feet are the second part in gaits, however deep the states below them are.
std::string state_caption(const std::string& path);

}  // namespace footfall::lab
