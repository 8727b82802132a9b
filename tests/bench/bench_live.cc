// What tuning costs the tick: CPU time of a balancing robot's ticks with telemetry posted and 500
// edits per second of the run ramping, against the same robot left alone, rounds in turn in one
// process; heap calls and pthread locks of those ticks. Prints {"ratio", "allocations", "locks",
// ...}.
#include <dlfcn.h>
#include <pthread.h>

#include <algorithm>
#include <cstdlib>
#include <footfall_lcm/answer_t.hpp>
#include <footfall_lcm/catalogue_t.hpp>
#include <footfall_lcm/request_t.hpp>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "engine/live/server.h"
#include "engine/live/snapshot.h"
#include "tests/bench/timing.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rig.h"

namespace {
thread_local bool t_in_tick = false;
thread_local long t_locks = 0;

using LockCall = int (*)(void*);
// dlsym may lock by itself: it is asked outside of the ticks.
LockCall real(const char* name) { return reinterpret_cast<LockCall>(dlsym(RTLD_NEXT, name)); }
int counted(LockCall call, void* lock) {
  if (t_in_tick) ++t_locks;
  return call(lock);
}
}  // namespace

// In place of libc's, for the whole program.
extern "C" {
int pthread_mutex_lock(pthread_mutex_t* lock) {
  static const LockCall call = real("pthread_mutex_lock");
  return counted(call, lock);
}
int pthread_mutex_trylock(pthread_mutex_t* lock) {
  static const LockCall call = real("pthread_mutex_trylock");
  return counted(call, lock);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) {
  static const LockCall call = real("pthread_rwlock_rdlock");
  return counted(call, lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) {
  static const LockCall call = real("pthread_rwlock_wrlock");
  return counted(call, lock);
}
}

namespace footfall::tests {
namespace {

constexpr int kRounds = 9;
constexpr int kTicks = 9000;   // of a round: 6 s
constexpr int kEditEvery = 3;  // ticks: 500 per second at 1500 Hz

struct Round {
  std::vector<double> us;  // of each tick
  long allocations = 0, locks = 0;
  std::int64_t applied = 0, snapshots = 0;
  bool fell = false;
};

// An edit of some value to within 20 % of what the file has.
footfall_lcm::request_t random_edit(const footfall_lcm::catalogue_t& catalogue,
                                    std::mt19937_64& random, std::int64_t sequence) {
  const auto& p = catalogue.parameters[random() % catalogue.parameters.size()];
  footfall_lcm::change_t change{};
  change.name = p.name;
  change.component = -1;
  const double factor = std::uniform_real_distribution<double>(0.8, 1.2)(random);
  for (int k = 0; k < p.size; ++k) {
    const double value = factor * catalogue.values[static_cast<std::size_t>(p.first + k)];
    change.values.push_back(p.has_range ? std::clamp(value, p.min, p.max) : value);
  }
  footfall_lcm::request_t request{};
  request.session = catalogue.session;
  request.client = 1;
  request.sequence = sequence;
  request.who = "bench";
  request.revision = -1;
  request.changes.push_back(change);
  return request;
}

Round play(bool tuned, double telemetry) {
  Rig rig("balance_best");
  engine::LiveServer server(*rig.behavior, rig.loop->edits().entrance(1), {1, false});
  engine::LiveFeed feed(*rig.loop, telemetry);
  footfall_lcm::catalogue_t catalogue{};
  server.fill_catalogue(catalogue);
  engine::LiveServer::Answers answers;
  std::mt19937_64 random(5);
  Round round;
  round.us.reserve(kTicks);
  rig.loop->start();
  for (int k = 0; k < kTicks; ++k) {
    if (tuned && k % kEditEvery == 0) {
      server.request(random_edit(catalogue, random, 1 + k / kEditEvery), answers);
    }
    rig.loop->sense();
    {
      const AllocationGuard guard;
      t_in_tick = true;
      const double before = now_us(CLOCK_THREAD_CPUTIME_ID);
      rig.loop->compute();
      if (tuned) feed.post(*rig.loop, 0);
      round.us.push_back(now_us(CLOCK_THREAD_CPUTIME_ID) - before);
      t_in_tick = false;
      round.allocations += guard.allocations();
    }
    rig.loop->actuate();
    server.poll(answers);
    answers.clear();
    for (; feed.front() != nullptr; feed.pop()) ++round.snapshots;
  }
  round.locks = std::exchange(t_locks, 0);
  round.applied = server.counters().applied;
  round.fell = rig.loop->state() != engine::LoopState::running;
  return round;
}

double sum(const std::vector<double>& values) {
  double total = 0.0;
  for (const double value : values) total += value;
  return total;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

int run(double telemetry) {
  pthread_mutex_t probe = PTHREAD_MUTEX_INITIALIZER;
  t_in_tick = true;
  pthread_mutex_lock(&probe);  // the count counts
  t_in_tick = false;
  pthread_mutex_unlock(&probe);
  const bool counts = std::exchange(t_locks, 0) == 1 && AllocationGuard::counts();
  std::vector<double> ratios, medians, plain_us, tuned_us;
  long allocations = 0, locks = 0;
  Round last;
  bool fell = false;
  for (int r = 0; r < kRounds; ++r) {
    const Round plain = play(false, telemetry);
    last = play(true, telemetry);
    ratios.push_back(sum(last.us) / sum(plain.us));
    medians.push_back(median(last.us) / median(plain.us));
    plain_us.push_back(sum(plain.us) / kTicks);
    tuned_us.push_back(sum(last.us) / kTicks);
    allocations += plain.allocations + last.allocations;
    locks += plain.locks + last.locks;
    fell |= plain.fell || last.fell;
  }
  const nlohmann::ordered_json out = {{"ratio", rounded(median(ratios))},
                                      {"telemetry_hz", telemetry},
                                      {"ratio_of_median_ticks", rounded(median(medians))},
                                      {"plain_us", rounded(median(plain_us))},
                                      {"tuned_us", rounded(median(tuned_us))},
                                      {"allocations", allocations},
                                      {"locks", locks},
                                      {"counts", counts},
                                      {"edits_per_round", last.applied},
                                      {"snapshots_per_round", last.snapshots},
                                      {"ticks_per_round", kTicks},
                                      {"rounds", kRounds},
                                      {"fell", fell}};
  std::puts(out.dump().c_str());
  return counts ? 0 : 1;
}

}  // namespace
}  // namespace footfall::tests

int main(int argc, char** argv) {
  return footfall::tests::run(argc > 1 ? std::atof(argv[1]) : 50.0);
}
