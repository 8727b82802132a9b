// Terminal output and keyboard input with ncurses. Restores the terminal however the program ends.
#pragma once

#include <atomic>
#include <cstdio>
#include <memory>
#include <optional>

#include "apps/tune/view/picture.h"
#include "apps/tune/view/view.h"

namespace footfall::apps {

class TuneTerminal {
 public:
  // Throws std::runtime_error if the terminal cannot be controlled; stdin and stdout must be one.
  TuneTerminal();
  ~TuneTerminal();
  TuneTerminal(const TuneTerminal&) = delete;
  TuneTerminal& operator=(const TuneTerminal&) = delete;

  int width() const;
  int height() const;
  bool unicode() const { return unicode_; }
  void show(const Picture& picture);
  // Forces the next show() to redraw everything.
  void forget();
  // The next pressed key; nullopt if there is none.
  std::optional<TuneKey> key();
  // Whether SIGINT, SIGTERM or SIGHUP was received.
  bool is_told_to_stop() const;

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> output_{nullptr, &std::fclose};
  const std::atomic<bool>* told_to_stop_ = nullptr;
  bool unicode_ = true, colours_ = false;
};

}  // namespace footfall::apps
