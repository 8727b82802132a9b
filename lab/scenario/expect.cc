// `expect` of a scenario: conditions on runs, compiled against the behavior's signals.
#include <fmt/format.h>

#include "behaviors/expression/statistics.h"
#include "core/units/units.h"
#include "lab/scenario/context.h"
#include "lab/scenario/keys.h"

namespace footfall::lab {
namespace {

using core::YamlNode;

// The signal that holds a statistic, added on first use.
int statistic_signal(ScenarioDescription& scenario, const behaviors::Statistic& statistic,
                     bool magnitude, int signal) {
  const core::SignalInfo of = scenario.signals.info(signal);
  const std::string name = fmt::format("{}{} {}", statistic.name, magnitude ? " abs" : "", of.name);
  const int value =
      scenario.signals.add(name, statistic.counts ? core::kNone : of.dimension, "of a run");
  for (const SignalStatistic& known : scenario.statistics) {
    if (known.value == value) return value;
  }
  scenario.statistics.push_back({&statistic, magnitude, signal, value});
  return value;
}

// Compiles a condition. `statistics`: receives the statistics that it uses; nullptr: none are
// allowed, because it is evaluated in a single tick.
using UsedStatistics = std::vector<const behaviors::Statistic*>;
int compile_condition(ScenarioContext& context, const YamlNode& node, UsedStatistics* statistics) {
  if (!node.is_scalar() || node.scalar.empty()) {
    core::report_expected(node, "a condition", context.diagnostics);
    return -1;
  }
  if (context.names == nullptr) return -1;
  ScenarioDescription& scenario = context.scenario;
  behaviors::ExpressionScope scope;
  scope.signals = &scenario.signals;
  scope.parameters = &scenario.behavior->parameters;
  scope.find_state = [&context](std::string_view name, std::string& why) {
    return context.names->find_target(0, name, why);
  };
  if (statistics != nullptr) {
    scope.find_statistic = [&](const behaviors::Statistic& statistic, bool magnitude, int signal) {
      statistics->push_back(&statistic);
      return statistic_signal(scenario, statistic, magnitude, signal);
    };
  }
  const std::size_t skip = core::is_expression(node) ? 1 : 0;
  behaviors::ExpressionError problem;
  const int index = behaviors::compile_expression(std::string_view(node.scalar).substr(skip), scope,
                                                  core::kNone, scenario.expressions, problem);
  if (index < 0) {
    core::Mark mark = node.mark;
    mark.column += problem.offset + static_cast<int>(skip) + (node.quoted ? 1 : 0);
    context.error(mark, problem.id, problem.text);
  }
  return index;
}

// `95 % of seeds`
void read_part(ScenarioContext& context, const YamlNode& node, Expectation& expectation) {
  constexpr std::string_view kOfSeeds = " of seeds";
  const std::string& text = node.scalar;
  const auto part =
      node.is_scalar() && text.ends_with(kOfSeeds)
          ? core::parse_quantity(std::string_view(text).substr(0, text.size() - kOfSeeds.size()))
          : std::nullopt;
  if (!part || !(part->dimension == core::kNone)) {
    core::report_expected(node, "a part such as '95 % of seeds'", context.diagnostics);
  } else if (!(part->value > 0.0) || part->value > 1.0) {
    context.error(node.mark, "out-of-range",
                  fmt::format("expected more than 0 % and at most 100 % of seeds, got '{}'", text));
  } else {
    expectation.part = part->value;
  }
}

void read_times(ScenarioContext& context, const YamlNode& node, Expectation& expectation) {
  const YamlNode* between = node.find("between");
  expectation.timed = node.find("after") != nullptr || between != nullptr;
  if (const YamlNode* after = node.find("after")) {
    expectation.from = read_time_in_run(context, *after).value_or(0.0);
    if (between != nullptr) expect_one_of(context, node, {"after", "between"});
  }
  if (between != nullptr) {
    const auto range = core::read_range(*between, core::kTime, context.diagnostics, "a time");
    if (range) {
      read_time_in_run(context, between->items[0]);
      read_time_in_run(context, between->items[1]);
      expectation.from = (*range)[0];
      expectation.to = (*range)[1];
    }
  }
  if (const YamlNode* within = node.find("within")) {
    expectation.within = read_duration(context, *within);
    if (expectation.kind == Expectation::Kind::never ||
        expectation.kind == Expectation::Kind::end) {
      context.error(within->mark, "misplaced-key",
                    "'within' has a meaning only beside 'that' or 'sequence'");
    }
  }
  if (const YamlNode* in = node.find("in")) read_part(context, *in, expectation);
}

void read_sequence(ScenarioContext& context, const YamlNode& node, Expectation& expectation) {
  expectation.kind = Expectation::Kind::sequence;
  if (!core::expect_sequence(node, "a list of states", context.diagnostics)) return;
  if (node.items.size() < 2) {
    context.error(node.mark, "empty-value", "a sequence is of two states or more");
  }
  for (const YamlNode& item : node.items) {
    if (!core::expect_scalar(item, "the name of a state", context.diagnostics)) continue;
    expectation.text += (expectation.text.empty() ? "sequence: " : ", ") + item.scalar;
    if (context.names != nullptr) {
      expectation.states.push_back(context.names->require_target(0, item));
    }
  }
}

// One allowed end of the run, or several.
void read_end(ScenarioContext& context, const YamlNode& node, Expectation& expectation) {
  expectation.kind = Expectation::Kind::end;
  const auto take = [&](const YamlNode& item) {
    const auto word = core::read_choice(item, kScenarioEnds, context.diagnostics, "an end");
    if (!word) return;
    expectation.ends.push_back(*word);
    expectation.text += (expectation.text.empty() ? "end: " : ", ") + item.scalar;
  };
  if (!node.is_sequence()) {
    take(node);
    return;
  }
  if (node.items.empty()) context.error(node.mark, "empty-value", "no run ends so");
  for (const YamlNode& item : node.items) take(item);
}

// Requires that a statistic that keeps its samples has at most kMostKeptSamples of them.
void require_room(ScenarioContext& context, const YamlNode& node, const Expectation& expectation,
                  const UsedStatistics& statistics) {
  if (context.scenario.behavior == nullptr || !context.scenario.behavior->has_robot) return;
  const double end = expectation.to.value_or(context.scenario.duration);
  const double ticks = (end - expectation.from) / context.scenario.behavior->robot.period_s();
  for (const behaviors::Statistic* statistic : statistics) {
    if (!statistic->keeps_samples || ticks <= static_cast<double>(behaviors::kMostKeptSamples))
      continue;
    context.error(
        node.mark, "out-of-range",
        fmt::format("{}() is of at most {} ticks, these are {:.0f}: give it a shorter time "
                    "with 'between'",
                    statistic->name, behaviors::kMostKeptSamples, ticks));
  }
}

void read_expectation(ScenarioContext& context, const YamlNode& node) {
  Expectation expectation;
  UsedStatistics statistics;
  expectation.mark = node.mark;
  if (!node.is_map()) {
    expectation.text = node.scalar;
    expectation.expression = compile_condition(context, node, &statistics);
    require_room(context, node, expectation, statistics);
    warn_no_value(context, expectation, node.mark);
    context.scenario.expectations.push_back(std::move(expectation));
    return;
  }
  core::check_keys(node, kExpectationKeys, context.diagnostics);
  expect_one_of(context, node, {"that", "never", "sequence", "end"});
  if (const YamlNode* that = node.find("that")) {
    expectation.text = that->scalar;
    expectation.expression = compile_condition(context, *that, &statistics);
  }
  if (const YamlNode* never = node.find("never")) {
    expectation.kind = Expectation::Kind::never;
    expectation.text = never->scalar;
    expectation.expression = compile_condition(context, *never, nullptr);
  }
  if (const YamlNode* sequence = node.find("sequence")) {
    read_sequence(context, *sequence, expectation);
  }
  if (const YamlNode* end = node.find("end")) {
    read_end(context, *end, expectation);
    for (const char* key : {"after", "between"}) {
      const YamlNode* time = node.find(key);
      if (time == nullptr) continue;
      context.error(time->mark, "misplaced-key",
                    fmt::format("'{}' has no meaning beside 'end'", key));
    }
  }
  read_times(context, node, expectation);
  if (const YamlNode* that = node.find("that")) warn_no_value(context, expectation, that->mark);
  require_room(context, node, expectation, statistics);
  context.scenario.expectations.push_back(std::move(expectation));
}

}  // namespace

void load_expectations(ScenarioContext& context, const YamlNode& node) {
  if (!core::expect_sequence(node, "a list of conditions", context.diagnostics)) return;
  for (const YamlNode& item : node.items) read_expectation(context, item);
}

}  // namespace footfall::lab
