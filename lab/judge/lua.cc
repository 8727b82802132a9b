// Calls of Lua from a scenario; see lua.h.
#include "lab/judge/lua.h"

#include <algorithm>
#include <filesystem>

#include "core/index.h"

namespace footfall::lab {
namespace {

behaviors::ScriptSettings settings_with(std::uint64_t seed) {
  behaviors::ScriptSettings settings;
  settings.seed = seed;
  return settings;
}

}  // namespace

ScenarioLua::ScenarioLua(const ScenarioDescription& scenario, engine::ControlLoop& loop,
                         std::uint64_t seed)
    : loop_(loop),
      script_(std::make_shared<behaviors::Script>(settings_with(seed))),
      active_(loop.behavior().states.size()) {
  for (const behaviors::ScriptFile& file : scenario.scripts) {
    behaviors::ScriptError ignored;  // the loader has told
    behaviors::load_watched(script_, file.text, ignored,
                            std::filesystem::path(file.path).filename().string());
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
  result.failed = !behaviors::call_watched(script_, function, view, answer);
  result.messages = std::move(answer.messages);
  result.batch.source = engine::EditSource::set;
  for (const behaviors::SlotValue& edit : answer.edits) {  // of one slot the last counts
    std::erase_if(result.batch.values, [&](const auto& v) { return v.slot == edit.slot; });
    result.batch.values.push_back(edit);
  }
  result.batch.events = std::move(answer.events);
  return result;
}

}  // namespace footfall::lab
