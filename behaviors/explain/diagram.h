// The statechart of a behavior as a picture: what each state and transition is labelled with, in
// the words of the file. Load time only.
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
  std::vector<int> children;  // in document order
  std::vector<int> initial;   // default entry; of a history state: its `default`, if it has one
  bool safe = false;          // the root's `safe` state
  bool region = false;        // child of a parallel state
  int closed = 0;             // states that are inside but not drawn
  std::string origin;         // template that it was made from: `stride(stance: right_foot)`
  std::vector<std::string> notes;    // of who draws it, below the name: time spent, say
  std::string fill;                  // colour of an atomic state, `#rrggbb`; empty: as the others
  std::vector<std::string> control;  // `stack dual`, `releases left_foot over 24 ms`, ...
  std::vector<std::string> actions;  // `entry / mark step`, `tapped [t > 1 s] / raise go`, ...
};

struct DiagramEdge {
  int source = 0;
  std::vector<int> targets;        // at least one
  std::vector<std::string> label;  // `start`, `[contact.left_foot]`, `after 24 ms`, `/ raise go`
};

// states[0] is the root; a parent comes before its children.
struct Diagram {
  std::string name;
  std::vector<DiagramState> states;
  std::vector<DiagramEdge> edges;
};

// Loads a behavior as load_behavior() does; nothing if there were errors.
std::optional<Diagram> load_diagram(const std::string& path, const LoadOptions& options,
                                    core::Diagnostics& diagnostics);
std::optional<Diagram> load_diagram_text(std::string_view text, const std::string& name,
                                         const LoadOptions& options,
                                         core::Diagnostics& diagnostics);

// The same with only the named states open (by any suffix of their paths; `machine` is the root),
// and what they are in; every other state is drawn closed, its transitions at its border. Nothing
// and the reason in `why` if a name is not that of one state.
std::optional<Diagram> close_states(const Diagram& diagram, const std::vector<std::string>& open,
                                    std::string& why);

// As a Graphviz graph: nested states are clusters, regions of parallel ones have dashed borders.
std::string to_dot(const Diagram& diagram);
// As a Mermaid `stateDiagram-v2`: composite states, `--` between regions.
std::string to_mermaid(const Diagram& diagram);

}  // namespace footfall::behaviors
