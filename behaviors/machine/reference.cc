// References of active tasks: start and current values; see control_merge.h.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "behaviors/machine/control_merge.h"
#include "core/index.h"
#include "tasks/task_law.h"

namespace footfall::behaviors {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

// Phase of an ellipse's axis, rad: the second and further axes lag a quarter turn behind the first.
double quarter(const Behavior& behavior, const TaskSpec& spec, int k) noexcept {
  for (int j = 0; j < k; ++j) {
    if (behavior.axes[at(spec.axes.first + j)].radius >= 0) return 0.25 * kTurn;
  }
  return 0.0;
}

}  // namespace

double ControlMerge::position(tasks::TaskType type, int point, int axis) const noexcept {
  return model_ == nullptr ? 0.0 : tasks::measured_position(*model_, type, point, axis);
}

double ControlMerge::velocity(tasks::TaskType type, int point, int axis) const noexcept {
  return model_ == nullptr ? 0.0 : tasks::measured_velocity(*model_, type, point, axis);
}

// In the task's frame: from the mean of the stance contacts, or on the heading's axes.
double ControlMerge::measured(const TaskSpec& spec, const tasks::ControlSet& set,
                              int axis) const noexcept {
  const double world = position(spec.type, spec.point, axis);
  if (spec.frame == tasks::Frame::stance && axis < 3) {
    double origin = 0.0;
    for (int c = 0; c < set.contact_count; ++c) {
      origin +=
          position(tasks::TaskType::point_position, set.contacts[at(c)], axis) / set.contact_count;
    }
    return world - origin;
  }
  if (tasks::info(spec.type).is_rate && axis < 2 && spec.frame == tasks::Frame::heading) {
    const double yaw = position(tasks::TaskType::body_orientation, -1, 2);
    const double x = position(spec.type, spec.point, 0);
    const double y = position(spec.type, spec.point, 1);
    return axis == 0 ? std::cos(yaw) * x + std::sin(yaw) * y
                     : std::cos(yaw) * y - std::sin(yaw) * x;
  }
  return world;
}

// `over`, `at` and `to` are read here, at entry; with a non-finite value the axis keeps its
// position.
void ControlMerge::start_axis(Bank& bank, const tasks::TaskCommand& command, const TaskSpec& spec,
                              int k) noexcept {
  if (spec.reference.kind != ReferenceSpec::Kind::trajectory) return;
  const ReferenceSpec& reference = spec.reference;
  const EvaluationContext& context = statechart_.context();
  const double* entry = &bank.entry[at(command.first_axis)];
  const AxisSpec& axis = behavior_.axes[at(spec.axes.first + k)];
  AxisState& state = bank.axes[at(command.first_axis + k)];
  state.begins = false;
  state.start_tick = state.last_tick = context.tick;
  state.over = value_or(reference.over, 0.0, bank, entry);
  Motion start = state.motion;
  Shape shape = reference.shape;
  switch (shape) {
    case Shape::waypoints:
      start_waypoints(bank, command, spec, k, state.over);
      return;
    case Shape::ellipse: {
      const double period = value_or(reference.period, 0.0, bank, entry);
      state.ramp = value_or(reference.ramp, period, bank, entry);
      if (!(state.ramp > 0.0)) {
        const int ramp = reference.ramp >= 0 ? reference.ramp : reference.period;
        statechart_.report_execution_error(no_time(ramp, state.ramp));
        state.ramp = context.period;
      }
      // Without a goal the centre is the position at entry; an initial velocity decays while the
      // ellipse grows.
      if (reference.over < 0) state.over = state.ramp;
      shape = Shape::minimum_jerk;
      break;
    }
    case Shape::surface: {
      const double speed = velocity(spec.type, spec.point, 0);
      const auto ground = surface_.at(position(spec.type, spec.point, 0));
      start.pos -= ground.height;
      start.vel -= ground.slope * speed;
      start.acc -= ground.curvature * speed * speed;
      shape = reference.over < 0 ? Shape::hold : Shape::minimum_jerk;
      break;
    }
    default:
      break;
  }
  const double to = value_or(axis.value, start.pos, bank, entry);
  const double end = value_or(axis.end_velocity, 0.0, bank, entry);
  state.segment = make_segment(shape, start, to, end, state.over);
}

// The points that name this axis, preceded by the entry. Of two points out of order, the later one
// counts.
void ControlMerge::start_waypoints(Bank& bank, const tasks::TaskCommand& command,
                                   const TaskSpec& spec, int k, double over) noexcept {
  const double* entry = &bank.entry[at(command.first_axis)];
  const AxisSpec& axis = behavior_.axes[at(spec.axes.first + k)];
  AxisState& state = bank.axes[at(command.first_axis + k)];
  state.first_knot = bank.knot_count;
  Knot* knots = bank.knots.data() + state.first_knot;
  knots[0] = {0.0, state.motion.pos, state.motion.vel, state.motion.acc};
  int count = 1;
  double time = 0.0;
  for (int p = 0; p < spec.reference.waypoints.count; ++p) {
    const WaypointSpec& point = behavior_.waypoints[at(spec.reference.waypoints.first + p)];
    const double when = value_or(point.at, point.part * over, bank, entry);
    time = point.after_previous ? time + when : when;
    if (point.to[at(k)] < 0) continue;
    if (!(time > knots[count - 1].time)) {
      const int place = point.at >= 0 ? point.at : spec.reference.over;
      statechart_.report_execution_error({ExecutionProblem::Kind::order, place, time});
      if (count == 1) continue;
      --count;
    }
    knots[count] = {time, value_or(point.to[at(k)], knots[count - 1].pos, bank, entry), 0.0, 0.0};
    ++count;
  }
  if (count == 1) knots[0].vel = 0.0;  // no point names it: keep the position
  if (count > 1) knots[count - 1].vel = value_or(axis.end_velocity, 0.0, bank, entry);
  state.knot_count = count;
  bank.knot_count += count;
  fit_knots({knots, at(count)});
}

void ControlMerge::advance_axis(Bank& bank, const tasks::TaskCommand& command, const TaskSpec& spec,
                                int k, tasks::AxisCommand& out) noexcept {
  const AxisSpec& axis = behavior_.axes[at(spec.axes.first + k)];
  AxisState& state = bank.axes[at(command.first_axis + k)];
  switch (spec.reference.kind) {
    case ReferenceSpec::Kind::none:  // damping: velocity 0
      out.ref = out.ref_vel = out.ref_acc = 0.0;
      return;
    case ReferenceSpec::Kind::value:
      if (!bank.frozen) {
        const double* entry = &bank.entry[at(command.first_axis)];
        state.motion = {value_or(axis.value, state.motion.pos, bank, entry), 0.0, 0.0};
      }
      break;
    case ReferenceSpec::Kind::trajectory:
      if (!bank.frozen) state.motion = sample_axis(bank, command, spec, k, out);
      break;
  }
  out.ref = state.motion.pos;
  out.ref_vel = state.motion.vel;
  out.ref_acc = state.motion.acc;
  if (out.slope != 0.0) {  // of p - slope x: what x brings is not to be asked for twice
    out.ref_vel -= out.slope * velocity(spec.type, spec.point, 0);
  }
}

Motion ControlMerge::sample_axis(Bank& bank, const tasks::TaskCommand& command,
                                 const TaskSpec& spec, int k, tasks::AxisCommand& out) noexcept {
  const EvaluationContext& context = statechart_.context();
  const double* entry = &bank.entry[at(command.first_axis)];
  const AxisSpec& axis = behavior_.axes[at(spec.axes.first + k)];
  AxisState& state = bank.axes[at(command.first_axis + k)];
  const double t = static_cast<double>(context.tick - state.start_tick) * context.period;
  if (spec.reference.shape == Shape::waypoints) {
    const Knot* knots = bank.knots.data() + state.first_knot;
    return sample_knots({knots, at(state.knot_count)}, t);
  }
  Motion motion = sample(state.segment, t);
  if (spec.reference.shape == Shape::ellipse && axis.radius >= 0) {
    const double ticks = static_cast<double>(context.tick - state.last_tick);
    state.angle = std::remainder(state.angle + state.rate * ticks * context.period, kTurn);
    state.last_tick = context.tick;
    const double period = value_or(spec.reference.period, 0.0, bank, entry);
    if (period > 0.0) state.rate = spec.reference.direction * kTurn / period;
    const double angle =
        state.angle - quarter(behavior_, spec, k) + value_or(axis.phase, 0.0, bank, entry);
    const double radius = value_or(axis.radius, 0.0, bank, entry);
    const Motion turn = sample_ellipse(radius, angle, state.rate, state.ramp, t);
    motion = {motion.pos + turn.pos, motion.vel + turn.vel, motion.acc + turn.acc};
  }
  if (spec.reference.shape == Shape::surface) {
    // Chain rule; what f' ẍ would add is in the row itself, which is that of z - f' x.
    const double speed = velocity(spec.type, spec.point, 0);
    const auto ground = surface_.at(position(spec.type, spec.point, 0));
    out.slope = ground.slope;
    motion.pos += ground.height;
    motion.vel += ground.slope * speed;
    motion.acc += ground.curvature * speed * speed;
  }
  return motion;
}

// A changed `to` starts a new segment from the current reference, for the remaining time.
void ControlMerge::retarget(Bank& bank, const TaskSpec& spec,
                            const tasks::TaskCommand& command) noexcept {
  const EvaluationContext& context = statechart_.context();
  const double* entry = &bank.entry[at(command.first_axis)];
  for (int k = 0; k < spec.axes.count; ++k) {
    const AxisSpec& axis = behavior_.axes[at(spec.axes.first + k)];
    AxisState& state = bank.axes[at(command.first_axis + k)];
    if (axis.value < 0 || state.segment.shape == Shape::hold) continue;
    const double to = value_or(axis.value, state.segment.to, bank, entry);
    const double t = static_cast<double>(context.tick - state.start_tick) * context.period;
    const double left = state.segment.duration - t;
    if (to == state.segment.to || left < (1.0 - spec.reference.retarget) * state.over) continue;
    const Shape shape =
        spec.reference.shape == Shape::polynomial3 ? Shape::polynomial3 : Shape::polynomial5;
    const Motion now = sample(state.segment, t);
    state.segment = make_segment(shape, now, to, state.segment.end_velocity, left);
    state.start_tick = context.tick;
  }
}

}  // namespace footfall::behaviors
