// Evaluates prompts; see prompt.h.
#include "apps/tune/view/prompt.h"

#include <fmt/format.h>

#include "core/index.h"

namespace footfall::apps {

bool finish_value(TuneView& view, const TuneModel& model, TuneOutbox& outbox) {
  const int index = selected_entry(model, view);
  if (index < 0) return true;
  const TuneParameter& parameter = model.parameters[at(model.entries[at(index)].parameter)];
  const ReadValues read = read_values(view.typed, parameter.dimension, 1);
  if (!read.problem.empty()) {
    show_message(view, read.problem, true);
    return false;
  }
  outbox.want(model, index, read.values[0], view.over);
  return true;
}

bool finish_command(TuneView& view, const TuneModel& model, TuneOutbox& outbox) {
  // Names and values have blanks only inside brackets and before units: a `=` begins a new setting.
  std::vector<std::string> texts;
  std::string word;
  for (const char c : view.typed + " ") {
    if (c != ' ') {
      word += c;
      continue;
    }
    if (word.find('=') != std::string::npos || texts.empty())
      texts.push_back(word);
    else
      texts.back() += " " + word;
    word.clear();
  }
  if (texts.size() == 1 && texts[0].empty()) return true;
  std::vector<std::string> problems;
  auto changes = read_changes(model, texts, problems);
  if (!problems.empty()) {
    show_message(view, problems[0], true);
    return false;
  }
  outbox.ask(edit_request(std::move(changes), {}, view.over, -1));
  return true;
}

bool finish_over(TuneView& view) {
  const auto over = read_duration(view.typed);
  if (!over)
    show_message(view, fmt::format("expected a time such as 500 ms, got '{}'", view.typed), true);
  else
    view.over = *over;
  return over.has_value();
}

}  // namespace footfall::apps
