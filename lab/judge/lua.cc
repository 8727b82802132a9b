// Calls of Lua from a scenario; see lua.h.
#include "lab/judge/lua.h"

#include <algorithm>

#include "core/index.h"

namespace footfall::lab {
namespace {

behaviors::ScriptSettings settings_with(std::uint64_t seed) {
  behaviors::ScriptSettings settings;
  settings.seed = seed;
  return settings;
}

// The parameter's value that the slot is. A later write of one call to the same slot wins.
void put(const behaviors::Behavior& behavior, const behaviors::ScriptEdit& edit,
         std::vector<engine::EditValue>& values) {
  const auto owner = std::ranges::find_if(behavior.parameters, [&](const auto& info) {
    return edit.slot >= info.slot && edit.slot < info.slot + info.size;
  });
  const auto parameter = static_cast<int>(owner - behavior.parameters.begin());
  const int component = edit.slot - owner->slot;
  std::erase_if(values, [&](const engine::EditValue& value) {
    return value.parameter == parameter && value.component == component;
  });
  values.push_back({parameter, component, {edit.value}});
}

}  // namespace

ScenarioLua::ScenarioLua(const ScenarioDescription& scenario, engine::ControlLoop& loop,
                         std::uint64_t seed)
    : loop_(loop), script_(settings_with(seed)), active_(loop.behavior().states.size()) {
  for (const behaviors::ScriptFile& file : scenario.scripts) {
    behaviors::ScriptError ignored;  // the loader has told
    script_.load(file.text, ignored);
  }
}

ScenarioLua::Result ScenarioLua::call(const std::string& function) {
  std::ranges::fill(active_, std::uint8_t{0});
  for (const int state : loop_.machine().active_states()) active_[at(state)] = 1;
  const behaviors::ScriptView view{&loop_.behavior(), loop_.signals().values(),
                                   loop_.machine().parameters().data(), active_.data(),
                                   loop_.time()};
  behaviors::ScriptAnswer answer;
  Result result;
  result.failed = !script_.call(function, view, answer);
  result.messages = std::move(answer.messages);
  result.batch.source = engine::EditSource::set;
  for (const behaviors::ScriptEdit& edit : answer.edits) {
    put(loop_.behavior(), edit, result.batch.values);
  }
  result.batch.events = std::move(answer.events);
  return result;
}

}  // namespace footfall::lab
