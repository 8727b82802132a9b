// The figures of a log or of a part of one, by the definitions of metrics.h.
#pragma once

#include "lab/figures/metrics.h"
#include "lab/log/reader.h"

namespace footfall::lab {

// What the log's rows are samples of.
SampleNames sample_names(const Log& log);
// Of a part everything counts, of a whole log what counts of a run. The more rows, the nearer to
// the figures of the run itself: read the log with all_rows.
RunFigures log_figures(const Log& log);

}  // namespace footfall::lab
