// What an expression costs in the tick, against muParser on the same expression in the same
// process: rounds of both in turn, the median round of each counts. Every call sees other values.
// Needs about 15 s.
#include <muParser.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "behaviors/expression/expression.h"

namespace footfall::tests {
namespace {

using behaviors::EvaluationContext;

constexpr int kRounds = 41;
constexpr int kCalls = 20000;  // of a round
constexpr int kRows = 64;      // of values, gone through in turn
constexpr int kSignals = 7;
constexpr int kParameters = 3;

struct Pair {
  const char* group;
  const char* ours;
  const char* muparser;
};

// The same in both notations. muParser's names: a dotted name without its dot, a parameter without
// its `$`. `in(walk)` is a variable there, and so is `t`.
constexpr Pair kPairs[] = {
    {"single", "0.91", "0.91"},
    {"single", "fz", "fz"},
    {"single", "$height", "height"},
    {"single", "t", "t"},
    {"guard", "fz > 100", "fz>100"},
    {"guard", "t > 0.2", "t>0.2"},
    {"guard", "fz > 100 and t > 0.2", "fz>100 && t>0.2"},
    {"guard", "contact.left and t > 0.1", "contactleft && t>0.1"},
    {"guard", "contact.left or contact.right", "contactleft || contactright"},
    {"guard", "not contact.left", "contactleft==0"},
    {"guard", "in(walk) and com.z < $height", "inwalk && comz<height"},
    {"guard", "abs(com.z - $height) < 0.02 and (contact.left or contact.right)",
     "abs(comz-height)<0.02 && (contactleft || contactright)"},
    {"guard", "fz > 100 and t > 0.2 or com.z < 0.6 or not contact.left and t > 0.4",
     "fz>100 && t>0.2 || comz<0.6 || contactleft==0 && t>0.4"},
    {"set-point", "q0 + 0.3*sin(6.28 1/s*t) - (fz > 100 ? 0.05 : 0)",
     "q0+0.3*sin(6.28*t)-(fz>100 ? 0.05 : 0)"},
    {"set-point", "$height + 0.02*cos(12.5 1/s*t)", "height+0.02*cos(12.5*t)"},
    {"set-point", "contact.left ? $height : $height - 0.05", "contactleft ? height : height-0.05"},
    {"set-point", "contact.left ? sin(v) : cos(v)", "contactleft ? sin(v) : cos(v)"},
    {"set-point", "exp(-3 1/s*t)*(com.z - $height) + $height", "exp(-3*t)*(comz-height)+height"},
    {"arithmetic", "0.7*$lift", "0.7*lift"},
    {"arithmetic", "$lift - t + $land + 0.024", "lift-t+land+0.024"},
    {"arithmetic", "com.z^2", "comz^2"},
    {"arithmetic", "com.z^3 - 2*com.z^2 + com.z", "comz^3-2*comz^2+comz"},
    {"arithmetic", "com.z^1.5", "comz^1.5"},
    {"arithmetic", "(com.z - $height)/(t + 0.1)*(q0 + fz)", "(comz-height)/(t+0.1)*(q0+fz)"},
    {"arithmetic", "(q0 - 1)*(q0 + 2) - (com.z - 3)*(com.z + 4) + (v - 5)*(v + 6)",
     "(q0-1)*(q0+2)-(comz-3)*(comz+4)+(v-5)*(v+6)"},
    {"arithmetic", "-q0", "-q0"},
    {"arithmetic", "sqrt(com.z/9.81)", "sqrt(comz/9.81)"},
    {"function", "min(com.z, $height)", "min(comz,height)"},
    {"function", "max(com.z, $height, 0.8)", "max(comz,height,0.8)"},
    {"function", "clamp(com.z, 0.7, 0.9)", "clamp(comz,0.7,0.9)"},
    {"function", "clamp($height + 0.1*(com.z - 0.9), 0.7, $height)",
     "clamp(height+0.1*(comz-0.9),0.7,height)"},
    {"function", "hypot(com.z, q0)", "hypot(comz,q0)"},
    {"function", "atan2(q0, com.z)", "atan2(q0,comz)"},
    {"long", "q0 + com.z + fz + v + q0*com.z + q0*fz + q0*v + com.z*fz + com.z*v + fz*v + 1",
     "q0+comz+fz+v+q0*comz+q0*fz+q0*v+comz*fz+comz*v+fz*v+1"},
    {"long",
     "((q0*0.1 + 0.2)*q0 + 0.3)*q0 + ((com.z*0.4 + 0.5)*com.z + 0.6)*com.z - (fz > 50 and com.z > "
     "0.5 ? (fz - 50)*0.001 : v > 0.3 ? 0.3 - v : 0) + min(q0, com.z, v)*$lift/$land",
     "((q0*0.1+0.2)*q0+0.3)*q0+((comz*0.4+0.5)*comz+0.6)*comz-(fz>50 && comz>0.5 ? (fz-50)*0.001 : "
     "v>0.3 ? 0.3-v : 0)+min(q0,comz,v)*lift/land"},
};

// One tick's values.
struct Row {
  double signals[kSignals];
  double time;
  std::int64_t tick;
};

struct Values {
  core::SignalTable signals;
  std::vector<behaviors::ParameterInfo> parameters;
  double parameter_values[kParameters] = {0.91, 0.145, 0.15};
  std::int64_t entry_ticks[2] = {0, 0};
  std::uint8_t active[2] = {1, 1};
  std::vector<Row> rows;

  Values() {
    for (const char* name : {"fz", "com.z", "q0", "contact.left", "contact.right", "inwalk", "v"}) {
      signals.add(name, core::kNone, "");
    }
    for (const char* name : {"height", "lift", "land"}) {
      behaviors::ParameterInfo info;
      info.name = name;
      info.slot = static_cast<int>(parameters.size());
      info.bare = true;
      parameters.push_back(info);
    }
    for (int k = 0; k < kRows; ++k) {
      const double x = k;
      const std::int64_t tick = (k * 37) % 500;
      rows.push_back({{120 + 100 * std::sin(0.7 * x), 0.9 + 0.1 * std::sin(1.3 * x), 0.4 + 0.01 * x,
                       k % 16 < 11 ? 1.0 : 0.0, k % 9 < 5 ? 1.0 : 0.0, 1.0, 0.3 - 0.01 * x},
                      1e-3 * static_cast<double>(tick),
                      tick});
    }
  }
};

double clamp(double x, double low, double high) { return std::min(std::max(x, low), high); }
double hypotenuse(double x, double y) { return std::hypot(x, y); }

double now_ns() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

struct Ours {
  behaviors::ExpressionPool pool;
  EvaluationContext context;
  double values[kSignals];
  int index = -1;

  Ours(const Values& v, const char* text) {
    behaviors::ExpressionScope scope;
    scope.signals = &v.signals;
    scope.parameters = &v.parameters;
    scope.state = 1;
    scope.find_state = [](std::string_view, std::string&) { return 1; };
    behaviors::ExpressionError error;
    index = compile_expression(text, scope, std::nullopt, pool, error);
    if (index < 0) throw std::runtime_error(std::string(text) + ": " + error.text);
    context.signals = values;
    context.parameters = v.parameter_values;
    context.entry_ticks = v.entry_ticks;
    context.active = v.active;
  }
  double at(const Row& row) {
    std::copy_n(row.signals, kSignals, values);
    context.tick = row.tick;
    return evaluate(pool, index, context);
  }
};

struct MuParser {
  mu::Parser parser;
  double values[kSignals];
  double parameters[kParameters];
  double time = 0.0;

  MuParser(const Values& v, const char* text) {
    std::copy_n(v.parameter_values, kParameters, parameters);
    for (int k = 0; k < kSignals; ++k) {
      std::string name = v.signals.info(k).name;
      std::erase(name, '.');
      parser.DefineVar(name, &values[k]);
    }
    for (int k = 0; k < kParameters; ++k) {
      parser.DefineVar(v.parameters[static_cast<std::size_t>(k)].name, &parameters[k]);
    }
    parser.DefineVar("t", &time);
    parser.DefineFun("clamp", clamp);
    parser.DefineFun("hypot", hypotenuse);
    parser.SetExpr(text);
  }
  double at(const Row& row) {
    std::copy_n(row.signals, kSignals, values);
    time = row.time;
    return parser.Eval();
  }
};

volatile double sink;

template <typename Engine>
double round_ns(Engine& engine, const Values& v) {
  double sum = 0.0;
  const double begin = now_ns();
  for (int k = 0; k < kCalls; ++k) sum += engine.at(v.rows[static_cast<std::size_t>(k % kRows)]);
  const double end = now_ns();
  sink = sum;
  return (end - begin) / kCalls;
}

// What the loop costs by itself: copying a row of values.
struct Nothing {
  double values[kSignals];
  double at(const Row& row) {
    std::copy_n(row.signals, kSignals, values);
    asm volatile("" ::"r"(values) : "memory");
    return values[0];
  }
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

nlohmann::json measure(const Values& v, const Pair& pair) {
  Ours ours(v, pair.ours);
  MuParser muparser(v, pair.muparser);
  Nothing nothing;
  double difference = 0.0;
  for (const Row& row : v.rows) {
    const double a = ours.at(row), b = muparser.at(row);
    difference = std::max(difference, std::abs(a - b) / std::max(1.0, std::abs(b)));
  }
  std::vector<double> own, other, empty;
  for (int round = 0; round < kRounds; ++round) {
    own.push_back(round_ns(ours, v));
    other.push_back(round_ns(muparser, v));
    empty.push_back(round_ns(nothing, v));
  }
  const double floor = median(empty);
  return {{"group", pair.group},
          {"expression", pair.ours},
          {"footfall_ns", median(own) - floor},
          {"muparser_ns", median(other) - floor},
          {"ratio", (median(own) - floor) / (median(other) - floor)},
          {"ratio_with_loop", median(own) / median(other)},
          {"difference", difference}};
}

int run() {
  const Values values;
  nlohmann::json rows = nlohmann::json::array();
  std::vector<double> ratios;
  double worst = 0.0, difference = 0.0;
  for (const Pair& pair : kPairs) {
    const nlohmann::json row = measure(values, pair);
    std::fprintf(stderr, "%6.1f ns, muParser %6.1f ns: %.2f x  %s\n",
                 row["footfall_ns"].get<double>(), row["muparser_ns"].get<double>(),
                 row["ratio"].get<double>(), pair.ours);
    ratios.push_back(row["ratio"]);
    worst = std::max(worst, row["ratio"].get<double>());
    difference = std::max(difference, row["difference"].get<double>());
    rows.push_back(row);
  }
  const auto half = std::count_if(ratios.begin(), ratios.end(), [](double r) { return r <= 0.5; });
  const nlohmann::json result = {
      {"expressions", ratios.size()}, {"median_ratio", median(ratios)},   {"worst_ratio", worst},
      {"twice_as_fast", half},        {"largest_difference", difference}, {"rows", rows}};
  std::printf("%s\n", result.dump().c_str());
  return difference <= 1e-12 ? 0 : 1;  // muParser reorders some sums
}

}  // namespace
}  // namespace footfall::tests

int main() { return footfall::tests::run(); }
