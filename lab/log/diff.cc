// Compares two logs; see diff.h.
#include "lab/log/diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

#include "core/index.h"
#include "core/same_bits.h"
#include "engine/tick/input_row.h"

namespace footfall::lab {
namespace {

class Comparison {
 public:
  Comparison(const Log& a, const Log& b) : a_(a), b_(b) {}

  LogComparison run() {
    settings();
    files();
    parameters();
    inputs();
    signals();
    events();
    edits();
    plans();
    // Within a tick causes precede effects: measurements, external inputs, then results.
    const auto when = [](const LogDifference& d) {
      constexpr std::string_view kCauses[] = {"input", "edit", "plan"};
      const auto* cause = std::ranges::find(kCauses, std::string_view(d.kind));
      return std::pair(d.tick, cause - std::begin(kCauses));
    };
    std::ranges::stable_sort(out_.differences, {}, when);
    return std::move(out_);
  }

 private:
  void add(const std::string& kind, std::int64_t tick, std::string text) {
    const auto ns = std::max<std::int64_t>(0, tick) * 1'000'000'000'000LL / a_.rate_mhz;
    out_.differences.push_back({kind, tick, static_cast<double>(ns) * 1e-9, std::move(text)});
  }

  void settings() {
    std::set<std::string> keys;
    for (const auto* log : {&a_, &b_}) {
      for (const auto& entry : log->run) keys.insert(entry.first);
    }
    for (const std::string& key : keys) {
      if (a_.get(key) == b_.get(key)) continue;
      const bool shown = key != "states" && key != "tasks";  // too long to print
      out_.setup.push_back(shown
                               ? fmt::format("{}: '{}' against '{}'", key, a_.get(key), b_.get(key))
                               : key + ": not the same");
    }
    if (a_.setup != b_.setup) out_.setup.emplace_back("settings of the control loop: not the same");
  }

  static const LoggedFile* find(const Log& log, const std::string& path) {
    const auto found = std::ranges::find(log.files, path, &LoggedFile::path);
    return found == log.files.end() ? nullptr : &*found;
  }

  void files() {
    for (const LoggedFile& file : a_.files) {
      const LoggedFile* other = find(b_, file.path);
      if (other == nullptr) out_.setup.push_back(file.path + ": only in the first");
      if (other != nullptr && other->content != file.content) {
        out_.setup.push_back(fmt::format("{}: from line {} on", file.path,
                                         first_line(file.content, other->content)));
      }
    }
    for (const LoggedFile& file : b_.files) {
      if (find(a_, file.path) == nullptr) out_.setup.push_back(file.path + ": only in the second");
    }
  }

  static std::int64_t first_line(const std::string& a, const std::string& b) {
    const auto place = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first;
    return 1 + std::count(a.begin(), place, '\n');
  }

  void parameters() {
    for (const LoggedParameter& p : a_.parameters) {
      const auto other = std::ranges::find(b_.parameters, p.name, &LoggedParameter::name);
      if (other == b_.parameters.end() || other->size != p.size) {
        out_.setup.push_back(p.name + ": not in both");
        continue;
      }
      for (int k = 0; k < p.size; ++k) {
        const double x = a_.parameter_values[at(p.slot + k)];
        const double y = b_.parameter_values[at(other->slot + k)];
        if (core::same_bits(x, y)) continue;
        const std::string name = p.size == 1 ? p.name : fmt::format("{}[{}]", p.name, k);
        out_.setup.push_back(fmt::format("{}: {} against {}", name, x, y));
      }
    }
  }

  // Compares commands and measurements, then the lengths of the runs.
  void inputs() {
    const LoggedInputs& x = a_.inputs;
    const LoggedInputs& y = b_.inputs;
    const std::int64_t begin = std::max(x.first_tick, y.first_tick);
    const std::int64_t end = std::min(x.first_tick + x.ticks(), y.first_tick + y.ticks());
    out_.ticks = std::max<std::int64_t>(0, end - std::max<std::int64_t>(begin, 0));
    if (x.columns != y.columns) {
      out_.setup.emplace_back("joints or contacts: not the same, so inputs are not compared");
      return;
    }
    const auto commands =
        at(std::ranges::find(x.columns, engine::InputLayout::kTimeColumn) - x.columns.begin());
    bool input = false, command = false;
    for (std::int64_t tick = begin; tick < end && !(input && command); ++tick) {
      if (!command) command = row("command", tick, 0, commands);
      if (!input) input = row("input", tick, commands, x.columns.size());
    }
    if (x.first_tick + x.ticks() != y.first_tick + y.ticks()) {
      add("length", end,
          fmt::format("{} ticks against {}", x.first_tick + x.ticks(), y.first_tick + y.ticks()));
    }
  }

  bool row(const char* kind, std::int64_t tick, std::size_t from, std::size_t to) {
    std::string text;
    for (std::size_t c = from; c < to; ++c) {
      const std::uint64_t x = a_.inputs.row(tick)[c], y = b_.inputs.row(tick)[c];
      if (x == y) continue;
      const std::string& name = a_.inputs.columns[c];
      const bool whole = engine::InputLayout::is_integer(name);
      text += fmt::format("{}{}: ", text.empty() ? "" : "; ", name);
      text +=
          whole ? fmt::format("{} against {}", x, y)
                : fmt::format("{} against {}", std::bit_cast<double>(x), std::bit_cast<double>(y));
      if (text.size() > 200) break;
    }
    if (!text.empty()) add(kind, tick, text);
    return !text.empty();
  }

  void signals() {
    std::vector<std::pair<std::size_t, std::size_t>> both;
    for (std::size_t s = 0; s < a_.signals.size(); ++s) {
      const int other = b_.find(a_.signals[s].name);
      if (other >= 0) both.emplace_back(s, at(other));
    }
    for (std::size_t i = 0, j = 0; i < a_.rows() && j < b_.rows();) {
      if (a_.tick[i] != b_.tick[j]) {
        ++(a_.tick[i] < b_.tick[j] ? i : j);
        continue;
      }
      std::string text;
      for (const auto& [s, t] : both) {
        const float x = a_.column[s][i], y = b_.column[t][j];
        if (std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y)) continue;
        text +=
            fmt::format("{}{}: {} against {}", text.empty() ? "" : "; ", a_.signals[s].name, x, y);
        if (text.size() > 200) break;
      }
      if (!text.empty()) return add("signal", a_.tick[i], text);
      ++i;
      ++j;
    }
  }

  template <typename Item, typename Text>
  void list(const char* kind, const std::vector<Item>& x, const std::vector<Item>& y, Text&& text) {
    for (std::size_t k = 0; k < std::max(x.size(), y.size()); ++k) {
      const std::string one = k < x.size() ? text(x[k]) : "none";
      const std::string two = k < y.size() ? text(y[k]) : "none";
      if (one == two && (k >= x.size() || k >= y.size() || x[k].tick == y[k].tick)) continue;
      const std::int64_t tick =
          std::min(k < x.size() ? x[k].tick : y[k].tick, k < y.size() ? y[k].tick : x[k].tick);
      return add(kind, tick, fmt::format("{} against {}", one, two));
    }
  }

  void events() {
    list("event", a_.events, b_.events, [](const LoggedEvent& e) {
      return fmt::format("{} {} {} at tick {}", e.kind, e.name, e.detail, e.tick);
    });
  }

  void edits() {
    list("edit", a_.edits, b_.edits, [](const LoggedEdit& e) {
      std::string text = fmt::format("tick {}", e.tick);
      for (const auto& [slot, value] : e.writes) text += fmt::format(", slot {} = {}", slot, value);
      for (const int event : e.events) text += fmt::format(", event {}", event);
      if (e.limit_steps) text += ", torque steps limited";
      if (e.late) text += ", late";
      if (e.requests_lost) text += ", requests of scripts lost";
      if (e.scripts_stuck) text += ", a script is stuck";
      return text;
    });
  }

  void plans() {
    list("plan", a_.plans, b_.plans, [](const LoggedPlan& p) {
      return fmt::format("planner {} request {} {} ({}, {}, {})", p.planner, p.sequence,
                         p.ok ? "ok" : "failed", p.target[0], p.target[1], p.target[2]);
    });
  }

  const Log& a_;
  const Log& b_;
  LogComparison out_;
};

}  // namespace

LogComparison compare_logs(const Log& a, const Log& b) { return Comparison(a, b).run(); }

}  // namespace footfall::lab
