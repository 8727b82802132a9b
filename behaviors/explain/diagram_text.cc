// Wraps and joins the texts of a diagram; see diagram_text.h.
#include "behaviors/explain/diagram_text.h"

#include <fmt/format.h>

namespace footfall::behaviors {

std::vector<std::string> wrap(std::string_view text, std::size_t width) {
  std::vector<std::string> lines;
  std::string line;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word.empty()) continue;
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      lines.push_back(std::move(line));
      line = "  ";  // continuation lines are indented
    } else if (!line.empty()) {
      line += ' ';
    }
    line += word;
  }
  if (!line.empty()) lines.push_back(std::move(line));
  return lines;
}

std::vector<std::string> wrap_all(const std::vector<std::string>& lines, std::size_t width) {
  std::vector<std::string> out;
  for (const std::string& line : lines) {
    for (std::string& part : wrap(line, width)) out.push_back(std::move(part));
  }
  return out;
}

std::vector<std::string> details_of(const DiagramState& state, std::size_t width) {
  std::vector<std::string> lines = state.notes;
  if (state.safe) lines.emplace_back("safe: on a fault, and at the end");
  if (!state.origin.empty()) lines.push_back(state.origin);
  if (state.closed > 0) lines.push_back(fmt::format("... {} states inside", state.closed));
  lines.insert(lines.end(), state.control.begin(), state.control.end());
  lines.insert(lines.end(), state.actions.begin(), state.actions.end());
  return wrap_all(lines, width);
}

bool is_inside(const Diagram& diagram, int state, int ancestor) {
  for (int s = state; s > 0;) {
    s = diagram.states[static_cast<std::size_t>(s)].parent;
    if (s == ancestor) return true;
  }
  return false;
}

}  // namespace footfall::behaviors
