// Compares a replay with its log; see replay.h.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "behaviors/compiled/behavior.h"
#include "core/index.h"
#include "core/same_bits.h"
#include "engine/tick/control_loop.h"
#include "engine/tick/input_row.h"
#include "lab/replay/replay.h"

namespace footfall::lab {
namespace {

constexpr std::size_t kMostLines = 12;
constexpr std::int64_t kFollow = 3000;  // ticks to search for a difference visible in floats

std::vector<std::string> parameter_differences(const Log& log,
                                               const behaviors::Behavior& behavior) {
  std::vector<std::string> lines;
  for (const LoggedParameter& logged : log.parameters) {
    const int index = behavior.find_parameter(logged.name);
    if (index < 0) {
      lines.push_back(logged.name + ": only in the log");
      continue;
    }
    const behaviors::ParameterInfo& info = behavior.parameters[at(index)];
    if (info.size != logged.size) {
      lines.push_back(
          fmt::format("{}: {} values in the log, {} now", logged.name, logged.size, info.size));
      continue;
    }
    for (int k = 0; k < logged.size; ++k) {
      const double then = log.parameter_values[at(logged.slot + k)];
      const double now = behavior.values[at(info.slot + k)];
      if (core::same_bits(then, now)) continue;
      lines.push_back(
          fmt::format("{}: {} in the log, {} now", behaviors::value_name(info, k), then, now));
    }
  }
  for (const behaviors::ParameterInfo& info : behavior.parameters) {
    const auto named = [&](const LoggedParameter& p) { return p.name == info.name; };
    if (std::ranges::none_of(log.parameters, named)) lines.push_back(info.name + ": only now");
  }
  return lines;
}

class Verifier {
 public:
  Verifier(const Log& log, Replay& replay) : log_(log), replay_(replay) {
    const core::SignalTable& table = replay.behavior().signals;
    same_table_ = table.size() == static_cast<int>(log.signals.size());
    for (std::size_t s = 0; s < log.signals.size(); ++s) {
      signal_.push_back(table.find(log.signals[s].name));
      same_table_ &= signal_.back() == static_cast<int>(s);
    }
  }

  ReplayReport run() {
    report_.parameters = parameter_differences(log_, replay_.behavior());
    while (replay_.next() < replay_.end()) {
      replay_.tick([this] { compare(); });
      if (report_.differs_at >= 0 &&
          (!report_.lines.empty() || replay_.next() - report_.differs_at > kFollow)) {
        break;
      }
    }
    return std::move(report_);
  }

 private:
  void compare() {
    const std::int64_t tick = replay_.next();
    const engine::ControlLoop& loop = replay_.loop();
    std::vector<std::string> lines = commands(tick);
    for (std::string& line : replay_.plan_differences()) lines.push_back(std::move(line));
    rows(tick, lines);
    const bool digest =
        !same_table_ || log_.inputs.digest[at(tick - log_.inputs.first_tick)] ==
                            engine::digest(loop.signals().values(), loop.signals().size());
    if (report_.differs_at < 0) ++report_.ticks;
    if (lines.empty() && digest) return;
    if (report_.differs_at < 0) {
      --report_.ticks;
      report_.differs_at = tick;
      report_.time = loop.time();
      report_.state = replay_.state();
    }
    if (lines.empty()) return;
    report_.visible_at = tick;
    report_.lines = std::move(lines);
  }

  std::vector<std::string> commands(std::int64_t tick) const {
    std::vector<std::string> lines;
    const std::uint64_t* row = log_.inputs.row(tick);
    for (std::size_t j = 0; j < log_.inputs.names.joints.size(); ++j) {
      const auto then = std::bit_cast<double>(row[j]);
      const double now = replay_.loop().commands().tau[j];
      if (core::same_bits(then, now)) continue;
      lines.push_back(fmt::format("joint.{}.command: {} in the log, {} now",
                                  log_.inputs.names.joints[j], then, now));
    }
    return lines;
  }

  void rows(std::int64_t tick, std::vector<std::string>& lines) {
    while (row_ < log_.rows() && log_.tick[row_] < tick) ++row_;
    if (row_ >= log_.rows() || log_.tick[row_] != tick) return;
    for (std::size_t s = 0; s < signal_.size() && lines.size() < kMostLines; ++s) {
      const std::string& name = log_.signals[s].name;
      const bool told = name.starts_with("joint.") && name.ends_with(".command");  // as doubles
      if (signal_[s] < 0 || told) continue;
      const float then = log_.column[s][row_];
      const auto now = static_cast<float>(replay_.loop().signals()[signal_[s]]);
      if (std::bit_cast<std::uint32_t>(then) == std::bit_cast<std::uint32_t>(now)) continue;
      if (std::isnan(then) && std::isnan(now)) continue;
      lines.push_back(fmt::format("{}: {} in the log, {} now", name, then, now));
    }
  }

  const Log& log_;
  Replay& replay_;
  std::vector<int> signal_;  // index in the behavior's table by the log's signals; -1 if absent
  bool same_table_ = true;
  std::size_t row_ = 0;
  ReplayReport report_;
};

}  // namespace

ReplayReport verify_replay(const Log& log, Replay& replay) { return Verifier(log, replay).run(); }

}  // namespace footfall::lab
