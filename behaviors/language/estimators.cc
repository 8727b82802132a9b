// One row an estimator, one a parameter; see estimators.h.
#include "behaviors/language/estimators.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <string>
#include <vector>

#include "behaviors/language/language.h"

namespace footfall::behaviors {
namespace {

using core::kAcceleration;
using core::kForce;
using core::kLength;
using core::kNone;
using core::kRate;
using core::kRateSquared;
using core::kTime;
using core::kVelocity;

// First of every estimator that measures (engine/estimators/measured.h).
constexpr std::array kMeasured = {
    EstimatorParameter{"joint_velocity_filter", kTime, 1e-3, 0.0, 0.1,
                       "time constant of the joint velocities' low-pass; 0: none"},
    EstimatorParameter{
        "encoder_time", kTime, 0.05, 0.0, 10.0,
        "beyond this time a joint's position is its encoder's, below it that of motor "
        "less deflection; 0: always the encoder's"},
    EstimatorParameter{"contact_debounce", kTime, 2e-3, 0.0, 0.1,
                       "a foot switch opens after it has been open this long"},
    EstimatorParameter{"contact_force", kForce, 50.0, 1.0, 1e4,
                       "upward force by measured torques from which on a foot touches; half of it "
                       "when it already does"},
    EstimatorParameter{"anchor_settle", kTime, 0.01, 0.0, 1.0,
                       "from touchdown until a foot counts as keeping its place"},
    EstimatorParameter{"anchor_release", kTime, 0.0, 0.0, 1.0,
                       "a foot that the law has not relied on for longer may slip"},
};

template <std::size_t Count>
constexpr auto measured_and(const std::array<EstimatorParameter, Count>& own) {
  std::array<EstimatorParameter, kMeasured.size() + Count> all{};
  std::copy(kMeasured.begin(), kMeasured.end(), all.begin());
  std::copy(own.begin(), own.end(), all.begin() + kMeasured.size());
  return all;
}

constexpr auto kMotionCapture = measured_and(std::array{
    EstimatorParameter{
        "lambda", kLength, 2.0, 0.01, 1e3,
        "weight of the gyro's prediction: a frame's gain is Z Z^T/(Z Z^T + lambda^2) "
        "with Z the seen markers about their mean"},
    EstimatorParameter{
        "gyro_bias_gain", kRate, 0.3, 0.0, 10.0,
        "integral of the frames' corrections of orientation; 0: none, as in the paper"},
    EstimatorParameter{"oldest_frame", kTime, 0.05, 0.0, 0.08,
                       "frames of motion capture older than this are not used"},
    EstimatorParameter{"position_gain", kRate, 20.0, 0.0, 500.0,
                       "of a frame's position on the position"},
    EstimatorParameter{"velocity_gain", kRateSquared, 100.0, 0.0, 1e4,
                       "of a frame's position on the velocity"},
    EstimatorParameter{"leg_velocity_time", kTime, 0.1, 0.0, 100.0,
                       "time constant from the accelerometer's velocity to that of the feet that "
                       "keep their place; 0: the legs alone"},
    EstimatorParameter{
        "acceleration_gain", kRate, 1.0, 0.0, 20.0,
        "integral of the velocity's corrections: takes out the accelerometer's error; "
        "0: none"},
    EstimatorParameter{"regain_after", kTime, 0.5, 0.05, 1e6,
                       "after a longer time without a frame the next one's place and orientation "
                       "are taken as they are, instead of corrected towards"},
    EstimatorParameter{"marker_gate", kLength, 0.03, 0.0, 10.0,
                       "a marker farther than this from where the others put it is not used; 0: "
                       "all are"},
});
constexpr double kDegree = 0.017453292519943295;
constexpr auto kContactKalman = measured_and(std::array{
    EstimatorParameter{"gyro_noise", kRate, 0.01, 1e-6, 10.0, "white noise of a sample of a tick"},
    EstimatorParameter{"accelerometer_noise", kAcceleration, 0.08, 1e-5, 100.0,
                       "white noise of a sample of a tick, with what shakes the base in between"},
    EstimatorParameter{"gyro_bias_walk", kRate, 2e-5, 0.0, 1.0,
                       "what the gyro's bias wanders in 1 s"},
    EstimatorParameter{"accelerometer_bias_walk", kAcceleration, 1e-4, 0.0, 10.0,
                       "what the accelerometer's bias wanders in 1 s"},
    EstimatorParameter{"foot_noise", kLength, 0.3e-3, 1e-6, 1.0, "of a foot's place by the joints"},
    EstimatorParameter{"foot_slip", kLength, 0.3e-3, 0.0, 10.0,
                       "what a foot on the ground wanders in 1 s"},
    EstimatorParameter{"slip_gate", kNone, 6.0, 0.0, 100.0,
                       "a foot farther off than this many standard deviations has slipped and is "
                       "taken from where it is; 0: none has"},
    EstimatorParameter{"ground_noise", kLength, 0.0, 0.0, 1.0,
                       "a foot that lands is at height 0 with this standard deviation; 0: the "
                       "ground's height is unknown"},
    EstimatorParameter{"start_attitude", kNone, 0.01, 1e-6, 1.0,
                       "standard deviation at the start, rad, of roll and pitch by one sample of "
                       "the accelerometer",
                       true},
    EstimatorParameter{"start_velocity", kVelocity, 0.05, 1e-6, 10.0,
                       "standard deviation at the start", true},
    EstimatorParameter{"start_gyro_bias", kRate, 0.5 * kDegree, 0.0, 1.0,
                       "standard deviation at the start", true},
    EstimatorParameter{"start_accelerometer_bias", kAcceleration, 0.03, 0.0, 10.0,
                       "standard deviation at the start", true},
    EstimatorParameter{"lost_after", kTime, 2.0, 0.0, 1e6,
                       "after a longer time without a foot that keeps its place there is no "
                       "estimate (`no_estimate`); 0: there always is"},
});
constexpr std::array kTypes = {
    EstimatorInfo{"true_state", "the simulator's own state", false, false, false, {}},
    EstimatorInfo{"motion_capture", "IMU, motion capture and leg kinematics", true, true, true,
                  kMotionCapture},
    EstimatorInfo{"contact_kalman", "IMU, leg kinematics and contacts, no motion capture", true,
                  false, true, kContactKalman},
};

constexpr auto kEstimatorTypeRows = [] {
  std::array<core::WordSpec, kTypes.size()> words{};
  for (std::size_t k = 0; k < words.size(); ++k) words[k] = {kTypes[k].name, kTypes[k].doc};
  return words;
}();

// In the order of ContactSource.
constexpr core::WordSpec kContactSourceRows[] = {
    {"switch", "the feet's switches"},
    {"torque", "the joint torques of the foot's leg"},
    {"both", "switch and torques together"},
};

std::string with_unit(double value, core::Dimension dimension) {
  const std::string unit = core::unit_text(dimension);
  return fmt::format("{:g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string joined(const std::string& before, std::string_view separator, std::string_view more) {
  return before.empty() ? std::string(more) : fmt::format("{}{}{}", before, separator, more);
}

// The keys of `estimator:` with the texts that they point to.
class EstimatorKeyRows {
 public:
  EstimatorKeyRows() {
    std::string with_contacts;
    for (const EstimatorInfo& type : kTypes) {
      if (type.needs_contacts) with_contacts = joined(with_contacts, " ", type.name);
    }
    rows_.push_back(core::key("type", core::choice(kEstimatorTypeRows), "which estimator runs")
                        .otherwise("true_state"));
    rows_.push_back(core::key("contact", core::choice(kContactSourceRows),
                              "what tells that a foot touches the ground")
                        .otherwise("switch")
                        .only(keep(with_contacts)));
    for (const EstimatorInfo& type : kTypes) {
      for (const EstimatorParameter& parameter : type.parameters) add(parameter);
    }
  }
  std::span<const core::KeySpec> rows() const { return rows_; }

 private:
  std::string_view keep(std::string text) { return texts_.emplace_back(std::move(text)); }

  // One row for a name, also if several types have it.
  void add(const EstimatorParameter& parameter) {
    for (const core::KeySpec& row : rows_) {
      if (row.name == parameter.name) return;
    }
    std::string types, values, bounds;
    bool same = true;
    for (const EstimatorInfo& type : kTypes) {
      const EstimatorParameter* const own = type.find(parameter.name);
      if (own == nullptr) continue;
      types = joined(types, " ", type.name);
      const std::string value = with_unit(own->value, own->dimension);
      const std::string range = fmt::format("{} to {}", with_unit(own->least, own->dimension),
                                            with_unit(own->most, own->dimension));
      same = same && own->value == parameter.value && own->least == parameter.least &&
             own->most == parameter.most;
      values = joined(values, ", ", fmt::format("{} ({})", value, type.name));
      bounds = joined(bounds, ", ", fmt::format("{} ({})", range, type.name));
    }
    if (same) {
      values = with_unit(parameter.value, parameter.dimension);
      bounds = fmt::format("{} to {}", with_unit(parameter.least, parameter.dimension),
                           with_unit(parameter.most, parameter.dimension));
    }
    rows_.push_back(core::key(parameter.name, core::quantity(parameter.dimension),
                              keep(fmt::format("{}; {}", parameter.doc, bounds)))
                        .otherwise(keep(values))
                        .only(keep(types)));
  }

  std::deque<std::string> texts_;  // stable addresses
  std::vector<core::KeySpec> rows_;
};

std::span<const core::KeySpec> estimator_key_rows() {
  static const EstimatorKeyRows rows;
  return rows.rows();
}

}  // namespace

std::span<const EstimatorInfo> estimator_types() { return kTypes; }

const EstimatorParameter* EstimatorInfo::find(std::string_view parameter) const {
  for (const EstimatorParameter& own : parameters) {
    if (own.name == parameter) return &own;
  }
  return nullptr;
}

// Not a constant of the compiler: texts of its rows are made from the table above.
const core::KeyTable kEstimatorKeys = {
    .id = "estimator",
    .doc =
        "Which estimator runs, and its parameters. They are live within their bounds, as "
        "`estimator.NAME`, but for the `start_...`: an estimator takes those when it starts.",
    .keys = estimator_key_rows(),
    .part = true,
    .selector = "type",
    .variants = kEstimatorTypeRows};
constinit const std::span<const core::WordSpec> kEstimatorTypes = kEstimatorTypeRows;
constinit const std::span<const core::WordSpec> kContactSources = kContactSourceRows;

}  // namespace footfall::behaviors
