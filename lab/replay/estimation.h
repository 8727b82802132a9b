// An estimator alone over a log's sensors, compared with the truth that the log has.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "lab/figures/metrics.h"
#include "lab/log/reader.h"
#include "lab/replay/consistency.h"

namespace footfall::lab {

struct EstimatorTrial {
  std::string estimator;                                 // name of its type
  std::vector<std::pair<std::string, std::string>> set;  // `estimator.KEY`, value
  double from = 2.0;                                     // s, what is earlier does not count
};

// Errors are estimate minus truth, SI, world axes.
struct EstimationFigures {
  std::string estimator;
  double from = 0.0, to = 0.0;                       // s
  std::int64_t ticks = 0;                            // compared
  std::int64_t without = 0;                          // ticks in which it gave no state
  std::array<ErrorFigure, 3> rpy;                    // rad
  ErrorFigure rotation;                              // rad, angle between the two
  std::array<ErrorFigure, 3> position, velocity;     // m, m/s, of the base
  std::array<ErrorFigure, 3> com_velocity;           // m/s, over all ticks
  std::array<ErrorFigure, 3> com_velocity_at_plans;  // where a planner's answer came
  // At the end; NaN: not estimated, or the truth is not known.
  double gyro_bias = 0.0;                     // rad/s, norm
  std::array<double, 3> gyro_bias_error{};    // rad/s, IMU frame
  std::array<double, 2> heading_deviation{};  // rad, by the estimator, of the first and last tick
  double accelerometer_bias = 0.0;            // m/s^2, norm
  // Of roll, pitch and velocity together and apart, and of the horizontal place. None: the
  // estimator has no covariance.
  NeesFigure nees, nees_tilt, nees_velocity, nees_place;
  std::vector<double> markers;  // share of the ticks in which it used 0, 1, ... markers
};

// log: read with all_rows and inputs, of one behavior. The estimator starts as in a run. Parameters
// that are not set are those of the log at its start if its estimator is of the same type, else the
// defaults. The support is that of the logged law (the signals `support.*`). The model is the
// log's, with its deviation. Throws std::runtime_error with one clear sentence if the log lacks
// what the estimator or the comparison needs, or with the messages of what is set.
EstimationFigures replay_estimator(const Log& log, const EstimatorTrial& trial);

nlohmann::ordered_json estimation_json(const EstimationFigures& figures);
std::string estimation_text(const EstimationFigures& figures);

}  // namespace footfall::lab
