// Effect of keys; see view.h.
#include "apps/tune/view/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/tune/view/pages.h"
#include "apps/tune/view/prompt.h"
#include "core/index.h"

namespace footfall::apps {
namespace {

constexpr int kPage = 10;  // rows moved by page keys
constexpr double kLarge = 10.0, kSmall = 0.1;
constexpr double kShortestWindow = 1.0, kLongestWindow = 120.0;  // s

using Code = TuneKey::Code;

// Moves a selection; true if the key does that.
bool moves(Code code, int& selected, int count) {
  switch (code) {
    case TuneKey::up:
      --selected;
      break;
    case TuneKey::down:
      ++selected;
      break;
    case TuneKey::page_up:
      selected -= kPage;
      break;
    case TuneKey::page_down:
      selected += kPage;
      break;
    case TuneKey::home:
      selected = 0;
      break;
    case TuneKey::end:
      selected = count - 1;
      break;
    default:
      return false;
  }
  selected = std::max(0, std::min(selected, count - 1));
  return true;
}

void begin_prompt(TuneView& view, TunePrompt prompt, std::string typed = {}) {
  const bool choice = prompt == TunePrompt::signal || prompt == TunePrompt::event;
  view.mode = choice ? TuneMode::choice : TuneMode::prompt;
  view.prompt = prompt;
  view.typed = std::move(typed);
  view.choice = view.choice_top = 0;
  view.message.clear();
}

void step(TuneView& view, const TuneModel& model, TuneOutbox& outbox, double steps) {
  const int index = selected_entry(model, view);
  if (index < 0) return;
  const TuneEntry& entry = model.entries[at(index)];
  const TuneParameter& parameter = model.parameters[at(entry.parameter)];
  const double before = outbox.expected(model, index);
  double value = stepped(before, entry.step, steps, parameter.unit);
  if (parameter.has_range())
    value = std::clamp(value, parameter.min, parameter.max);
  else if (parameter.gain)
    value = std::max(value, 0.0);
  if (value == before) {
    show_message(
        view, fmt::format("{} is at the end of its range, {}", entry.name, range_text(parameter)),
        true);
    return;
  }
  view.message.clear();
  outbox.want(model, index, value, view.over);
}

void back_to_file(TuneView& view, const TuneModel& model, TuneOutbox& outbox) {
  const int index = selected_entry(model, view);
  if (index < 0) return;
  const double value = model.value_of_file(model.entries[at(index)].slot);
  if (value == outbox.expected(model, index)) {
    show_message(view, fmt::format("{} is what the file says", model.entries[at(index)].name),
                 false);
  } else {
    outbox.want(model, index, value, view.over);
  }
}

void type_value(TuneView& view, const TuneModel& model, const TuneOutbox& outbox) {
  const int index = selected_entry(model, view);
  if (index < 0) return;
  const TuneParameter& parameter = model.parameters[at(model.entries[at(index)].parameter)];
  const double value = outbox.expected(model, index);
  begin_prompt(view, TunePrompt::value, exact_values(std::array{value}, parameter.unit));
}

// Number of steps of a key; 0 for other keys.
double steps_of(char letter) {
  switch (letter) {
    case '+':
      return 1.0;
    case '-':
      return -1.0;
    case '>':
      return kLarge;
    case '<':
      return -kLarge;
    case '.':
      return kSmall;
    case ',':
      return -kSmall;
    default:
      return 0.0;
  }
}

// Keys that open a prompt, a choice or a page.
bool opens(TuneView& view, char letter) {
  switch (letter) {
    case '/':
      begin_prompt(view, TunePrompt::filter, view.filter);
      return true;
    case ':':
      begin_prompt(view, TunePrompt::command);
      return true;
    case 'o':
      begin_prompt(view, TunePrompt::over, shown_value(view.over, {"ms", 1e-3}));
      return true;
    case 'p':
      begin_prompt(view, TunePrompt::signal);
      return true;
    case 'e':
      begin_prompt(view, TunePrompt::event);
      return true;
    case '?':
      show_page(view, "keys", help_lines());
      return true;
    default:
      return false;
  }
}

TuneCommand press_letter(TuneView& view, const TuneModel& model, TuneOutbox& outbox, char letter) {
  if (const double steps = steps_of(letter); steps != 0.0) {
    step(view, model, outbox, steps);
    return TuneCommand::none;
  }
  if (opens(view, letter)) return TuneCommand::none;
  switch (letter) {
    case '=':
      type_value(view, model, outbox);
      break;
    case 'f':
      back_to_file(view, model, outbox);
      break;
    case '[':
      view.window = std::max(kShortestWindow, view.window / 2.0);
      break;
    case ']':
      view.window = std::min(kLongestWindow, view.window * 2.0);
      break;
    case 'u':
      outbox.ask(undo_request(false));
      break;
    case 'r':
      outbox.ask(undo_request(true));
      break;
    case 'c':
      return TuneCommand::compare;
    case 's':
      view.overlay.clear();
      return TuneCommand::preview_save;
    case 'q':
      return TuneCommand::quit;
    default:
      show_message(view, "? shows what keys do", false);
  }
  return TuneCommand::none;
}

TuneCommand press_in_list(TuneView& view, const TuneModel& model, TuneOutbox& outbox,
                          const TuneKey& key) {
  const int count = static_cast<int>(shown_entries(model, view).size());
  if (moves(key.code, view.selected, count)) return TuneCommand::none;
  switch (key.code) {
    case TuneKey::right:
      step(view, model, outbox, 1.0);
      break;
    case TuneKey::left:
      step(view, model, outbox, -1.0);
      break;
    case TuneKey::enter:
      type_value(view, model, outbox);
      break;
    case TuneKey::escape:
      view.filter.clear();
      view.message.clear();
      break;
    case TuneKey::text:
      return press_letter(view, model, outbox, key.sign.size() == 1 ? key.sign[0] : '\0');
    default:
      break;
  }
  return TuneCommand::none;
}

TuneCommand finish_prompt(TuneView& view, const TuneModel& model, TuneOutbox& outbox) {
  bool done = true;
  view.message.clear();
  switch (view.prompt) {
    case TunePrompt::value:
      done = finish_value(view, model, outbox);
      break;
    case TunePrompt::command:
      done = finish_command(view, model, outbox);
      break;
    case TunePrompt::over:
      done = finish_over(view);
      break;
    case TunePrompt::overlay:
      view.mode = TuneMode::list;
      view.overlay = view.typed;
      return view.typed.empty() ? TuneCommand::none : TuneCommand::preview_save;
    default:
      break;
  }
  if (done) view.mode = TuneMode::list;
  return TuneCommand::none;
}

void erase_last_sign(std::string& text) {
  while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) text.pop_back();
  if (!text.empty()) text.pop_back();
}

TuneCommand press_in_prompt(TuneView& view, const TuneModel& model, TuneOutbox& outbox,
                            const TuneKey& key) {
  switch (key.code) {
    case TuneKey::text:
      view.typed += key.sign;
      break;
    case TuneKey::backspace:
      erase_last_sign(view.typed);
      break;
    case TuneKey::enter:
      return finish_prompt(view, model, outbox);
    case TuneKey::escape:
      if (view.prompt == TunePrompt::filter) view.filter.clear();
      view.mode = TuneMode::list;
      return TuneCommand::none;
    default:
      if (view.prompt == TunePrompt::filter) {
        moves(key.code, view.selected, static_cast<int>(shown_entries(model, view).size()));
      }
  }
  if (view.prompt == TunePrompt::filter && view.filter != view.typed) {
    view.filter = view.typed;
    view.selected = view.top = 0;
  }
  return TuneCommand::none;
}

void choose(TuneView& view, const TuneModel& model, TuneOutbox& outbox) {
  const std::vector<std::string> names = offered(model, view);
  view.mode = TuneMode::list;
  if (names.empty()) return;
  const std::string& name =
      names[at(std::clamp(view.choice, 0, static_cast<int>(names.size()) - 1))];
  if (view.prompt == TunePrompt::signal)
    view.signal = name;
  else
    outbox.ask(edit_request({}, {name}, 0.0, -1));
}

TuneCommand press_in_choice(TuneView& view, const TuneModel& model, TuneOutbox& outbox,
                            const TuneKey& key) {
  if (moves(key.code, view.choice, static_cast<int>(offered(model, view).size()))) {
    return TuneCommand::none;
  }
  switch (key.code) {
    case TuneKey::enter:
      choose(view, model, outbox);
      break;
    case TuneKey::escape:
      view.mode = TuneMode::list;
      break;
    case TuneKey::text:
      view.typed += key.sign;
      view.choice = 0;
      break;
    case TuneKey::backspace:
      erase_last_sign(view.typed);
      view.choice = 0;
      break;
    default:
      break;
  }
  return TuneCommand::none;
}

TuneCommand press_in_page(TuneView& view, const TuneKey& key) {
  int last = view.page_top;
  if (moves(key.code, last, static_cast<int>(view.page.size()))) {
    view.page_top = last;
    return TuneCommand::none;
  }
  const bool asks = view.mode == TuneMode::confirm;
  const char letter = key.code == TuneKey::text && key.sign.size() == 1 ? key.sign[0] : '\0';
  if (asks && letter == 'o') {
    begin_prompt(view, TunePrompt::overlay);
    return TuneCommand::none;
  }
  view.mode = TuneMode::list;
  if (asks && letter == 'y') return TuneCommand::write;
  if (asks) show_message(view, "nothing was written", false);
  return TuneCommand::none;
}

}  // namespace

int selected_entry(const TuneModel& model, const TuneView& view) {
  const std::vector<int> shown = shown_entries(model, view);
  return shown.empty()
             ? -1
             : shown[at(std::clamp(view.selected, 0, static_cast<int>(shown.size()) - 1))];
}

std::vector<int> shown_entries(const TuneModel& model, const TuneView& view) {
  std::vector<int> shown;
  for (int i = 0; i < static_cast<int>(model.entries.size()); ++i) {
    if (passes_filter(model.entries[at(i)].name, view.filter)) shown.push_back(i);
  }
  return shown;
}

std::vector<std::string> offered(const TuneModel& model, const TuneView& view) {
  std::vector<std::string> names;
  const bool signals = view.prompt == TunePrompt::signal;
  for (const std::string& name : signals ? model.catalogue.signals : model.catalogue.events) {
    if (passes_filter(name, view.typed)) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

TuneCommand press(TuneView& view, const TuneModel& model, TuneOutbox& outbox, const TuneKey& key) {
  if (key.code == TuneKey::redraw) return TuneCommand::redraw;
  switch (view.mode) {
    case TuneMode::list:
      return press_in_list(view, model, outbox, key);
    case TuneMode::prompt:
      return press_in_prompt(view, model, outbox, key);
    case TuneMode::choice:
      return press_in_choice(view, model, outbox, key);
    case TuneMode::page:
    case TuneMode::confirm:
      return press_in_page(view, key);
  }
  return TuneCommand::none;
}

void show_message(TuneView& view, std::string text, bool bad) {
  view.message = std::move(text);
  view.message_is_bad = bad;
}

void show_page(TuneView& view, std::string title, std::vector<StyledLine> lines) {
  view.mode = TuneMode::page;
  view.page_title = std::move(title);
  view.page = std::move(lines);
  view.page_top = 0;
}

}  // namespace footfall::apps
