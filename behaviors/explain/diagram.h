// The statechart of a behavior as a diagram: labels of states and transitions, in the wording of
// the file. Load time only.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/compiled/chart.h"
#include "behaviors/loader.h"

namespace footfall::behaviors {

struct LoadContext;

struct DiagramState {
  std::string name;
  std::string path;
  StateKind kind = StateKind::atomic;
  int parent = -1;
  std::vector<int> children;         // in document order
  std::vector<int> initial;          // default entry; of a history state: its `default`, if any
  bool safe = false;                 // the root's `safe` state
  bool region = false;               // child of a parallel state
  int closed = 0;                    // number of states inside that are not drawn
  std::string origin;                // its template: `stride(stance: right_foot)`
  std::vector<std::string> notes;    // added by the caller below the name, e.g. time spent
  std::string fill;                  // fill colour of an atomic state, `#rrggbb`; empty: default
  std::vector<std::string> control;  // `stack dual`, `releases left_foot over 24 ms`, ...
  std::vector<std::string> actions;  // `entry / mark step`, `tapped [t > 1 s] / raise go`, ...
};

struct DiagramEdge {
  int source = 0;
  std::vector<int> targets;        // at least one
  std::vector<std::string> label;  // `start`, `[contact.left_foot]`, `after 24 ms`, `/ raise go`
};

// states[0] is the root; parents precede their children.
struct Diagram {
  std::string name;
  std::vector<DiagramState> states;
  std::vector<DiagramEdge> edges;
};

// Loads a behavior like load_behavior(); nullopt after errors.
std::optional<Diagram> load_diagram(const std::string& path, const LoadOptions& options,
                                    core::Diagnostics& diagnostics);
std::optional<Diagram> load_diagram_text(std::string_view text, const std::string& name,
                                         const LoadOptions& options,
                                         core::Diagnostics& diagnostics);

// A copy in which only the named states (by any suffix of their paths; `machine` is the root) and
// their ancestors are open; other states are drawn closed, with their transitions at the border.
// nullopt and the reason in `why` if a name does not match exactly one state.
std::optional<Diagram> close_states(const Diagram& diagram, const std::vector<std::string>& open,
                                    std::string& why);

// As a Graphviz graph: nested states are clusters, regions of parallel states have dashed borders.
std::string to_dot(const Diagram& diagram);
// As a Mermaid `stateDiagram-v2`: composite states, `--` between regions.
std::string to_mermaid(const Diagram& diagram);

}  // namespace footfall::behaviors
