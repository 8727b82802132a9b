// A part of a log in time: what a report around a moment is made of.
#pragma once

#include "lab/log/reader.h"

namespace footfall::lab {

// Rows and events from `from` to `to` (s, both included); everything else as it is. May be empty.
Log log_window(const Log& log, double from, double to);

// Of a log read with all_rows, what it would have been without.
void keep_even_rows(Log& log);

}  // namespace footfall::lab
