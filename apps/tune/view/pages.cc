// Pages of the full screen; see pages.h.
#include "apps/tune/view/pages.h"

#include <algorithm>

namespace footfall::apps {
namespace {

StyledLine help_line(const char* keys, const char* text) {
  return {{fitted(keys, 14), Style::key}, {text}};
}

}  // namespace

std::vector<StyledLine> comparison(const TuneModel& model) {
  std::vector<StyledLine> lines;
  for (const TuneParameter& parameter : model.parameters) {
    if (!differs_from_file(model, parameter)) continue;
    lines.push_back({{parameter.name, Style::strong}});
    lines.push_back({{"  file  " + shown_values(file_of(model, parameter), parameter.unit)}});
    lines.push_back(
        {{"  now   " + shown_values(target_of(model, parameter), parameter.unit), Style::warning}});
  }
  if (lines.empty()) lines.push_back({{"Every value is what the file says."}});
  return lines;
}

std::vector<StyledLine> help_lines() {
  return {help_line("up down", "another value (also page up, page down, home, end)"),
          help_line("+ -  or -> <-", "a step up or down"),
          help_line("> <", "ten steps"),
          help_line(". ,", "a tenth of a step"),
          help_line("= or enter", "type a value: 150 ms, 0.15, 220"),
          help_line("f", "the value in the file"),
          help_line(":", "type several at once: lift_time=150ms land_time=155ms"),
          help_line("o", "how long the next changes take (at least the robot's own ramp)"),
          help_line("u r", "undo, redo: the newest change, whoever made it"),
          help_line("c", "compare with the file"),
          help_line("s", "save into the file or an overlay: shows first what would change"),
          help_line("/", "filter the list: text or pattern (* and ?); escape: all"),
          help_line("p", "plot another signal"),
          help_line("[ ]", "a shorter or longer time in the plot"),
          help_line("e", "raise an event"),
          help_line("q", "quit: the robot goes on with the values as they are")};
}

std::vector<StyledLine> diff_lines(std::string_view diff) {
  std::vector<StyledLine> lines;
  while (!diff.empty()) {
    const std::string_view line = diff.substr(0, diff.find('\n'));
    const bool head = line.starts_with("+++") || line.starts_with("---");
    const Style style = head                    ? Style::strong
                        : line.starts_with('+') ? Style::good
                        : line.starts_with('-') ? Style::bad
                        : line.starts_with('@') ? Style::dim
                                                : Style::plain;
    lines.push_back({{std::string(line), style}});
    diff.remove_prefix(std::min(diff.size(), line.size() + 1));
  }
  return lines;
}

}  // namespace footfall::apps
