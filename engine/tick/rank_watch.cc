// Expected ranks and the comparison; see rank_watch.h.
#include "engine/tick/rank_watch.h"

#include <array>
#include <memory>

#include "behaviors/compiled/control_set.h"
#include "core/index.h"

namespace footfall::engine {

RankWatch::RankWatch(const behaviors::Behavior& behavior, model::ControlModel& model) {
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
    behaviors::fill_control_set(behavior, spec, control->primary);
    controller.compute(*control, 0, nullptr, unused.data());
    std::vector<int>& ranks = expected_.emplace_back();
    for (int t = 0; t < control->primary.task_count; ++t) {
      ranks.push_back(controller.result().tasks[at(t)].rank);
    }
  }
}

FaultFindings RankWatch::check(int control, const tasks::ControllerResult& result) const noexcept {
  FaultFindings findings;
  const std::vector<int>& expected = expected_[at(control)];
  for (std::size_t t = 0; t < expected.size(); ++t) {
    if (result.tasks[t].rank < expected[t]) findings.add(core::Fault::rank_loss);
  }
  return findings;
}

}  // namespace footfall::engine
