// What an estimator costs in a tick, against the whole-body algebra of one foot and of two in the
// same process: rounds of every part in turn, the lowest round of each counts. The sensors are
// those of a walk of 4 s with the errors of a laboratory. Needs about 5 s.
#include <mujoco/mujoco.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "behaviors/language/estimators.h"
#include "engine/estimators/catalogue.h"
#include "tests/bench/algebra_cases.h"
#include "tests/bench/timing.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/sensed_walk.h"

namespace footfall::tests {
namespace {

constexpr int kRounds = 11;
constexpr double kWalk = 4.0;  // s

// Of every `kEvery`-th tick, with the model as it then is: as many states as fit in a cache.
struct Moment {
  hal::Sensors sensors;
  std::uint64_t support = 0;
};

struct Subject {
  std::unique_ptr<engine::Estimator> estimator;
  std::vector<double> parameters;
  engine::Estimate estimate;
};

Subject make_subject(behaviors::EstimatorType type, const model::RobotDescription& robot,
                     const model::ControlModel& model) {
  Subject subject;
  behaviors::EstimatorSpec spec;
  spec.type = type;
  subject.estimator = engine::make_estimator(spec, robot, model);
  for (const auto& row : behaviors::estimator_info(type).parameters) {
    // Every foot is corrected for, though the model stands still.
    subject.parameters.push_back(row.name == "slip_gate" ? 0.0 : row.value);
  }
  return subject;
}

// Ticks in a row, so that filters see motion; the model is that of one standing state throughout,
// with the feet's Jacobians filled, as the tick's controller leaves them.
std::vector<Moment> record(SensedWalk& walk) {
  std::vector<Moment> moments;
  while (walk.next() && walk.rig.loop->time() < kWalk) {
    if (walk.rig.loop->time() > 1.0) moments.push_back({walk.sensors, walk.support});
  }
  return moments;
}

// The same with both feet on the ground all the time: the dearest tick.
std::vector<Moment> on_two_feet(std::vector<Moment> moments) {
  for (Moment& m : moments) {
    m.sensors.contact = {true, true};
    m.support = 3;
  }
  return moments;
}

long allocations_of(const Part& one, const Part& other) {
  const AllocationGuard guard;
  for (int i = 0; i < 3000; ++i) {
    one.call(i);
    other.call(i);
  }
  return guard.allocations();
}

int run() {
  SensedWalk walk(1, laboratory_errors());
  const std::vector<Moment> moments = record(walk);
  const model::RobotDescription& robot = walk.rig.behavior->robot;
  model::ControlModel model(robot);
  model.update(walk.truth());
  Subject mocap = make_subject(behaviors::EstimatorType::motion_capture, robot, model);
  Subject two_feet = make_subject(behaviors::EstimatorType::contact_kalman, robot, model);
  Subject kalman = make_subject(behaviors::EstimatorType::contact_kalman, robot, model);
  const std::vector<Moment> dual_moments = on_two_feet(moments);
  const auto tick = [](Subject& s, const model::ControlModel& model,
                       const std::vector<Moment>& moments) {
    return [&](int i) {
      const Moment& m = moments[static_cast<std::size_t>(i) % moments.size()];
      s.estimator->estimate({m.sensors, model, m.support, s.parameters}, s.estimate);
    };
  };
  Algebra dual(true), single(false);
  SensedWalk standing(1, SensorErrors{});
  mjModel* physics = standing.rig.backend->model();
  mjData* data = standing.rig.backend->data();
  const auto solve = [](Algebra& a) {
    return [&a](int i) { a.cases[static_cast<std::size_t>(i) % kProblems].solver->solve(); };
  };
  enum { kMocap, kKalman, kTwoFeet, kDual, kSingle, kFactor, kCount };
  std::array<Part, kCount> parts;
  parts[kMocap].call = tick(mocap, model, moments);
  parts[kKalman].call = tick(kalman, model, moments);
  parts[kTwoFeet].call = tick(two_feet, model, dual_moments);
  parts[kDual].call = solve(dual);
  parts[kSingle].call = solve(single);
  parts[kFactor].call = [&](int) { mj_factorM(physics, data); };
  for (Part& part : parts) {
    for (int i = 0; i < 500; ++i) part.call(i);
  }
  for (int round = 0; round < kRounds; ++round) {
    for (Part& part : parts) part.round();
  }
  const long allocations = allocations_of(parts[kMocap], parts[kKalman]);
  const double algebra = parts[kDual].lowest() + parts[kFactor].lowest();
  const auto figures = [&](const Part& part) {
    return nlohmann::ordered_json{{"us", rounded(part.lowest())},
                                  {"over_wbosc_dual", rounded(part.lowest() / algebra)}};
  };
  const nlohmann::ordered_json result = {
      {"motion_capture", figures(parts[kMocap])},
      {"contact_kalman", figures(parts[kKalman])},
      {"contact_kalman_two_feet", figures(parts[kTwoFeet])},
      {"wbosc_dual_us", rounded(algebra)},
      {"wbosc_single_us", rounded(parts[kSingle].lowest() + parts[kFactor].lowest())},
      {"allocations", allocations}};
  std::printf("%s\n", result.dump(2).c_str());
  return allocations == 0 ? 0 : 1;
}

}  // namespace
}  // namespace footfall::tests

int main() {
  try {
    return footfall::tests::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_estimators: %s\n", error.what());
    return 4;
  }
}
