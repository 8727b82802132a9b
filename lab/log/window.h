// Time window of a log, for a report around one moment.
#pragma once

#include "lab/log/reader.h"

namespace footfall::lab {

// Rows and events from `from` to `to` (s, both inclusive); everything else unchanged; Log::part is
// set. May be empty.
Log log_window(const Log& log, double from, double to);

// Reduces a log read with all_rows to the rows that are read without it.
void keep_even_rows(Log& log);

}  // namespace footfall::lab
