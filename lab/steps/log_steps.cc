// Samples for the step table from a log's inputs and rows; see log_steps.h.
#include "lab/steps/log_steps.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "engine/estimators/truth.h"
#include "lab/figures/log_figures.h"
#include "lab/log/attached_files.h"
#include "lab/run/log_setup.h"
#include "lab/steps/step_signals.h"
#include "model/control_model.h"

namespace footfall::lab {
namespace {

constexpr double kLoadedShare = 0.1;  // of the weight, from which on a foot is loaded

// Rotates by base axes; z of the result, which needs only the last row of R.
double upward(const std::array<double, 9>& R, const std::array<double, 3>& v) {
  return R[6] * v[0] + R[7] * v[1] + R[8] * v[2];
}

}  // namespace

// Of one log: its columns, and the row in force.
class LogSampler {
 public:
  LogSampler(const Log& log, const model::RobotDescription& robot, model::ControlModel& model)
      : log_(log),
        robot_(robot),
        model_(model),
        layout_(log.inputs.names),
        signals_(log, robot),
        limits_(robot.torque_limits()) {
    if (layout_.names() != log.inputs.columns) {
      throw std::runtime_error("the log's inputs are not of this program's kind");
    }
  }

  StepSample sample(std::int64_t tick) {
    hal::Commands commands;
    layout_.unpack(log_.inputs.row(tick), sensors_, commands);
    while (row_ + 1 < log_.rows() && log_.tick[row_ + 1] <= tick) ++row_;
    StepSample out;
    out.time = static_cast<double>(tick) * 1e3 / static_cast<double>(log_.rate_mhz);
    truth_ = truth_ || sensors_.has_truth;
    model_.update(sensors_.has_truth ? engine::true_state(sensors_) : signals_.state(row_));
    body(out);
    feet(out);
    signals_.plan(row_, out);
    out.saturated = sensors_.motor_saturated;
    for (std::size_t j = 0; j < limits_.size(); ++j) {
      // A clamped command is the limit itself, a hold's torque may be beyond it.
      out.saturated = out.saturated || std::abs(commands.tau[j]) >= limits_[j];
    }
    return out;
  }
  bool truth() const { return truth_; }

 private:
  void body(StepSample& out) {
    const auto& rpy = model_.rpy();
    const auto reference = signals_.attitude(row_);
    out.yaw = rpy[2];
    out.yaw_rate = upward(model_.R_WB(), model_.state().w_WB_B);
    out.tilt = std::hypot(rpy[0] - reference[0], rpy[1] - reference[1]);
    // The robot's file has not what a world or a seed changed in the masses.
    const auto& velocity =
        sensors_.sensor_truth ? sensors_.true_com_velocity : model_.com().velocity;
    out.com_velocity = {velocity[0], velocity[1]};
  }

  void feet(StepSample& out) {
    for (std::size_t c = 0; c < robot_.contacts.size(); ++c) {
      const auto& point = model_.point(static_cast<int>(c));
      out.foot[c].force = sensors_.force[c];
      out.foot[c].position = point.position;
      out.foot[c].velocity = point.velocity;
    }
  }

  const Log& log_;
  const model::RobotDescription& robot_;
  model::ControlModel& model_;
  engine::InputLayout layout_;
  StepSignals signals_;
  std::vector<double> limits_;
  hal::Sensors sensors_;
  std::size_t row_ = 0;
  bool truth_ = false;
};

struct LogSteps::Table {
  model::RobotDescription robot;
  std::unique_ptr<model::ControlModel> model;
  std::optional<StepTable> steps;
  bool truth = false;

  void begin(const Log& log) {
    const LogFolder folder(log);  // both files are read here
    core::Diagnostics diagnostics;
    robot = model::load_robot(folder.place_of(read_setup(log.setup).robot_file), diagnostics);
    if (diagnostics.has_errors()) throw std::runtime_error(diagnostics.to_string());
    model = std::make_unique<model::ControlModel>(robot);
    const double weight = model->mass() * model->gravity();
    steps.emplace(static_cast<int>(robot.contacts.size()), kLoadedShare * weight);
  }
};

LogSteps::LogSteps() : table_(std::make_unique<Table>()) {}
LogSteps::~LogSteps() = default;

void LogSteps::add(const Log& log) {
  if (log.inputs.ticks() == 0 || log.setup.empty() || log.rows() == 0) return;
  Table& table = *table_;
  if (!table.steps) table.begin(log);  // a reload changes the behavior, not the robot
  LogSampler sampler(log, table.robot, *table.model);
  const std::int64_t end = log.inputs.first_tick + log.inputs.ticks();
  for (std::int64_t tick = std::max<std::int64_t>(log.inputs.first_tick, 0); tick < end; ++tick) {
    table.steps->observe(sampler.sample(tick));
  }
  table.truth = sampler.truth();
}

RunSteps LogSteps::steps() const {
  RunSteps out;
  if (!table_->steps) return out;
  for (const auto& contact : table_->robot.contacts) out.feet.push_back(contact.name);
  out.rows = table_->steps->rows();
  out.truth = table_->truth;
  return out;
}

RunSteps log_steps(const Log& log) {
  LogSteps steps;
  steps.add(log);
  return steps.steps();
}

}  // namespace footfall::lab
