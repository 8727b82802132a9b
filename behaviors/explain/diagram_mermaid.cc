// A diagram as a Mermaid `stateDiagram-v2`; see diagram.h. Mermaid has neither history states nor
// named final states: they are drawn as states named H, H* and as a state that leads to the end
// mark. Nor can it draw an arrow between a composite state and its content: a node `in any state`
// replaces the composite state.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/explain/diagram.h"
#include "behaviors/explain/diagram_text.h"

namespace footfall::behaviors {
namespace {

constexpr std::size_t kMermaidDetailWidth = 60;

// Replaces every character with a meaning in Mermaid's grammar by its `#code;` entity.
std::string escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20) {
      out += ' ';
    } else if (std::string_view("#;:\"<>&{}[]`\\%").find(c) != std::string_view::npos ||
               (c == '-' && (out.empty() || out.back() == '-'))) {  // `--`, `-->`
      out += fmt::format("#{};", byte);
    } else {
      out += c;
    }
  }
  return out;
}

class MermaidWriter {
 public:
  explicit MermaidWriter(const Diagram& diagram) : diagram_(diagram) {}

  std::string write() {
    out_ = "---\ntitle: \"" + escape(diagram_.name) + "\"\n---\nstateDiagram-v2\n";
    for (const std::string& line : details_of(state(0), kMermaidDetailWidth)) {
      out_ += "  %% " + escape(line) + "\n";
    }
    write_inside(0, "  ");
    return out_;
  }

 private:
  const DiagramState& state(int s) const { return diagram_.states[static_cast<std::size_t>(s)]; }

  void write_inside(int s, const std::string& indent) {
    for (const int target : state(s).initial)
      out_ += fmt::format("{}[*] --> s{}\n", indent, target);
    bool first = true;
    for (const int child : state(s).children) {
      if (state(child).region && !first) out_ += indent + "--\n";
      if (state(child).region) first = false;
      write_state(child, indent);
    }
    bool any_state = false;
    for (const DiagramEdge& edge : diagram_.edges) {
      if (scope_of(edge) == s) write_edge(edge, indent, any_state);
    }
  }

  bool within(int state_index, int ancestor) const {
    return state_index == ancestor || is_inside(diagram_, state_index, ancestor);
  }

  // The innermost composite state that contains both ends and is not parallel: a node beside the
  // regions of a parallel state would be in none of them.
  int scope_of(const DiagramEdge& edge) const {
    int scope = state(edge.source).children.empty() ? state(edge.source).parent : edge.source;
    const auto holds = [&](int target) { return is_inside(diagram_, target, scope); };
    while (scope > 0 && (state(scope).kind == StateKind::parallel ||
                         !std::ranges::all_of(edge.targets, holds))) {
      scope = state(scope).parent;
    }
    return std::max(scope, 0);
  }

  void write_state(int s, const std::string& indent) {
    const DiagramState& info = state(s);
    std::string title = escape(info.name);
    if (info.kind == StateKind::history_shallow) title = "H";
    if (info.kind == StateKind::history_deep) title = "H*";
    const std::vector<std::string> lines = details_of(info, kMermaidDetailWidth);
    if (!info.children.empty()) {  // one line only: Mermaid draws the content over a second one
      for (const std::string& line : lines) title += " · " + escape(line);
      out_ += fmt::format("{}state \"{}\" as s{} {{\n", indent, title, s);
      write_inside(s, indent + "  ");
      out_ += indent + "}\n";
      return;
    }
    for (const std::string& line : lines) title += "<br/>" + escape(line);
    out_ += fmt::format("{}state \"{}\" as s{}\n", indent, title, s);
    if (info.kind == StateKind::final) out_ += fmt::format("{}s{} --> [*]\n", indent, s);
    if (info.children.empty() && info.kind != StateKind::final) {
      for (const int target : info.initial) {
        out_ += fmt::format("{}s{} --> s{}: default\n", indent, s, target);
      }
    }
  }

  void write_edge(const DiagramEdge& edge, const std::string& indent, bool& any_state) {
    std::string label;
    for (const std::string& line : edge.label) label += (label.empty() ? "" : " ") + escape(line);
    for (const int target : edge.targets) {
      std::string from = fmt::format("s{}", edge.source), to = fmt::format("s{}", target);
      if (!state(edge.source).children.empty() && within(target, edge.source)) {
        from = fmt::format("any{}", edge.source);
        if (!any_state) out_ += fmt::format("{}state \"in any state\" as {}\n", indent, from);
        any_state = true;
      }
      if (!state(target).children.empty() && within(edge.source, target)) {
        to = fmt::format("again{}", entered_again_++);
        out_ += fmt::format("{}state \"enters {} anew\" as {}\n", indent,
                            escape(state(target).name), to);
      }
      out_ += fmt::format("{}{} --> {}{}\n", indent, from, to, label.empty() ? "" : ": " + label);
    }
  }

  const Diagram& diagram_;
  std::string out_;
  int entered_again_ = 0;
};

}  // namespace

std::string to_mermaid(const Diagram& diagram) { return MermaidWriter(diagram).write(); }

}  // namespace footfall::behaviors
