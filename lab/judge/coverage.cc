// Merges what runs reached; see coverage.h.
#include "lab/judge/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace footfall::lab {
namespace {

using Json = nlohmann::ordered_json;

std::string place_of(core::Mark mark, const std::vector<std::string>& files) {
  const auto index = static_cast<std::size_t>(mark.file);
  if (mark.file < 0 || index >= files.size()) return "";
  const auto file = std::filesystem::path(files[index]).lexically_normal();
  return fmt::format("{}:{}", file.string(), mark.line);
}

// A count or a truth value.
bool is_true(const nlohmann::json& map, const char* key) {
  const auto found = map.find(key);
  if (found == map.end()) return false;
  return found->is_boolean() ? found->get<bool>() : found->is_number() && found->get<double>() > 0;
}

// `index` of an object, if it is below `size`; else `size`.
std::size_t index_of(const nlohmann::json& item, std::size_t size) {
  if (!item.is_object()) return size;
  const auto found = item.find("index");
  if (found == item.end() || !found->is_number_unsigned()) return size;
  return std::min(found->get<std::size_t>(), size);
}

// The list under a key, an empty one if there is none.
const nlohmann::json& list_of(const nlohmann::json& map, const char* key) {
  static const nlohmann::json kNone = nlohmann::json::array();
  const auto found = map.is_object() ? map.find(key) : map.end();
  return map.is_object() && found != map.end() && found->is_array() ? *found : kNone;
}

Json figure_json(CoverageFigure figure) {
  return {{"reached", figure.reached}, {"of", figure.of}, {"percent", figure.percent()}};
}

void sum(CoverageFigure& total, CoverageFigure part) {
  total.reached += part.reached;
  total.of += part.of;
}

}  // namespace

CoverageMap coverage_map(const behaviors::Chart& chart, const std::string& path,
                         const std::vector<std::string>& files) {
  CoverageMap map;
  map.behavior = path;
  for (const behaviors::StateInfo& state : chart.states) {
    const bool history = state.kind == behaviors::StateKind::history_shallow ||
                         state.kind == behaviors::StateKind::history_deep;
    map.states.push_back({state.path, place_of(state.mark, files), !history, false});
  }
  for (const behaviors::TransitionInfo& transition : chart.transitions) {
    std::string text = chart.states[static_cast<std::size_t>(transition.source)].path + " ->";
    for (int t = transition.targets.first; t < transition.targets.end(); ++t) {
      const int target = chart.targets[static_cast<std::size_t>(t)];
      text += " " + chart.states[static_cast<std::size_t>(target)].path;
    }
    if (transition.targets.count == 0) text += " (stays)";
    map.transitions.push_back(
        {text, place_of(transition.mark, files), true, transition.guard >= 0});
  }
  return map;
}

void Coverage::add(const std::shared_ptr<const CoverageMap>& map, const nlohmann::json& run) {
  if (map == nullptr || !run.is_object()) return;
  Reached& reached = behaviors_[map->behavior];
  if (reached.map == nullptr) {
    reached.map = map;
    reached.states.resize(map->states.size());
    for (auto* list : {&reached.transitions, &reached.when_true, &reached.when_false}) {
      list->resize(map->transitions.size());
    }
  }
  for (const auto& state : list_of(run, "states")) {
    if (!state.is_string()) continue;
    for (std::size_t s = 0; s < map->states.size(); ++s) {
      if (map->states[s].text == state.get_ref<const std::string&>()) reached.states[s] = 1;
    }
  }
  const std::size_t count = reached.transitions.size();
  for (const auto& item : list_of(run, "transitions")) {
    const std::size_t index = index_of(item, count);
    if (index < count && is_true(item, "taken")) reached.transitions[index] = 1;
  }
  for (const auto& item : list_of(run, "guards")) {
    const std::size_t index = index_of(item, count);
    if (index == count) continue;
    if (is_true(item, "true")) reached.when_true[index] = 1;
    if (is_true(item, "false")) reached.when_false[index] = 1;
  }
}

CoverageFigure Coverage::states_of(const Reached& reached) {
  CoverageFigure figure;
  for (std::size_t s = 0; s < reached.states.size(); ++s) {
    if (!reached.map->states[s].reachable) continue;
    sum(figure, {reached.states[s], 1});
  }
  return figure;
}

CoverageFigure Coverage::transitions_of(const Reached& reached) {
  CoverageFigure figure;
  for (const std::uint8_t taken : reached.transitions) sum(figure, {taken, 1});
  return figure;
}

CoverageFigure Coverage::guards_of(const Reached& reached) {
  CoverageFigure figure;
  for (std::size_t t = 0; t < reached.transitions.size(); ++t) {
    if (!reached.map->transitions[t].guarded) continue;
    sum(figure, {static_cast<std::size_t>(reached.when_true[t] + reached.when_false[t]), 2});
  }
  return figure;
}

std::vector<Coverage::Gap> Coverage::gaps(const Reached& reached) {
  std::vector<Gap> list;
  const CoverageMap& map = *reached.map;
  for (std::size_t s = 0; s < map.states.size(); ++s) {
    if (map.states[s].reachable && reached.states[s] == 0) {
      list.push_back({"state", map.states[s].place, map.states[s].text + " was never entered"});
    }
  }
  for (std::size_t t = 0; t < map.transitions.size(); ++t) {
    const CoverageMap::Item& item = map.transitions[t];
    if (reached.transitions[t] == 0) {
      list.push_back({"transition", item.place, item.text + " was never taken"});
    }
    if (!item.guarded) continue;
    for (const auto& [seen, outcome] :
         {std::pair(reached.when_true[t], "true"), std::pair(reached.when_false[t], "false")}) {
      if (seen != 0) continue;
      list.push_back({"guard", item.place,
                      fmt::format("the condition of {} was never {}", item.text, outcome)});
    }
  }
  return list;
}

CoverageFigure Coverage::states() const {
  CoverageFigure total;
  for (const auto& [file, reached] : behaviors_) sum(total, states_of(reached));
  return total;
}

CoverageFigure Coverage::transitions() const {
  CoverageFigure total;
  for (const auto& [file, reached] : behaviors_) sum(total, transitions_of(reached));
  return total;
}

CoverageFigure Coverage::guard_outcomes() const {
  CoverageFigure total;
  for (const auto& [file, reached] : behaviors_) sum(total, guards_of(reached));
  return total;
}

std::string Coverage::text() const {
  std::string out;
  for (const auto& [file, reached] : behaviors_) {
    out += fmt::format("{}: states {:.0f} %, transitions {:.0f} %, guard outcomes {:.0f} %\n", file,
                       states_of(reached).percent(), transitions_of(reached).percent(),
                       guards_of(reached).percent());
    for (const Gap& gap : gaps(reached)) {
      out += fmt::format("  {}: {} {}\n", gap.place, gap.kind, gap.text);
    }
  }
  return out;
}

Json Coverage::to_json() const {
  Json out = {{"states", figure_json(states())},
              {"transitions", figure_json(transitions())},
              {"guard_outcomes", figure_json(guard_outcomes())}};
  Json list = Json::array();
  for (const auto& [file, reached] : behaviors_) {
    Json missing = Json::array();
    for (const Gap& gap : gaps(reached)) {
      missing.push_back({{"kind", gap.kind}, {"place", gap.place}, {"text", gap.text}});
    }
    list.push_back({{"behavior", file},
                    {"states", figure_json(states_of(reached))},
                    {"transitions", figure_json(transitions_of(reached))},
                    {"guard_outcomes", figure_json(guards_of(reached))},
                    {"not_reached", std::move(missing)}});
  }
  out["behaviors"] = std::move(list);
  return out;
}

}  // namespace footfall::lab
