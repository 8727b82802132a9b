// A diagram as a Graphviz graph; see diagram.h. Graphviz edges join nodes, never clusters: an edge
// of a nested state joins a node inside it and is clipped at the cluster's border (lhead, ltail).
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/explain/diagram.h"
#include "behaviors/explain/diagram_text.h"
#include "core/text/escape.h"

namespace footfall::behaviors {
namespace {

constexpr std::size_t kDetailWidth = 46, kLabelWidth = 30;  // characters a line

constexpr const char* kHead =
    R"(  graph [compound=true, rankdir=TB, nodesep=0.4, ranksep=0.4, fontname="Helvetica", fontsize=11,
         fontcolor="#1f2933", color="#8292a2", labeljust=l, penwidth=1, margin=0.15]
  node [shape=box, style="rounded,filled", fillcolor="#ffffff", color="#4a6785", fontname="Helvetica",
        fontsize=11, fontcolor="#1f2933", margin="0.1,0.06", penwidth=1, height=0.3]
  edge [fontname="Helvetica", fontsize=9, fontcolor="#374151", color="#52606d", arrowsize=0.65]
)";

std::string escape_quoted(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

// A table: the name, and below it lines in a smaller font. `&#160;` keeps the indentation of
// wrapped lines.
std::string label_html(const DiagramState& state, const std::string& title) {
  std::string out = R"(<<TABLE BORDER="0" CELLBORDER="0" CELLSPACING="0" CELLPADDING="1">)";
  const std::vector<std::string> lines = details_of(state, kDetailWidth);
  const bool open = !state.children.empty();  // the label of a cluster is aligned left
  out += fmt::format(R"(<TR><TD ALIGN="{}"><B>{}</B></TD></TR>)", open ? "LEFT" : "CENTER",
                     core::escape_html(title));
  for (const std::string& line : lines) {
    const bool indented = line.starts_with("  ");
    out += fmt::format(
        R"(<TR><TD ALIGN="LEFT"><FONT POINT-SIZE="9" COLOR="{}">{}{}</FONT></TD></TR>)",
        line.starts_with("safe:") ? "#a63232" : "#5f6b7a", indented ? "&#160;&#160;" : "",
        core::escape_html(indented ? line.substr(2) : line));
  }
  return out + "</TABLE>>";
}

class DotWriter {
 public:
  explicit DotWriter(const Diagram& diagram) : diagram_(diagram) {}

  std::string write() {
    const DiagramState& root = state(0);
    out_ = fmt::format("digraph \"{}\" {{\n{}", escape_quoted(diagram_.name), kHead);
    out_ += fmt::format("  label={}; labelloc=t\n", label_html(root, diagram_.name));
    write_children(0, "  ");
    for (std::size_t e = 0; e < diagram_.edges.size(); ++e) write_edge(e);
    return out_ + "}\n";
  }

 private:
  const DiagramState& state(int s) const { return diagram_.states[static_cast<std::size_t>(s)]; }
  bool is_cluster(int s) const { return s > 0 && !state(s).children.empty(); }

  // The node that represents a state at the tail of an edge.
  std::string tail(int s) const {
    while (!state(s).children.empty()) s = state(s).children.back();
    return fmt::format("s{}", s);
  }
  // The node at the head of an edge to a state: the dot from which the state is entered.
  std::string head(int s) const {
    while (!state(s).children.empty()) {
      if (!state(s).initial.empty()) return fmt::format("i{}", s);
      s = state(s).children.front();
    }
    return fmt::format("s{}", s);
  }
  std::string at_head(int s) const {
    return is_cluster(s) ? fmt::format(", lhead=cluster_{}", s) : std::string();
  }
  std::string at_tail(int s) const {
    return is_cluster(s) ? fmt::format(", ltail=cluster_{}", s) : std::string();
  }

  bool leaves_inside(int s) const {
    return std::ranges::any_of(diagram_.edges, [&](const DiagramEdge& edge) {
      return edge.source == s && !state(s).children.empty() && stays_inside(edge);
    });
  }
  // Such an edge is drawn from a small node `any state` inside: Graphviz borders have no inner
  // side.
  bool stays_inside(const DiagramEdge& edge) const {
    return std::ranges::any_of(edge.targets, [&](int target) {
      return target == edge.source || is_inside(diagram_, target, edge.source);
    });
  }

  void write_children(int s, const std::string& indent) {
    if (!state(s).initial.empty()) {
      out_ += fmt::format(
          "{0}i{1} [shape=point, width=0.1, fillcolor=\"#1f2933\", color=\"#1f2933\"]\n", indent,
          s);
    }
    for (const int child : state(s).children) write_state(child, indent);
    for (const int target : state(s).initial) {
      out_ += fmt::format("{0}i{1} -> {2} [weight=4{3}{4}]\n", indent, s, head(target),
                          at_head(target), is_cluster(target) ? ", minlen=2" : "");
    }
    write_waypoints(s, indent);
    if (leaves_inside(s)) {
      out_ += fmt::format(
          "{0}any{1} [shape=plaintext, style=\"\", fontsize=9, fontcolor=\"#5f6b7a\", margin=0.02, "
          "label=<<I>in "
          "any state</I>>]\n",
          indent, s);
    }
  }

  void write_cluster(int s, const std::string& indent) {
    const DiagramState& info = state(s);
    const std::string inner = indent + "  ";
    out_ += fmt::format("{}subgraph cluster_{} {{\n", indent, s);
    const char* style = info.region ? "rounded,filled,dashed" : "rounded,filled";
    const char* fill = depth(s) % 2 == 1 ? "#f3f5f8" : "#fbfcfd";
    out_ +=
        fmt::format("{}label={}; margin=10; style=\"{}\"; fillcolor=\"{}\"; color=\"{}\"\n", inner,
                    label_html(info, info.name), style, fill, info.safe ? "#a63232" : "#8292a2");
    write_children(s, inner);
    out_ += indent + "}\n";
  }

  void write_state(int s, const std::string& indent) {
    const DiagramState& info = state(s);
    if (!info.children.empty()) {
      write_cluster(s, indent);
      return;
    }
    std::string shape;
    if (info.kind == StateKind::final) {
      shape =
          ", shape=doublecircle, style=filled, fillcolor=\"#e4e8ee\", margin=\"0.01\", fontsize=9, "
          "height=0.35";
    } else if (info.kind == StateKind::history_shallow || info.kind == StateKind::history_deep) {
      const char* mark = info.kind == StateKind::history_deep ? "H*" : "H";
      out_ += fmt::format(
          "{}s{} [shape=circle, style=filled, margin=\"0.01\", height=0.3, "
          "label=<<B>{}</B><BR/><FONT "
          "POINT-SIZE=\"8\">{}</FONT>>]\n",
          indent, s, mark, core::escape_html(info.name));
      for (const int target : info.initial) {
        out_ +=
            fmt::format("{}s{} -> {} [style=dashed{}]\n", indent, s, head(target), at_head(target));
      }
      return;
    } else if (info.region) {
      shape = ", style=\"rounded,filled,dashed\"";
    }
    if (!info.fill.empty()) shape += fmt::format(", fillcolor=\"{}\"", info.fill);
    if (info.safe) shape += ", color=\"#a63232\"";
    out_ += fmt::format("{}s{} [label={}{}]\n", indent, s, label_html(info, info.name), shape);
  }

  int depth(int s) const {
    int levels = 0;
    for (; s > 0; s = state(s).parent) ++levels;
    return levels;
  }

  static std::string label_text(const std::vector<std::string>& lines) {
    std::string out;
    for (const std::string& line : wrap_all(lines, kLabelWidth))
      out += " " + escape_quoted(line) + "\\l";
    return out;
  }

  // The innermost state that contains both ends of all branches.
  int common_parent(const DiagramEdge& edge) const {
    int common = state(edge.source).parent;
    const auto holds = [&](int target) {
      return common <= 0 || is_inside(diagram_, target, common);
    };
    while (common > 0 && !std::ranges::all_of(edge.targets, holds)) common = state(common).parent;
    return std::max(common, 0);
  }

  // An intermediate node that carries the label of an edge, or at which it forks: Graphviz places
  // it beside the clusters, never on their borders.
  static bool has_waypoint(const DiagramEdge& edge) {
    return !edge.label.empty() || edge.targets.size() > 1;
  }
  void write_waypoints(int s, const std::string& indent) {
    for (std::size_t e = 0; e < diagram_.edges.size(); ++e) {
      const DiagramEdge& edge = diagram_.edges[e];
      if (!has_waypoint(edge)) continue;
      if ((is_inside_edge(edge) ? edge.source : common_parent(edge)) != s) continue;
      out_ += fmt::format(
          "{}w{} [shape=plaintext, style=\"\", margin=\"0.02,0\", height=0.15, fontsize=9, "
          "fontcolor=\"#374151\", label=\"{}\"]\n",
          indent, e, label_text(edge.label));
    }
  }

  bool is_inside_edge(const DiagramEdge& edge) const {
    return !state(edge.source).children.empty() && stays_inside(edge);
  }

  void write_edge(std::size_t index) {
    const DiagramEdge& edge = diagram_.edges[index];
    const bool inside = is_inside_edge(edge);
    std::string from = inside ? fmt::format("any{}", edge.source) : tail(edge.source);
    std::string border = inside ? std::string() : at_tail(edge.source);
    if (has_waypoint(edge)) {
      out_ += fmt::format("  {} -> w{} [arrowhead=none{}]\n", from, index, border);
      from = fmt::format("w{}", index);
      border.clear();
    }
    for (const int target : edge.targets) {
      // An edge from inside a state to that state ends at the dot inside: it crosses no border.
      const bool from_inside = target == edge.source || is_inside(diagram_, edge.source, target);
      out_ += fmt::format("  {} -> {} [arrowhead=normal{}{}]\n", from, head(target), border,
                          from_inside ? std::string() : at_head(target));
    }
  }

  const Diagram& diagram_;
  std::string out_;
};

}  // namespace

std::string to_dot(const Diagram& diagram) { return DotWriter(diagram).write(); }

}  // namespace footfall::behaviors
