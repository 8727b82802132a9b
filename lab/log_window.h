// A part of a log in time: what a report around a moment is made of.
#pragma once

#include "lab/log_reader.h"

namespace footfall::lab {

// Rows and events from `from` to `to` (s, both included); everything else as it is. May be empty.
Log log_window(const Log& log, double from, double to);

}  // namespace footfall::lab
