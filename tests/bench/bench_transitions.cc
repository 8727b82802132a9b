// Torque continuity of contact transitions. At each start and end both control laws are evaluated
// on the same measured state, references and integrals:
//   declared    the law in force before against the one in force after, as the behavior declares it
//   undeclared  the two plain laws (two feet against one) that would follow each other without it
// and the largest torque step between neighbouring ticks within 30 ms of a change, the tick of an
// impact excepted. Prints {"declared_Nm", "undeclared_Nm", "max_tick_step_Nm", "ends"}.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/figures/step_counter.h"
#include "tests/support/rig.h"

namespace footfall {
namespace {

constexpr int kSteps = 50;
constexpr double kNear = 0.030;   // s around a change of the control law
constexpr double kSettled = 2.0;  // s

double largest_difference(const double* a, const double* b, int n) {
  double largest = 0.0;
  for (int i = 0; i < n; ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

// The control of a transition carried to its end (its final weight), with today's references for
// every task that is still there.
tasks::ActiveControl carried_to_end(tasks::ActiveControl old, const tasks::ActiveControl& now) {
  old.other_weight = old.other_weight < 0.5 ? 0.0 : 1.0;
  old.transition_entered = false;
  for (tasks::ControlSet* set : {&old.primary, &old.other}) {
    for (int t = 0; t < set->task_count; ++t) {
      const tasks::TaskCommand& task = set->tasks[static_cast<std::size_t>(t)];
      for (int u = 0; u < now.primary.task_count; ++u) {
        const tasks::TaskCommand& fresh = now.primary.tasks[static_cast<std::size_t>(u)];
        if (fresh.instance != task.instance) continue;
        for (int i = 0; i < task.axis_count; ++i) {
          auto& axis = set->axes[static_cast<std::size_t>(task.first_axis + i)];
          for (int k = 0; k < fresh.axis_count; ++k) {
            const auto& source = now.primary.axes[static_cast<std::size_t>(fresh.first_axis + k)];
            if (source.axis != axis.axis) continue;
            axis.ref = source.ref;
            axis.ref_vel = source.ref_vel;
            axis.ref_acc = source.ref_acc;
          }
        }
      }
      set->tasks[static_cast<std::size_t>(t)].fresh = false;
    }
  }
  return old;
}

// Other feet without any transition, or with one that lasts no tick: a change like an end.
bool jumps(const tasks::ActiveControl& old, const tasks::ActiveControl& now) {
  const tasks::ControlSet &a = old.primary, &b = now.primary;
  return !old.has_other && !now.has_other &&
         !std::equal(a.contacts.begin(), a.contacts.begin() + a.contact_count, b.contacts.begin(),
                     b.contacts.begin() + b.contact_count);
}

// Torque differences at the starts and ends of transitions, Nm.
struct Ends {
  double declared = 0.0, undeclared_min = 1e9, undeclared_max = 0.0;
  std::int64_t count = 0;
  // declared_step: as the behavior declares it; jump: between the two plain laws.
  void add(double declared_step, double jump) {
    declared = std::max(declared, declared_step);
    undeclared_min = std::min(undeclared_min, jump);
    undeclared_max = std::max(undeclared_max, jump);
    ++count;
  }
};

void print(const Ends& ends, double near_step, double impact_step, std::int64_t steps) {
  const nlohmann::ordered_json out = {{"declared_Nm", ends.declared},
                                      {"undeclared_Nm", ends.undeclared_max},
                                      {"undeclared_min_Nm", ends.undeclared_min},
                                      {"max_tick_step_Nm", near_step},
                                      {"impact_step_Nm", impact_step},
                                      {"ends", ends.count},
                                      {"steps", steps}};
  std::printf("%s\n", out.dump().c_str());
}

int run(const char* behavior_name) {
  tests::Rig rig(behavior_name);
  engine::ControlLoop& loop = *rig.loop;
  const int n = loop.model().joint_count();
  lab::StepCounter steps(2, loop.period());
  tasks::ActiveControl previous;
  double near_step = 0.0, impact_step = 0.0;  // Nm
  Ends ends;
  double last_change = -1.0, last_impact = -1.0;
  std::array<bool, 2> contact{true, true};
  loop.start();
  while (steps.steps() < kSteps && loop.state() == engine::LoopState::running &&
         loop.time() < 60.0) {
    loop.sense();
    loop.compute();
    const std::array<double, 2> heights = {loop.model().point(0).position[2],
                                           loop.model().point(1).position[2]};
    steps.observe(loop.time(), loop.sensors().contact.data(), heights.data());
    for (std::size_t c = 0; c < 2; ++c) {
      if (loop.sensors().contact[c] && !contact[c]) last_impact = loop.time();
      contact[c] = loop.sensors().contact[c];
    }
    const tasks::ActiveControl& now = loop.machine().control();
    const tasks::WholeBodyController& law = loop.controller();
    const bool starts = now.has_other && now.transition_entered;
    const bool ended = previous.has_other && (!now.has_other || now.transition_entered);
    const bool jumped = loop.ticks() > 0 && jumps(previous, now);
    if (loop.time() > kSettled && (starts || ended || jumped)) {
      // What was in force until now, on today's state, against what is commanded.
      tasks::WholeBodyController twin = law;  // same integrals
      const tasks::ActiveControl old = carried_to_end(previous, now);
      std::array<double, core::kMaxJoints> carried{};
      twin.compute(old, loop.ticks(), loop.sensors().tau.data(), carried.data());
      const tasks::WholeBodyController& plain = starts ? law : twin;
      const double step = largest_difference(carried.data(), loop.commands().tau.data(), n);
      ends.add(step, jumped ? step : largest_difference(plain.tau_primary(), plain.tau_other(), n));
    }
    if (starts || ended || jumped) last_change = loop.time();
    const double tick_step = loop.signals()[loop.behavior().layout.torque_step];
    if (loop.time() > kSettled && loop.time() - last_change <= kNear) {
      if (last_impact == loop.time()) {
        impact_step = std::max(impact_step, tick_step);
      } else {
        near_step = std::max(near_step, tick_step);
      }
    }
    previous = now;
    loop.actuate();
  }
  print(ends, near_step, impact_step, steps.steps());
  return steps.steps() >= kSteps ? 0 : 1;
}

}  // namespace
}  // namespace footfall

int main(int argc, char** argv) { return footfall::run(argc > 1 ? argv[1] : "balance"); }
