// The law, driven by what was measured, for each delay; see delay.h.
#include "lab/identify/delay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/index.h"
#include "hal/actuators/torque_loop.h"

namespace footfall::lab {
namespace {

constexpr double kSettling = 0.5;  // s at the start that are not compared

// A cubic through four samples, at a fraction of the way from the second to the third.
double between(std::span<const double> values, int second, double part) {
  const int last = static_cast<int>(values.size()) - 1;
  const auto value = [&](int k) { return values[at(std::clamp(k, 0, last))]; };
  const double a = value(second - 1), b = value(second), c = value(second + 1),
               d = value(second + 2);
  return b +
         0.5 * part *
             (c - a + part * (2.0 * a - 5.0 * b + 4.0 * c - d + part * (3.0 * (b - c) + d - a)));
}

// First order, of what differs from the slow part.
void remove_drift(std::vector<double>& values, double period) {
  if (values.empty()) return;
  const double share = 1.0 - std::exp(-2.0 * std::numbers::pi * kHighPass * period);
  double slow = values.front();
  for (double& value : values) {
    slow += share * (value - slow);
    value -= slow;
  }
}

// Motor torque by tick: its mean over the tick before (N m), and its first moment about the middle
// of that tick over the tick's duration (N m s).
struct TickTorque {
  explicit TickTorque(int ticks) : mean(at(ticks), 0.0), moment(at(ticks), 0.0) {}
  std::vector<double> mean, moment;
};

// The law is linear: the motor torque is what it makes of the measurements plus what it makes of
// the reference.
class LawModel {
 public:
  LawModel(const ActuatorRecord& record, const LoopRecord& loop)
      : record_(record),
        loop_(loop),
        ticks_(static_cast<int>(record.motor.size())),
        steps_(std::max(1, static_cast<int>(std::lround(record.period / record.drive_step)))) {}

  int steps() const { return steps_; }

  // Without reference.
  TickTorque of_measurements() const {
    hal::TorqueLoop law(loop_.gains, record_.drive_step, loop_.rotor);
    TickTorque out(ticks_);
    double motor = record_.motor[0], torque = record_.torque[0];
    hal::TorqueLoopInput seen;
    for (int k = 0; k + 1 < ticks_; ++k) {
      for (int i = 1; i <= steps_; ++i) {
        // The sample of tick k + 1 is of the last step.
        const double part = static_cast<double>(i) / steps_;
        const double angle = between(record_.motor, k, part);
        seen.torque = between(record_.torque, k, part);
        follow(loop_.filters.motor, seen.motor_rate, angle - motor);
        follow(loop_.filters.spring, seen.spring_rate,
               (seen.torque - torque) / record_.nominal_spring);
        motor = angle;
        torque = seen.torque;
        advance(law, seen, i - 1, k + 1, out);
      }
    }
    return out;
  }

  // Of the reference alone, `late` steps delayed; fewer than a tick.
  TickTorque of_reference(int late) const {
    hal::TorqueLoop law(loop_.gains, record_.drive_step, loop_.rotor);
    TickTorque out(ticks_);
    hal::TorqueLoopInput seen;
    for (int k = 0; k + 1 < ticks_; ++k) {
      for (int i = 0; i < steps_; ++i) {
        seen.reference = loop_.command[at(i < late ? std::max(0, k - 1) : k)];
        advance(law, seen, i, k + 1, out);
      }
    }
    return out;
  }

 private:
  // The exact rates of a drive without filter (cutoff 0) are not in the log: by differences, too.
  void follow(double cutoff, double& rate, double moved) const {
    const double filtered = hal::filter_share(cutoff, record_.drive_step);
    const double share = filtered > 0.0 ? filtered : 1.0;
    rate += share * (moved / record_.drive_step - rate);
  }
  void advance(hal::TorqueLoop& law, const hal::TorqueLoopInput& seen, int step, int tick,
               TickTorque& out) const {
    const double asked = law.ask(seen);
    law.settle(seen, asked, asked);
    out.mean[at(tick)] += asked / steps_;
    out.moment[at(tick)] += asked / steps_ * (step + 0.5 - 0.5 * steps_) * record_.drive_step;
  }

  const ActuatorRecord& record_;
  const LoopRecord& loop_;
  int ticks_, steps_;
};

// What is to be explained, and by what: by steps of delay within a tick.
struct Explained {
  std::vector<double> target;
  std::vector<double> moment;  // of the law's torque without reference
  std::vector<TickTorque> references;
  std::vector<char> usable;  // by tick
  int first = 0;             // tick

  // Of the delay `late`, in steps.
  double reference(int late, int tick) const {
    const int steps = static_cast<int>(references.size());
    return references[at(late % steps)].mean[at(tick - late / steps)];
  }
  // Of the law's motor torque with that delay, a fractional one, by tick.
  std::vector<double> moments(double late) const {
    const int steps = static_cast<int>(references.size()), whole = static_cast<int>(late);
    const double part = late - whole;
    const auto of = [&](int steps_late, int tick) {
      return references[at(steps_late % steps)].moment[at(std::max(0, tick - steps_late / steps))];
    };
    std::vector<double> out = moment;
    for (int k = 0; k < static_cast<int>(out.size()); ++k) {
      out[at(k)] += (1.0 - part) * of(whole, k) + part * of(whole + 1, k);
    }
    return out;
  }
  template <typename Visit>
  void visit(const Visit& visit) const {
    for (int k = first; k < static_cast<int>(target.size()); ++k) {
      if (usable[at(k)] != 0) visit(k);
    }
  }
  double squares(int late) const {
    double sum = 0.0;
    visit([&](int k) {
      const double r = target[at(k)] - reference(late, k);
      sum += r * r;
    });
    return sum;
  }
};

struct Refined {
  double late = 0.0, error = 0.0;  // steps
  double squares = std::numeric_limits<double>::infinity();
};

// Between `late` and the next: the part α that explains best, and its standard error from sums over
// blocks, since residuals of near ticks are alike.
Refined refine(const Explained& data, int late, int block) {
  double bottom = 0.0, top = 0.0;
  const auto slope = [&](int k) { return data.reference(late + 1, k) - data.reference(late, k); };
  data.visit([&](int k) {
    top += slope(k) * (data.target[at(k)] - data.reference(late, k));
    bottom += slope(k) * slope(k);
  });
  Refined out;
  if (!(bottom > 0.0)) return out;  // the reference has no effect
  out.squares = 0.0;
  const double part = std::clamp(top / bottom, 0.0, 1.0);
  double meat = 0.0, sum = 0.0;
  int current = -1;
  const auto close = [&] {
    meat += sum * sum;
    sum = 0.0;
  };
  data.visit([&](int k) {
    if (k / block != current) close();
    current = k / block;
    const double r = data.target[at(k)] - data.reference(late, k) - part * slope(k);
    out.squares += r * r;
    sum += r * slope(k);
  });
  close();
  out.late = late + part;
  out.error = std::sqrt(meat) / bottom;
  return out;
}

Explained explained_of(const ActuatorRecord& record, const LoopRecord& loop) {
  const LawModel model(record, loop);
  Explained out;
  out.target = record.motor_torque;
  TickTorque measured = model.of_measurements();
  for (std::size_t k = 0; k < out.target.size(); ++k) out.target[k] -= measured.mean[k];
  out.moment = std::move(measured.moment);
  remove_drift(out.target, record.period);
  for (int late = 0; late < model.steps(); ++late) {
    out.references.push_back(model.of_reference(late));
    remove_drift(out.references.back().mean, record.period);
  }
  const auto ticks = [&](double time) { return static_cast<int>(std::ceil(time / record.period)); };
  out.first = ticks(kSettling) + ticks(kMostDelay) + 2;
  out.usable.assign(out.target.size(), 1);
  for (std::size_t k = 0; k < loop.saturated.size() && k < out.usable.size(); ++k) {
    out.usable[k] = loop.saturated[k] == 0;
  }
  return out;
}

}  // namespace

DelayEstimate identify_delay(const ActuatorRecord& record, const LoopRecord& loop) {
  DelayEstimate out;
  if (record.motor.size() < 2 || !(record.drive_step > 0.0)) return out;
  const Explained data = explained_of(record, loop);
  std::vector<double> motor_torque = record.motor_torque;
  remove_drift(motor_torque, record.period);
  double all = 0.0;
  data.visit([&](int k) { all += motor_torque[at(k)] * motor_torque[at(k)]; });
  if (!(all > 0.0)) return out;
  const int most = static_cast<int>(std::ceil(kMostDelay / record.drive_step));
  int best = 0;
  double least = data.squares(0);
  for (int late = 1; late <= most; ++late) {
    const double squares = data.squares(late);
    if (squares < least) {
      least = squares;
      best = late;
    }
  }
  const int block = static_cast<int>(std::ceil(0.1 / record.period));
  Refined found = refine(data, best, block);
  if (best > 0) {
    const Refined before = refine(data, best - 1, block);
    if (before.squares < found.squares) found = before;
  }
  out.explained = std::max(0.0, 1.0 - found.squares / all);
  out.known = out.explained >= kLeastExplained;
  out.delay = {found.late * record.drive_step, found.error * record.drive_step};
  if (out.known) out.moment = data.moments(found.late);
  return out;
}

}  // namespace footfall::lab
