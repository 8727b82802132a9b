// The last word before the hardware: finite, within limits, not falling. Pure state, no clock.
#pragma once

#include <array>
#include <vector>

#include "engine/estimators/estimator.h"
#include "engine/tick/faults.h"
#include "engine/watch/sensor_watch.h"
#include "hal/hardware.h"
#include "model/control_model.h"
#include "model/robot/description.h"

namespace footfall::engine {

// What else a tick knows when its state is checked.
struct TickStart {
  bool fresh = true;      // the last read brought something new
  bool estimated = true;  // the estimator gave a state
  bool stepping = false;  // the behavior steps on some foot: one in the air is a swing
  Contacts contact{};     // as estimated
  SensorFindings sensed{};
};

class SafetyFilter {
 public:
  explicit SafetyFilter(const model::RobotDescription& robot);

  // Before control: fall (height of the base above the lowest contact point below its part of the
  // standing height, tilt beyond the limit, another body touching), joint limits, swings,
  // sensors, estimator and backend. Once a tick: it counts how long each foot is in the air.
  FaultFindings check_state(const hal::Sensors& sensors, const TickStart& tick,
                            const model::ControlModel& model) noexcept;

  // After control: makes the torques asked for into those that are sent. If one is not finite all
  // are 0. The others are held within the joints' limits; steps are counted (the first tick has
  // none). With `limit_steps` no command steps by more than the robot's bound, to the last bit: it
  // follows what was asked for at that rate.
  FaultFindings filter(hal::Commands& commands, const hal::Sensors& sensors,
                       bool limit_steps = false) noexcept;

  // Goes on from the commands that another filter of the same robot let pass.
  void take_over(const SafetyFilter& old) noexcept {
    air_ticks_ = old.air_ticks_;
    previous_ = old.previous_;
    have_previous_ = old.have_previous_;
    torque_step_ = old.torque_step_;
    held_back_ = old.held_back_;
  }

  double torque_step() const noexcept { return torque_step_; }  // N m, largest of the last tick
  // Whether the last filter() held a command back for its step.
  bool held_back() const noexcept { return held_back_; }

 private:
  void check_swings(const TickStart& tick, FaultFindings& findings) noexcept;

  const model::RobotDescription& robot_;
  std::array<std::int64_t, core::kMaxContacts> air_ticks_{};  // of each foot, since its lift-off
  std::array<double, core::kMaxJoints> previous_{};
  bool have_previous_ = false;
  double torque_step_ = 0.0;
  bool held_back_ = false;
};

}  // namespace footfall::engine
