// The estimator's own small loop over logged sensors; see estimation.h.
#include "lab/replay/estimation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>

#include "behaviors/language/estimators.h"
#include "behaviors/loader.h"
#include "engine/estimators/truth.h"
#include "engine/tick/input_row.h"
#include "engine/watch/sensing.h"
#include "lab/log/attached_files.h"
#include "lab/run/log_setup.h"

namespace footfall::lab {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// The robot of the log and the estimator's section, loaded and checked like any behavior.
std::unique_ptr<behaviors::Behavior> load_trial(const Log& log, const RunSetup& setup,
                                                const LogFolder& folder,
                                                const EstimatorTrial& trial) {
  behaviors::LoadOptions options;
  options.search = folder.search();
  options.robot = folder.place_of(setup.robot_file);
  options.world = actuators_of(setup);
  if (log.get("estimator") == trial.estimator) {
    for (const LoggedParameter& p : log.parameters) {
      if (!p.name.starts_with("estimator.")) continue;
      const double value = log.parameter_values[static_cast<std::size_t>(p.slot)];
      options.set.emplace_back(p.name, fmt::format("{}", value));
    }
  }
  for (const auto& [name, value] : trial.set) {
    if (!name.starts_with("estimator.")) {
      throw std::runtime_error(
          fmt::format("--set {}: error: only the estimator runs: estimator.NAME", name));
    }
    std::erase_if(options.set, [&](const auto& other) { return other.first == name; });
    options.set.emplace_back(name, value);
  }
  core::Diagnostics diagnostics;
  auto behavior = behaviors::load_behavior_text(
      fmt::format("behavior: 1\nestimator: {{type: {}}}\nmachine: {{}}\n", trial.estimator),
      "--estimator", options, diagnostics);
  if (behavior == nullptr) throw std::runtime_error(diagnostics.to_string());
  return behavior;
}

void require_columns(const Log& log, const behaviors::EstimatorInfo& info) {
  if (log.inputs.ticks() == 0) {
    throw std::runtime_error(fmt::format("the log '{}' has no inputs to replay", log.path));
  }
  if (info.needs_mocap && log.inputs.names.markers.empty()) {
    throw std::runtime_error(
        fmt::format("the log '{}' has no markers, which the estimator {} needs: run it in a world "
                    "whose sensors have errors, or with an estimator",
                    log.path, info.name));
  }
  if (log.inputs.first_tick > 0) {
    throw std::runtime_error(fmt::format(
        "the log '{}' goes on from another: an estimator starts at the beginning of a run",
        log.path));
  }
}

// Contacts of the law in force in each logged row, as bits; between rows the last one holds.
class LoggedSupport {
 public:
  LoggedSupport(const Log& log, const model::RobotDescription& robot) : log_(log) {
    for (const auto& contact : robot.contacts) {
      columns_.push_back(log.values("support." + contact.name));
    }
  }
  // Before `tick`: the law's contacts are told at the end of a tick.
  std::uint64_t before(std::int64_t tick) {
    while (row_ < log_.rows() && log_.tick[row_] < tick) ++row_;
    if (row_ == 0) return 0;
    std::uint64_t bits = 0;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const bool on = columns_[c] != nullptr && (*columns_[c])[row_ - 1] > 0.5F;
      bits |= std::uint64_t{on} << c;
    }
    return bits;
  }

 private:
  const Log& log_;
  std::vector<const std::vector<float>*> columns_;
  std::size_t row_ = 0;
};

double norm_between(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Between two orientations, rad.
double angle_between(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  double dot = 0.0, cross = 0.0;
  for (std::size_t k = 0; k < 4; ++k) dot += a[k] * b[k];
  for (std::size_t k = 0; k < 4; ++k) {
    const double rest = a[k] - dot * b[k];
    cross += rest * rest;
  }
  return 2.0 * std::atan2(std::sqrt(cross), std::abs(dot));
}

// One run of the estimator.
class EstimatorRun {
 public:
  EstimatorRun(const Log& log, const RunSetup& setup, const behaviors::Behavior& behavior,
               double from)
      : log_(log),
        behavior_(behavior),
        model_(behavior.robot, setup.settings.deviation),
        truth_(behavior.robot, setup.settings.deviation),
        sensing_(behavior, model_),
        support_(log, behavior.robot),
        layout_(log.inputs.names) {
    if (layout_.names() != log.inputs.columns) {
      throw std::runtime_error("the log's inputs are not of this program's kind");
    }
    for (const LoggedPlan& plan : log.plans) plans_.insert(plan.tick);
    figures_.from = from;
    figures_.markers.assign(core::kMaxMarkers + 1, 0.0);
  }

  EstimationFigures run() {
    const auto rate = static_cast<double>(log_.rate_mhz);
    const std::int64_t end = log_.inputs.first_tick + log_.inputs.ticks();
    for (std::int64_t tick = log_.inputs.first_tick; tick < end; ++tick) {
      hal::Commands commands;
      const bool fresh = layout_.unpack(log_.inputs.row(tick), sensors_, commands);
      const bool estimated = step(tick, fresh, commands);
      if (estimated && !start_) start_.emplace(estimate_.state, engine::true_state(sensors_));
      const double time = static_cast<double>(std::max<std::int64_t>(tick, 0)) * 1e3 / rate;
      if (time < figures_.from) continue;
      if (!estimated) ++figures_.without;
      if (estimated && sensors_.has_truth) compare(tick);
      figures_.to = time;
    }
    finish();
    return figures_;
  }

 private:
  bool step(std::int64_t tick, bool fresh, const hal::Commands& commands) {
    if (tick == log_.inputs.first_tick) {
      std::copy_n(sensors_.q.begin(), model_.joint_count(), estimate_.state.q.begin());
      model_.update(estimate_.state);
    }
    // A run's start looks at the sensors once before the first tick.
    const std::uint64_t support = support_.before(tick);
    const bool estimated =
        tick < 0 ? sensing_.start(sensors_, model_, support, behavior_.values, estimate_)
                 : sensing_.step(sensors_, fresh, model_, support, behavior_.values, estimate_)
                       .estimated;
    sensing_.commanded(commands);
    if (estimated) model_.update(estimate_.state);
    return estimated;
  }

  void compare(std::int64_t tick) {
    ++figures_.ticks;
    const model::State& state = estimate_.state;
    const auto rpy = engine::rpy_of(state.q_WB), true_rpy = engine::rpy_of(sensors_.q_WB);
    std::array<double, 3> com_velocity = sensors_.true_com_velocity;
    if (!sensors_.sensor_truth) {
      truth_.update(engine::true_state(sensors_));
      com_velocity = truth_.com().velocity;
    }
    const bool planned = plans_.contains(tick);
    for (std::size_t k = 0; k < 3; ++k) {
      figures_.rpy[k].add(std::remainder(rpy[k] - true_rpy[k], 2.0 * std::numbers::pi));
      figures_.position[k].add(state.p_WB[k] - sensors_.p_WB[k]);
      figures_.velocity[k].add(state.v_WB[k] - sensors_.v_WB[k]);
      const double error = model_.com().velocity[k] - com_velocity[k];
      figures_.com_velocity[k].add(error);
      if (planned) figures_.com_velocity_at_plans[k].add(error);
    }
    figures_.rotation.add(angle_between(state.q_WB, sensors_.q_WB));
    engine::ErrorCovariance covariance;
    if (sensing_.estimator().covariance(covariance)) {
      const model::State truth = engine::true_state(sensors_);
      const NormalisedError error = normalised_error(state, truth, covariance);
      figures_.nees.add(error.all);
      figures_.nees_tilt.add(error.tilt);
      figures_.nees_velocity.add(error.velocity);
      figures_.nees_place.add(start_->normalised_place(state, truth, covariance));
    }
    const double heading = estimate_.quality.attitude[2];
    if (figures_.ticks == 1) figures_.heading_deviation[0] = heading;
    figures_.heading_deviation[1] = heading;
    const int markers = std::clamp(estimate_.quality.markers, 0, core::kMaxMarkers);
    figures_.markers[static_cast<std::size_t>(markers)] += 1.0;
  }

  void finish() {
    const double end = static_cast<double>(log_.inputs.first_tick + log_.inputs.ticks() - 1) /
                       behavior_.robot.rate_hz();
    if (figures_.ticks == 0 && end < figures_.from) {
      throw std::runtime_error(
          fmt::format("the log '{}' ends at {:.3f} s: nothing to compare from {:g} s on", log_.path,
                      end, figures_.from));
    }
    if (figures_.ticks == 0) {
      throw std::runtime_error(
          fmt::format("the log '{}' has no truth to compare with from {:g} s on: only a simulator "
                      "tells it",
                      log_.path, figures_.from));
    }
    for (double& share : figures_.markers) share /= static_cast<double>(figures_.ticks);
    while (figures_.markers.size() > 1 && figures_.markers.back() == 0.0) {
      figures_.markers.pop_back();
    }
    const engine::EstimateQuality& quality = estimate_.quality;
    // One that reads no IMU estimates nothing of it, nor judges itself.
    const bool judges = behaviors::estimator_info(behavior_.estimator.type).needs_imu;
    const bool known = judges && sensors_.sensor_truth;
    if (!judges) figures_.heading_deviation = {kUnknown, kUnknown};
    figures_.gyro_bias =
        known ? norm_between(quality.gyro_bias, sensors_.true_gyro_bias) : kUnknown;
    for (std::size_t k = 0; k < 3; ++k) {
      figures_.gyro_bias_error[k] =
          known ? quality.gyro_bias[k] - sensors_.true_gyro_bias[k] : kUnknown;
    }
    figures_.accelerometer_bias =
        known ? norm_between(quality.accelerometer_bias, sensors_.true_accelerometer_bias)
              : kUnknown;
  }

  const Log& log_;
  const behaviors::Behavior& behavior_;
  model::ControlModel model_, truth_;
  engine::Sensing sensing_;
  LoggedSupport support_;
  engine::InputLayout layout_;
  std::set<std::int64_t> plans_;
  hal::Sensors sensors_;
  engine::Estimate estimate_;
  std::optional<StartFrame> start_;
  EstimationFigures figures_;
};

nlohmann::ordered_json estimation_error_json(const ErrorFigure& figure) {
  if (figure.count == 0) return {};
  return {{"rms", figure.rms()}, {"max", figure.max}};
}

nlohmann::ordered_json estimation_axes_json(const std::array<ErrorFigure, 3>& figures,
                                            const std::array<const char*, 3>& names) {
  nlohmann::ordered_json out;
  for (std::size_t k = 0; k < 3; ++k) out[names[k]] = estimation_error_json(figures[k]);
  return out;
}

constexpr std::array<const char*, 3> kXyzNames = {"x", "y", "z"};
constexpr std::array<const char*, 3> kRpyNames = {"roll", "pitch", "yaw"};

std::string estimation_line(const std::string& name, const ErrorFigure& figure, double factor,
                            std::string_view unit) {
  if (figure.count == 0) return "";
  return fmt::format("  {:22} {:10.4f} {:10.4f} {}\n", name, figure.rms() * factor,
                     figure.max * factor, unit);
}

}  // namespace

EstimationFigures replay_estimator(const Log& log, const EstimatorTrial& trial) {
  const LogFolder folder(log);
  const RunSetup setup = read_setup(log.setup);
  const auto behavior = load_trial(log, setup, folder, trial);
  require_columns(log, behaviors::estimator_info(behavior->estimator.type));
  EstimationFigures figures = EstimatorRun(log, setup, *behavior, trial.from).run();
  figures.estimator = behaviors::estimator_info(behavior->estimator.type).name;
  return figures;
}

nlohmann::ordered_json estimation_json(const EstimationFigures& f) {
  const auto or_null = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
  };
  nlohmann::ordered_json out;
  out["estimator"] = f.estimator;
  out["from_s"] = f.from;
  out["to_s"] = f.to;
  out["ticks"] = f.ticks;
  out["without_state"] = f.without;
  out["orientation_rad"] = estimation_axes_json(f.rpy, kRpyNames);
  out["orientation_rad"]["norm"] = estimation_error_json(f.rotation);
  out["position_m"] = estimation_axes_json(f.position, kXyzNames);
  out["velocity_mps"] = estimation_axes_json(f.velocity, kXyzNames);
  out["com_velocity_mps"] = estimation_axes_json(f.com_velocity, kXyzNames);
  out["com_velocity_at_plans_mps"] = estimation_axes_json(f.com_velocity_at_plans, kXyzNames);
  out["plans"] = f.com_velocity_at_plans[0].count;
  out["gyro_bias_radps"] = or_null(f.gyro_bias);
  for (std::size_t k = 0; k < 3; ++k) {
    out["gyro_bias_error_radps"][kXyzNames[k]] = or_null(f.gyro_bias_error[k]);
  }
  out["heading_deviation_rad"] = {{"from", or_null(f.heading_deviation[0])},
                                  {"to", or_null(f.heading_deviation[1])}};
  out["accelerometer_bias_mps2"] = or_null(f.accelerometer_bias);
  out["nees"] = nullptr;
  if (f.nees.count > 0) {
    out["nees"] = {{"mean", or_null(f.nees.mean())},
                   {"dimension", kNeesDimension},
                   {"tilt", {{"mean", or_null(f.nees_tilt.mean())}, {"dimension", 2}}},
                   {"velocity", {{"mean", or_null(f.nees_velocity.mean())}, {"dimension", 3}}},
                   {"place", {{"mean", or_null(f.nees_place.mean())}, {"dimension", 2}}}};
  }
  out["markers"] = f.markers;
  return out;
}

std::string estimation_text(const EstimationFigures& f) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  std::string text = fmt::format("{}, {} ticks from {:g} s to {:.3f} s; estimate minus truth:\n",
                                 f.estimator, f.ticks, f.from, f.to);
  if (f.without > 0) text += fmt::format("  NO STATE in {} ticks\n", f.without);
  text += fmt::format("  {:22} {:>10} {:>10}\n", "", "rms", "largest");
  for (std::size_t k = 0; k < 3; ++k)
    text += estimation_line(kRpyNames[k], f.rpy[k], kDegrees, "deg");
  text += estimation_line("orientation", f.rotation, kDegrees, "deg");
  const auto axes = [&](const std::string& name, const auto& figures, std::string_view unit) {
    for (std::size_t k = 0; k < 3; ++k) {
      text += estimation_line(fmt::format("{} {}", name, kXyzNames[k]), figures[k], 1e3, unit);
    }
  };
  axes("position", f.position, "mm");
  axes("velocity", f.velocity, "mm/s");
  axes("CoM velocity", f.com_velocity, "mm/s");
  axes("CoM velocity at plans", f.com_velocity_at_plans, "mm/s");
  if (std::isfinite(f.gyro_bias)) {
    text += fmt::format("  gyro bias, at the end  {:10.5f} rad/s\n", f.gyro_bias);
  }
  if (std::isfinite(f.accelerometer_bias)) {
    text += fmt::format("  acc. bias, at the end  {:10.5f} m/s^2\n", f.accelerometer_bias);
  }
  if (f.nees.count > 0) {
    text +=
        fmt::format("  NEES, mean             {:10.3f} of roll, pitch and velocity: {} expected\n",
                    f.nees.mean(), kNeesDimension);
    text += fmt::format(
        "                         {:10.3f} of roll and pitch: 2 expected\n"
        "                         {:10.3f} of velocity: 3 expected\n"
        "                         {:10.3f} of the place on the ground: 2 expected\n",
        f.nees_tilt.mean(), f.nees_velocity.mean(), f.nees_place.mean());
  }
  if (f.markers.size() > 1) {
    for (std::size_t n = 0; n < f.markers.size(); ++n) {
      if (f.markers[n] == 0.0) continue;
      text += fmt::format("  {} markers              {:10.2f} %\n", n, 100.0 * f.markers[n]);
    }
  }
  return text;
}

}  // namespace footfall::lab
