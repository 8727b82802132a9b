// Expected ranks and the comparison; see rank_watch.h.
#include "engine/tick/rank_watch.h"

#include <array>
#include <memory>

#include "behaviors/compiled/control_set.h"
#include "core/index.h"

namespace footfall::engine {

RankWatch::RankWatch(const behaviors::Behavior& behavior, model::ControlModel& model)
    : condition_limit_(behavior.robot.condition_limit) {
  model::State nominal;
  nominal.p_WB = {0.0, 0.0, behavior.robot.standing_height};
  for (std::size_t j = 0; j < behavior.robot.joints.size(); ++j) {
    nominal.q[j] = behavior.robot.joints[j].posture;
  }
  model.update(nominal);
  tasks::WholeBodyController controller(model, {}, behaviors::controller_sizes(behavior),
                                        behavior.period());
  const auto control = std::make_unique<tasks::ActiveControl>();
  std::array<double, core::kMaxJoints> unused{};
  for (const behaviors::ControlSpec& spec : behavior.controls) {
    Expectation& expectation = expected_.emplace_back();
    tasks::ControlSet& set = control->primary;
    behaviors::fill_control_set(behavior, spec, set);
    controller.compute(*control, 0, nullptr, unused.data());
    expectation.at_load = read(set.task_count, controller.result());
    for (int a = 0; a < set.axis_count; ++a) set.axes[at(a)].weight = 1.0;
    controller.compute(*control, 0, nullptr, unused.data());
    expectation.all = read(set.task_count, controller.result());
    for (int t = 0; t < set.task_count; ++t) {
      expectation.instances.push_back(set.tasks[at(t)].instance);
    }
  }
}

RankWatch::Law RankWatch::read(int tasks, const tasks::ControllerResult& result) {
  Law law;
  for (int t = 0; t < tasks; ++t) {
    law.push_back({result.tasks[at(t)].rows, result.tasks[at(t)].rank});
  }
  return law;
}

// With the rows of the first tick each rank is known; with others, a row out of its level costs it
// one rank at most, and gives levels below the more.
FaultFindings RankWatch::check(int control, const tasks::ControllerResult& result) const noexcept {
  FaultFindings findings;
  const Expectation& expectation = expected_[at(control)];
  bool as_at_load = true;
  for (std::size_t t = 0; t < expectation.at_load.size(); ++t) {
    as_at_load &= result.tasks[t].rows == expectation.at_load[t].rows;
  }
  for (std::size_t t = 0; t < expectation.all.size(); ++t) {
    const Expected& all = expectation.all[t];
    const int least =
        as_at_load ? expectation.at_load[t].rank : all.rank - (all.rows - result.tasks[t].rows);
    if (result.tasks[t].rank < least) findings.add(core::Fault::rank_loss);
    const double condition = result.tasks[t].condition;
    if (condition > condition_limit_) {
      findings.add(core::Fault::condition,
                   {expectation.instances[t], condition, condition - condition_limit_});
    }
  }
  return findings;
}

}  // namespace footfall::engine
