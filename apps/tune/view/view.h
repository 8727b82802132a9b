// The full screen's state, and what keys do to it. No terminal: keys in, commands out.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/tune/model/model.h"
#include "apps/tune/model/outbox.h"
#include "apps/tune/view/picture.h"

namespace footfall::apps {

struct TuneKey {
  enum Code {
    text,
    up,
    down,
    left,
    right,
    page_up,
    page_down,
    home,
    end,
    enter,
    escape,
    backspace,
    redraw
  };
  Code code = text;
  std::string sign;  // of `text`: one sign, UTF-8
};

// What the lower part or the list is used for.
enum class TuneMode { list, prompt, choice, page, confirm };
// What is typed or chosen.
enum class TunePrompt { filter, value, command, over, overlay, signal, event };

// What the loop around the screen has to do.
enum class TuneCommand { none, compare, preview_save, write, quit, redraw };

struct TuneView {
  TuneMode mode = TuneMode::list;
  TunePrompt prompt = TunePrompt::filter;
  std::string filter;
  int selected = 0, top = 0;  // rows of the list that is shown
  std::string typed;
  int choice = 0, choice_top = 0;
  std::string page_title;
  std::vector<StyledLine> page;
  int page_top = 0;
  std::string overlay;   // the file to save into; empty: where the values come from
  std::string signal;    // that is plotted
  double window = 10.0;  // s of the plot
  double over = 0.0;     // s; for changes by keys
  std::string message;
  bool message_is_bad = false;
};

// Entries that pass the filter, as indices into model.entries.
std::vector<int> shown_entries(const TuneModel& model, const TuneView& view);
// The selected one of them; -1: none.
int selected_entry(const TuneModel& model, const TuneView& view);
// Names that the choice offers, filtered by what is typed.
std::vector<std::string> offered(const TuneModel& model, const TuneView& view);

// A key is pressed.
TuneCommand press(TuneView& view, const TuneModel& model, TuneOutbox& outbox, const TuneKey& key);

void show_message(TuneView& view, std::string text, bool bad);
void show_page(TuneView& view, std::string title, std::vector<StyledLine> lines);

}  // namespace footfall::apps
