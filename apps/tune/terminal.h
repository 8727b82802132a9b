// The terminal as a place for pictures and keys: ncurses, in and out. Whatever ends the program,
// the terminal is as it was before.
#pragma once

#include <optional>

#include "apps/tune/view/picture.h"
#include "apps/tune/view/view.h"

namespace footfall::apps {

class TuneTerminal {
 public:
  // Throws std::runtime_error for a terminal that cannot be drawn on; stdin and stdout must be one.
  TuneTerminal();
  ~TuneTerminal();
  TuneTerminal(const TuneTerminal&) = delete;
  TuneTerminal& operator=(const TuneTerminal&) = delete;

  int width() const;
  int height() const;
  bool unicode() const { return unicode_; }
  void show(const Picture& picture);
  // Everything is drawn anew by the next show().
  void forget();
  // The next key that was pressed; none: no more at the moment.
  std::optional<TuneKey> key();
  // SIGINT, SIGTERM or SIGHUP came: time to leave.
  static bool is_told_to_stop();

 private:
  bool unicode_ = true, colours_ = false;
};

}  // namespace footfall::apps
