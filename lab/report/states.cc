// State diagram with the time spent in each state; see states.h.
#include "lab/report/states.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string_view>

#include "behaviors/loader.h"
#include "core/diagnostics/diagnostics.h"
#include "lab/log/attached_files.h"
#include "lab/report/data.h"
#include "lab/run/log_setup.h"

namespace footfall::lab {
namespace {

bool is_or_is_in(std::string_view path, std::string_view state) {
  return path.starts_with(state) && (path.size() == state.size() || path[state.size()] == '.');
}

bool in_region(const behaviors::Diagram& diagram, int state) {
  for (int s = state; s > 0; s = diagram.states[static_cast<std::size_t>(s)].parent) {
    if (diagram.states[static_cast<std::size_t>(s)].region) return true;
  }
  return false;
}

// White to blue with the square root of the share, so that short states remain visible.
std::string tint(double share) {
  const auto blend = [&](double full) {
    return static_cast<int>(std::lround(255.0 + (full - 255.0) * std::sqrt(share)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", blend(110.0), blend(168.0), 255);
}

}  // namespace

StateUse state_use(const Log& log, const std::string& path) {
  StateUse use;
  const auto* state = log.values("state");
  if (state == nullptr) return use;
  std::vector<bool> inside;
  for (const std::string& name : state_paths(log)) inside.push_back(is_or_is_in(name, path));
  bool before = false;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const auto index = std::lround((*state)[row]);
    const bool now = index >= 0 && index < static_cast<std::ptrdiff_t>(inside.size()) &&
                     inside[static_cast<std::size_t>(index)];
    if (now && !before) ++use.visits;
    if (now && row + 1 < log.rows()) use.time += log.time[row + 1] - log.time[row];
    before = now;
  }
  return use;
}

void add_state_use(const Log& log, behaviors::Diagram& diagram) {
  if (log.rows() < 2 || log.values("state") == nullptr) return;
  const double total = log.time.back() - log.time.front();
  for (int s = 1; s < static_cast<int>(diagram.states.size()); ++s) {
    behaviors::DiagramState& state = diagram.states[static_cast<std::size_t>(s)];
    using Kind = behaviors::StateKind;
    if (state.kind == Kind::history_shallow || state.kind == Kind::history_deep) continue;
    const StateUse use = state_use(log, state.path);
    if (use.visits == 0) {
      // For parallel regions, the log's state is the first region's.
      if (!in_region(diagram, s)) state.notes.emplace_back("never");
      continue;
    }
    state.notes.push_back(fmt::format("{:.3g} s, {:.1f} %, {} {}", use.time,
                                      100.0 * use.time / total, use.visits,
                                      use.visits == 1 ? "visit" : "visits"));
    if (state.children.empty()) state.fill = tint(use.time / total);
  }
}

std::string state_graph(const Log& log) {
  const RunSetup setup = read_setup(log.setup);
  const LogFolder folder(log);
  core::Diagnostics diagnostics;
  behaviors::LoadOptions options;
  options.search = folder.search();
  options.robot = folder.place_of(setup.robot_file);
  options.set = setup.set;
  auto diagram =
      behaviors::load_diagram(folder.place_of(setup.behavior_file), options, diagnostics);
  if (!diagram) throw std::runtime_error(diagnostics.to_string());
  add_state_use(log, *diagram);
  return to_dot(*diagram);
}

}  // namespace footfall::lab
