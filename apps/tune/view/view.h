// State of the full screen and the effect of keys. No terminal: keys in, commands out.
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
  std::string sign;  // UTF-8 character of `text`
};

// Current use of the lower part or the list.
enum class TuneMode { list, prompt, choice, page, confirm };
// Purpose of the prompt or choice.
enum class TunePrompt { filter, value, command, over, overlay, signal, event };

// Action for the loop around the screen.
enum class TuneCommand { none, compare, preview_save, write, quit, redraw };

struct TuneView {
  TuneMode mode = TuneMode::list;
  TunePrompt prompt = TunePrompt::filter;
  std::string filter;
  int selected = 0, top = 0;  // rows of the displayed list
  std::string typed;
  int choice = 0, choice_top = 0;
  std::string page_title;
  std::vector<StyledLine> page;
  int page_top = 0;
  std::string overlay;   // file to save to; empty: the files that define the values
  std::string signal;    // plotted signal
  double window = 10.0;  // s, time window of the plot
  double over = 0.0;     // s, ramp duration of changes by keys
  std::string message;
  bool message_is_bad = false;
};

// Indices into model.entries of those that pass the filter.
std::vector<int> shown_entries(const TuneModel& model, const TuneView& view);
// The selected one of them; -1 if none.
int selected_entry(const TuneModel& model, const TuneView& view);
// Names in the choice, filtered by the typed text.
std::vector<std::string> offered(const TuneModel& model, const TuneView& view);

// Handles a key.
TuneCommand press(TuneView& view, const TuneModel& model, TuneOutbox& outbox, const TuneKey& key);

void show_message(TuneView& view, std::string text, bool bad);
void show_page(TuneView& view, std::string title, std::vector<StyledLine> lines);

}  // namespace footfall::apps
