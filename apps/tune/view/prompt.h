// Evaluates texts typed into prompts of the full screen: false, with a message, if invalid.
#pragma once

#include "apps/tune/view/view.h"

namespace footfall::apps {

// New value of the selected entry.
bool finish_value(TuneView& view, const TuneModel& model, TuneOutbox& outbox);
// `NAME=VALUE ...`: one request.
bool finish_command(TuneView& view, const TuneModel& model, TuneOutbox& outbox);
// Ramp duration of changes.
bool finish_over(TuneView& view);

}  // namespace footfall::apps
