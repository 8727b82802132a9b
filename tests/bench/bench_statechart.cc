// What a statechart of 200 states, 4 regions and 400 transitions costs in a tick of the machine,
// against the WBOSC algebra (Hume in dual support, solve only) in one process: rounds of every part
// in turn, medians. Then 10^5 lively ticks under the allocation count, which take every transition.
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/bench/algebra_cases.h"
#include "tests/bench/timing.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/big_chart.h"

namespace footfall::tests {
namespace {

constexpr int kRounds = 31;
constexpr int kLivelyTicks = 100'000;

struct Coverage {
  long allocations = 0;
  int taken = 0;  // different transitions
  long count = 0;
};

Coverage lively_run() {
  BigChart chart;
  std::vector<int> taken(chart.behavior->transitions.size());
  Coverage result;
  {
    const AllocationGuard guard;
    for (int k = 0; k < kLivelyTicks; ++k) {
      chart.drive();
      for (const int t : chart.machine.transitions_taken()) ++taken[static_cast<std::size_t>(t)];
    }
    result.allocations = guard.allocations();
  }
  for (const int n : taken) {
    result.taken += n > 0 ? 1 : 0;
    result.count += n;
  }
  return result;
}

void run() {
  Algebra algebra(true);
  BigChart quiet, one, every;  // `now` stands still: no timer falls due in the first, which waits
  const std::int64_t start = 10;
  for (BigChart* chart : {&quiet, &one, &every}) {
    while (chart->now < start) chart->tick();
  }
  long moved[3] = {0, 0, 0};
  const auto step = [&moved](BigChart& chart, int which) {
    chart.now = start - 1;
    chart.tick();
    moved[which] += static_cast<long>(chart.machine.transitions_taken().size());
  };
  enum { kSolve, kQuiet, kOne, kEvery, kParts };
  std::array<Part, kParts> parts;
  parts[kSolve].call = [&](int i) {
    algebra.cases[static_cast<std::size_t>(i % kProblems)].solver->solve();
  };
  parts[kQuiet].call = [&](int) { step(quiet, 0); };
  parts[kOne].call = [&](int i) {
    one.machine.raise(one.next_region[static_cast<std::size_t>(i % kBigRegions)]);
    step(one, 1);
  };
  parts[kEvery].call = [&](int) {
    every.machine.raise(every.next_all);
    step(every, 2);
  };
  for (Part& part : parts) {
    for (int i = 0; i < 500; ++i) part.call(i);
  }
  moved[0] = moved[1] = moved[2] = 0;
  for (int round = 0; round < kRounds; ++round) {
    for (Part& part : parts) part.round();
  }
  const double calls = static_cast<double>(kRounds) * parts[kQuiet].calls;
  const auto row = [&](int part, long transitions) {
    return nlohmann::ordered_json{
        {"tick_us", rounded(parts[static_cast<std::size_t>(part)].median())},
        {"over_algebra",
         rounded(parts[static_cast<std::size_t>(part)].median() / parts[kSolve].median())},
        {"transitions_a_tick", rounded(static_cast<double>(transitions) / calls)}};
  };
  const Coverage lively = lively_run();
  const nlohmann::ordered_json result = {{"states", quiet.behavior->states.size()},
                                         {"regions", kBigRegions},
                                         {"transitions", quiet.behavior->transitions.size()},
                                         {"algebra_us", rounded(parts[kSolve].median())},
                                         {"without", row(kQuiet, moved[0])},
                                         {"with_one", row(kOne, moved[1])},
                                         {"with_one_in_every_region", row(kEvery, moved[2])},
                                         {"lively_ticks", kLivelyTicks},
                                         {"lively_transitions", lively.count},
                                         {"different_transitions_taken", lively.taken},
                                         {"allocations", lively.allocations}};
  std::printf("%s\n", result.dump(2).c_str());
}

}  // namespace
}  // namespace footfall::tests

int main() {
  try {
    footfall::tests::run();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_statechart: %s\n", error.what());
    return 4;
  }
}
