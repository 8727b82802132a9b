// Layout of the full screen for any size.
#pragma once

#include "apps/tune/view/view.h"

namespace footfall::apps {

inline constexpr int kLeastWidth = 60, kLeastHeight = 16;  // characters

// State of the connection, for drawing.
struct TuneLink {
  double silence = 0.0;  // s since the last message from the engine
  std::string trouble;   // why no engine answers; shown during silence
  bool unicode = true;   // the terminal supports Braille and line characters
};

// Returns exactly `height` lines of `width` columns. Scrolls the lists of `view` to the selection.
Picture draw(const TuneModel& model, TuneView& view, const TuneOutbox& outbox, const TuneLink& link,
             int width, int height);

}  // namespace footfall::apps
