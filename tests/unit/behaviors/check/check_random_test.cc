// What the structural checks say of random charts is true when the charts run.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

// A random chart over events e0..e3, a parameter $p that the test changes and $v that actions set;
// every state and every transition on a line of its own, so that a warning's line tells which.
class RandomChart {
 public:
  explicit RandomChart(unsigned seed) : random_(seed) {}

  std::string text() {
    out_ =
        "behavior: 1\nevents: {e0: '', e1: '', e2: '', e3: ''}\nparameters:\n"
        "  p: {value: 0, range: [0, 9], live: true}\n  v: 0\nmachine:\n";
    if (one_in(3)) out_ += "  safe: s1\n";
    children(0, 2 + upto(3), false);
    for (std::size_t at = out_.find('@'); at != std::string::npos; at = out_.find('@', at)) {
      out_.replace(at, 1, fmt::format("s{}", 1 + upto(made_)));
    }
    return out_;
  }

 private:
  int upto(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  bool one_in(int n) { return upto(n) == 0; }
  std::string pick(const std::vector<std::string>& words) {
    return words[static_cast<std::size_t>(upto(static_cast<int>(words.size())))];
  }
  std::string line(int depth, const std::string& text) {
    return std::string(static_cast<std::size_t>(2 + 4 * depth), ' ') + text + "\n";
  }
  void children(int depth, int count, bool parallel) {
    out_ += line(depth, "states:");
    for (int k = 0; k < count + (parallel ? 1 : 0); ++k) state(depth, parallel);
  }

  void state(int depth, bool region) {
    const std::string pad(static_cast<std::size_t>(4 + 4 * depth), ' ');
    out_ += fmt::format("{}s{}:\n", pad, ++made_);
    if (!region && depth > 0 && one_in(8)) {
      out_ += line(depth + 1, one_in(2) ? "type: final" : "type: history");
      return;
    }
    transitions(depth + 1);
    if (depth < 3 && one_in(3)) {
      const bool parallel = one_in(3);
      if (parallel) out_ += line(depth + 1, "type: parallel");
      children(depth + 1, 1 + upto(3), parallel);
    }
  }

  void transitions(int depth) {
    if (one_in(4)) out_ += line(depth, "on_entry: [{set: {v: '= $v > 3 ? 0 : $v + 1'}}]");
    const int count = upto(4);
    if (count > 0) out_ += line(depth, "transitions:");
    for (int k = 0; k < count; ++k) {
      std::string keys;
      if (!one_in(3)) keys += "on: " + pick({"e0", "e1", "[e2, e3]", "'*'", "e2"}) + ", ";
      if (one_in(2)) {
        keys +=
            "when: " +
            pick({"$p > 4", "$p > 4", "$p < 2", "$v == 1", "1 > 2", "true", "t > 2 ms", "in(@)"}) +
            ", ";
      }
      if (keys.empty() || one_in(4)) keys += "after: " + pick({"0 s", "1 ms", "3 ms"}) + ", ";
      if (one_in(6)) {
        keys += "do: [{mark: m}]";
      } else {
        keys += std::string("to: @") + (one_in(4) ? ", internal: true" : "");
      }
      out_ += line(depth, "  - {" + keys + "}");
    }
  }

  std::mt19937 random_;
  std::string out_;
  int made_ = 0;
};

// The lines that the checks speak of, by what they say.
struct Said {
  std::set<int> never_entered, dead_ends, never_taken, loops;
};

Said what_is_said(const core::Diagnostics& diagnostics) {
  Said said;
  for (const core::Diagnostic& problem : diagnostics.all()) {
    if (problem.id == "unreachable") said.never_entered.insert(problem.mark.line);
    if (problem.id == "dead-end") said.dead_ends.insert(problem.mark.line);
    if (problem.id == "shadowed" || problem.id == "never-true") {
      said.never_taken.insert(problem.mark.line);
    }
    const bool certain = problem.text.find("while") == std::string::npos &&
                         problem.text.find("unless") == std::string::npos &&
                         problem.text.find("again") == std::string::npos &&
                         problem.text.find("raise the events") == std::string::npos;
    if (problem.id == "possible-loop" && certain) said.loops.insert(problem.mark.line);
  }
  return said;
}

class Watch {
 public:
  Watch(const behaviors::Behavior& behavior, const Said& said)
      : behavior_(behavior),
        said_(said),
        values_(behavior.values),
        chart_(behavior, nullptr, values_) {}

  void run(unsigned seed) {
    std::mt19937 random(seed);
    chart_.start(0);
    look(false);
    for (int tick = 0; tick < 60 && !chart_.finished(); ++tick) {
      values_[0] = static_cast<double>(random() % 10);
      chart_.begin_tick(tick);
      for (auto n = random() % 3; n > 0; --n) {
        chart_.raise(behavior_.find_event("e" + std::to_string(random() % 4)));
      }
      const auto faults = chart_.faults().of(core::Fault::execution);
      chart_.run();
      look(chart_.faults().of(core::Fault::execution) == faults);
    }
  }

 private:
  // `settled`: the tick ended by itself.
  void look(bool settled) {
    for (const int t : chart_.transitions_taken()) {
      const auto& transition = behavior_.transitions[static_cast<std::size_t>(t)];
      EXPECT_FALSE(said_.never_taken.contains(transition.mark.line)) << transition.mark.line;
    }
    for (const int s : chart_.active_states()) {
      const auto& state = behavior_.states[static_cast<std::size_t>(s)];
      EXPECT_FALSE(said_.never_entered.contains(state.mark.line)) << state.path;
      if (said_.dead_ends.contains(state.mark.line)) ended_.insert(s);
      for (int t = state.transitions.first; t < state.transitions.end() && settled; ++t) {
        const int line = behavior_.transitions[static_cast<std::size_t>(t)].mark.line;
        // One of the cycle's states: never where a tick ends by itself.
        EXPECT_FALSE(said_.loops.contains(line) && state.end == s + 1) << line;
      }
    }
    for (const int s : ended_) EXPECT_TRUE(chart_.is_active(s)) << s;
  }

  const behaviors::Behavior& behavior_;
  const Said& said_;
  std::vector<double> values_;
  behaviors::Statechart chart_;
  std::set<int> ended_;  // dead ends that were entered
};

TEST(CheckRandom, WhatIsSaidOfRandomChartsIsTrueWhenTheyRun) {
  int loaded = 0, never_entered = 0, never_taken = 0, dead_ends = 0, loops = 0;
  for (unsigned seed = 1; seed <= 600; ++seed) {
    const std::string text = RandomChart(seed).text();
    core::Diagnostics diagnostics;
    const auto behavior =
        behaviors::load_behavior_text(text, "b.yaml", options_for_tests(), diagnostics);
    if (behavior == nullptr) continue;  // history states alone, say
    ++loaded;
    behavior->micro_steps = 64;
    const Said said = what_is_said(diagnostics);
    never_entered += static_cast<int>(said.never_entered.size());
    never_taken += static_cast<int>(said.never_taken.size());
    dead_ends += static_cast<int>(said.dead_ends.size());
    loops += static_cast<int>(said.loops.size());
    for (unsigned run = 0; run < 4; ++run) Watch(*behavior, said).run(1000 * seed + run);
    if (HasFailure()) FAIL() << text << diagnostics.to_string();
  }
  // The charts are such that the property is put to the test.
  EXPECT_GT(loaded, 300);
  EXPECT_GT(never_entered, 50);
  EXPECT_GT(never_taken, 50);
  EXPECT_GT(dead_ends, 20);
  EXPECT_GT(loops, 10);
}

}  // namespace
}  // namespace footfall::tests
