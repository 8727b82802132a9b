// The tick; see control_loop.h.
#include "engine/tick/control_loop.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "behaviors/compiled/control_set.h"
#include "behaviors/language/estimators.h"
#include "core/index.h"

namespace footfall::engine {

ControlLoop::ControlLoop(const behaviors::Behavior& behavior, hal::Hardware& hardware,
                         const LoopSettings& settings)
    : behavior_(behavior),
      hardware_(hardware),
      period_(behavior.robot.period_s()),
      waits_(settings.waits),
      signals_(behavior.signals),
      model_(behavior.robot, settings.deviation),
      machine_(std::make_unique<behaviors::Machine>(behavior, signals_, &model_)),
      edits_(behavior),
      sensing_(behavior, model_),
      controller_(model_, behavior.robot.torque_limits(), behaviors::controller_sizes(behavior),
                  period_),
      ranks_(behavior, model_),
      swings_(behavior),
      slips_(behavior),
      safety_(behavior.robot),
      faults_(behavior),
      writer_(behavior, signals_),
      outside_(behavior, settings),
      link_(behavior, hardware) {
  machine_->set_surface(settings.surface);
}

void ControlLoop::start() {
  hardware_.start();
  find_state();
  model_.update(estimate_.state);
  writer_.write_measured(time(), model_, sensors_, estimate_);
  writer_.leave_gaps();
  machine_->start();
  outside_.start(*machine_);
}

// Each read begins anew with an estimator that has seen nothing: a replay has the last one only.
void ControlLoop::find_state() {
  const behaviors::EstimatorInfo& info = behaviors::estimator_info(behavior_.estimator.type);
  const double limit = waits_ && info.needs_mocap ? behavior_.robot.mocap_age : 0.0;
  const std::int64_t reads = 1 + std::llround(limit / period_);
  std::int64_t most = 0;  // markers
  for (std::int64_t k = 0; k < reads; ++k) {
    if (k > 0) sensing_.reset(model_);
    sense();
    estimate_ = {};
    std::copy_n(sensors_.q.begin(), model_.joint_count(), estimate_.state.q.begin());
    model_.update(estimate_.state);
    if (sensing_.start(sensors_, model_, link_.support(), machine_->parameters(), estimate_))
      return;
    most = std::max(most, std::ranges::count(sensors_.marker_seen, true));
  }
  std::string text = "no state at the start: the first data of the backend '" + hardware_.name() +
                     "' do not give the estimator '" + std::string(info.name) + "' one";
  constexpr std::int64_t kEnough = 3;  // markers for an attitude
  const bool few = info.needs_mocap && most < kEnough;
  if (few) {
    text += " (in " + std::to_string(reads) + " reads motion capture sees " + std::to_string(most) +
            " markers at most, 3 are needed)";
  } else if (info.needs_mocap) {
    text +=
        " (" + std::to_string(most) +
        " markers are seen, but they are older than `oldest_frame`, on a line, or not where the "
        "robot has them: `marker_gate`)";
  }
  throw NoState(text, few);
}

LoopState ControlLoop::tick() noexcept {
  sense();
  compute();
  actuate();
  return state();
}

bool ControlLoop::sense() noexcept {
  outside_.wait();
  fresh_ = hardware_.read(sensors_);
  return fresh_;
}

void ControlLoop::compute() noexcept {
  faults_.begin_tick();
  const Sensed sensed =
      sensing_.step(sensors_, fresh_, model_, link_.support(), machine_->parameters(), estimate_);
  model_.update(estimate_.state);
  writer_.write_measured(time(), model_, sensors_, estimate_);
  // After the estimate, as a replay writes what came from outside: there, too, it acts on the
  // estimator from the next tick on.
  edits_.apply(tick_, *machine_);
  // A foot in the air swings while another one holds; a robot on a rope may hang there.
  const bool swings = machine_->stepping() && link_.support() != 0;
  faults_.take(
      safety_.check_state(
          sensors_, {fresh_, sensed.estimated, swings, estimate_.contact, sensed.findings}, model_),
      *machine_);
  faults_.take_late(outside_.deliver(tick_, *machine_, edits_.moved() || safety_.held_back()),
                    *machine_);
  machine_->tick(tick_);
  faults_.take_counts(*machine_);
  faults_.take(outside_.post(tick_, *machine_, signals_, time()), *machine_);
  controller_.compute(machine_->control(), tick_, sensors_.tau.data(), commands_.tau.data());
  faults_.take(ranks_.check(machine_->control_spec(), controller_.result()), *machine_);
  faults_.take(swings_.check(machine_->control_spec(), estimate_.contact, machine_->stepping()),
               *machine_);
  faults_.take(slips_.check(machine_->control().primary, model_, controller_.result()), *machine_);
  faults_.take(safety_.filter(commands_, sensors_, outside_.limit_steps()), *machine_);
  sensing_.commanded(commands_);
  writer_.write_control(*machine_, controller_.result(), commands_, safety_.torque_step(),
                        faults_.counters());
}

void ControlLoop::actuate() noexcept {
  link_.tell(*machine_);
  hardware_.write(commands_);
  ++tick_;
}

LoopState ControlLoop::state() const noexcept {
  if (faults_.state() == LoopState::running && machine_->finished()) return LoopState::finished;
  return faults_.state();
}

void ControlLoop::safe_stop() noexcept {
  machine_->enter_safe();
  hardware_.safe_stop();
}

}  // namespace footfall::engine
