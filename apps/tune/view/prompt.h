// Texts that were typed into the full screen, taken: false, with a message, where they cannot be.
#pragma once

#include "apps/tune/view/view.h"

namespace footfall::apps {

// The value of the selected entry.
bool finish_value(TuneView& view, const TuneModel& model, TuneOutbox& outbox);
// `NAME=VALUE ...`: one request.
bool finish_command(TuneView& view, const TuneModel& model, TuneOutbox& outbox);
// How long changes take.
bool finish_over(TuneView& view);

}  // namespace footfall::apps
