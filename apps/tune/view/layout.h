// The full screen as a picture: what is where at which size.
#pragma once

#include "apps/tune/view/view.h"

namespace footfall::apps {

inline constexpr int kLeastWidth = 60, kLeastHeight = 16;  // characters

// What the picture must know beside model and view.
struct TuneLink {
  double silence = 0.0;  // s since the engine was heard
  std::string trouble;   // why nobody answers; shown while it is silent
  bool unicode = true;   // the terminal shows Braille and lines
};

// Lines of exactly `width` columns, `height` of them. Scrolls view's lists to what is selected.
Picture draw(const TuneModel& model, TuneView& view, const TuneOutbox& outbox, const TuneLink& link,
             int width, int height);

}  // namespace footfall::apps
