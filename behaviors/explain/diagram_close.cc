// Draws states closed, as one box each; see diagram.h.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/explain/diagram.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

bool has_suffix(const std::string& path, const std::string& name) {
  return path == name || path.ends_with("." + name);
}

// The state of that name, the shallowest if there are several; -1 and a reason otherwise.
int find_state(const Diagram& diagram, const std::string& name, std::string& why) {
  const auto dots = [](const std::string& path) { return std::ranges::count(path, '.'); };
  int best = -1, other = -1;
  std::vector<std::string> names;
  for (int s = 0; s < static_cast<int>(diagram.states.size()); ++s) {
    const DiagramState& state = diagram.states[static_cast<std::size_t>(s)];
    names.push_back(state.name);
    if (!has_suffix(state.path, name)) continue;
    const auto depth = dots(state.path);
    const auto least =
        best < 0 ? depth + 1 : dots(diagram.states[static_cast<std::size_t>(best)].path);
    if (depth > least) continue;
    other = depth == least ? best : -1;
    best = s;
  }
  if (best < 0) {
    why = fmt::format("unknown state '{}'{}", name, core::did_you_mean(name, names));
  } else if (other >= 0) {
    why = fmt::format("state '{}' is ambiguous: '{}' or '{}'", name,
                      diagram.states[static_cast<std::size_t>(other)].path,
                      diagram.states[static_cast<std::size_t>(best)].path);
    return -1;
  }
  return best;
}

// By state: whether its content is drawn.
std::optional<std::vector<bool>> open_states(const Diagram& diagram,
                                             const std::vector<std::string>& names,
                                             std::string& why) {
  std::vector<bool> open(diagram.states.size(), false);
  open[0] = true;
  for (const std::string& name : names) {
    const int found = find_state(diagram, name, why);
    if (found < 0) return std::nullopt;
    for (int s = found; s >= 0; s = diagram.states[static_cast<std::size_t>(s)].parent) {
      open[static_cast<std::size_t>(s)] = true;
    }
  }
  return open;
}

// Indices of drawn states; a state that is not drawn maps to the closed state that contains it.
struct Kept {
  std::vector<int> index;  // by old index
  std::vector<bool> drawn;
};

Kept keep(const Diagram& diagram, const std::vector<bool>& open, Diagram& out) {
  Kept kept{std::vector<int>(diagram.states.size(), 0), std::vector<bool>(diagram.states.size())};
  for (std::size_t s = 0; s < diagram.states.size(); ++s) {
    const int parent = diagram.states[s].parent;
    const auto p = static_cast<std::size_t>(std::max(parent, 0));
    kept.drawn[s] = parent < 0 || (kept.drawn[p] && open[p]);
    if (!kept.drawn[s]) {
      kept.index[s] = kept.index[p];
      ++out.states[static_cast<std::size_t>(kept.index[s])].closed;
      continue;
    }
    kept.index[s] = static_cast<int>(out.states.size());
    DiagramState state = diagram.states[s];
    state.children.clear();
    if (parent >= 0) {
      state.parent = kept.index[p];
      out.states[static_cast<std::size_t>(state.parent)].children.push_back(kept.index[s]);
    }
    out.states.push_back(std::move(state));
  }
  return kept;
}

void move_targets(std::vector<int>& targets, const Kept& kept) {
  std::vector<int> moved;
  for (const int target : targets) {
    const int there = kept.index[static_cast<std::size_t>(target)];
    if (std::ranges::find(moved, there) == moved.end()) moved.push_back(there);
  }
  targets = std::move(moved);
}

}  // namespace

std::optional<Diagram> close_states(const Diagram& diagram, const std::vector<std::string>& open,
                                    std::string& why) {
  const auto opened = open_states(diagram, open, why);
  if (!opened) return std::nullopt;
  Diagram out;
  out.name = diagram.name;
  const Kept kept = keep(diagram, *opened, out);
  for (DiagramState& state : out.states) {
    if (state.closed > 0) {
      state.initial.clear();
    } else {
      move_targets(state.initial, kept);
    }
  }
  for (const DiagramEdge& edge : diagram.edges) {
    DiagramEdge moved = edge;
    moved.source = kept.index[static_cast<std::size_t>(edge.source)];
    move_targets(moved.targets, kept);
    // Transitions inside a closed state are not drawn.
    const bool inside =
        !kept.drawn[static_cast<std::size_t>(edge.source)] &&
        std::ranges::all_of(moved.targets, [&](int t) { return t == moved.source; });
    const bool into_itself = out.states[static_cast<std::size_t>(moved.source)].closed > 0 &&
                             std::ranges::any_of(edge.targets, [&](int t) {
                               return !kept.drawn[static_cast<std::size_t>(t)] &&
                                      kept.index[static_cast<std::size_t>(t)] == moved.source;
                             });
    if (!inside && !into_itself) out.edges.push_back(std::move(moved));
  }
  return out;
}

}  // namespace footfall::behaviors
