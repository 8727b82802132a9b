// Bounded lists of engines, and checks of messages; see known_engines.h.
#include "engine/lcm/known_engines.h"

#include <algorithm>

#include "core/text/printable.h"

namespace footfall::engine {
namespace {

constexpr std::size_t kMostEngines = 100;  // of each list

}  // namespace

using namespace footfall_lcm;

void KnownEngines::note(const catalogue_t& message, bool usable) {
  const bool room = engines_.size() < kMostEngines || engines_.contains(message.session);
  if (message.session == 0 || !room) return;
  engines_[message.session] = {message.session,
                               message.pid,
                               message.start,
                               core::on_one_line(message.host),
                               core::on_one_line(message.behavior),
                               core::on_one_line(message.robot),
                               usable};
  nameless_.erase(message.session);
}

void KnownEngines::note(std::int64_t session) {
  if (!engines_.contains(session) && nameless_.size() < kMostEngines) nameless_.insert(session);
}

std::vector<EngineIdentity> KnownEngines::list() const {
  std::vector<EngineIdentity> all;
  for (const auto& [session, engine] : engines_) all.push_back(engine);
  std::ranges::stable_sort(all, {}, &EngineIdentity::start);
  return all;
}

bool fits(const catalogue_t& catalogue) {
  return std::ranges::all_of(catalogue.parameters, [&](const parameter_t& p) {
    return p.first >= 0 && p.size >= 1 && p.first <= catalogue.value_count - p.size;
  });
}

bool fits(const values_t& values, const catalogue_t& catalogue) {
  return values.count == catalogue.value_count;
}

bool fits(const telemetry_t& telemetry, const catalogue_t& catalogue) {
  const auto below = [](std::int32_t index, std::int32_t count) {
    return index >= 0 && index < count;
  };
  return telemetry.foot_count == catalogue.foot_count &&
         telemetry.fault_count == catalogue.fault_count &&
         telemetry.signal_count == catalogue.signal_count &&
         std::ranges::all_of(telemetry.active,
                             [&](auto state) { return below(state, catalogue.state_count); }) &&
         std::ranges::all_of(telemetry.tasks, [&](const task_t& task) {
           return below(task.name, catalogue.task_count);
         });
}

}  // namespace footfall::engine
