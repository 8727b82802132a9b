// The filter fed from sensors; see contact_kalman.h.
#include "engine/estimators/contact_kalman.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/index.h"
#include "engine/estimators/parts/invariant_filter.h"

namespace footfall::engine {
namespace {

namespace kalman = contact_kalman_parameter;
using Parameters = std::span<const double>;

// The rotation with yaw 0 that turns a measured specific force (base axes) upward.
Matrix3d level(const Vector3d& force) noexcept {
  if (!(force.squaredNorm() > 1.0)) return Matrix3d::Identity();  // nothing holds the base
  const Vector3d up = force.normalized();  // world z in base axes: last row of R
  const double roll = std::atan2(up[1], up[2]);
  const double pitch = std::atan2(-up[0], std::hypot(up[1], up[2]));
  return rotation_exp(Vector3d(0.0, pitch, 0.0)) * rotation_exp(Vector3d(roll, 0.0, 0.0));
}

template <int Feet>
class ContactKalman final : public Estimator {
 public:
  ContactKalman(const behaviors::EstimatorSpec& spec, const model::RobotDescription& robot,
                const model::ControlModel& model)
      : measured_(spec, robot, model), gravity_(model.gravity()) {}
  bool estimate(const EstimatorInput& input, Estimate& estimate) noexcept override;
  bool covariance(ErrorCovariance& covariance) const noexcept override;
  void take_over(const Estimator& old, const Estimate& last) noexcept override;

 private:
  using Filter = InvariantFilter<Feet>;
  struct Memory {
    Filter filter;
    std::int64_t ticks = 0;
    bool started = false;
    bool spread = false;      // the covariance has its start
    double gyro_noise = 0.0;  // rad/s, for covariance()
    // Place of the filter's world, which follows the base, in that of the estimate, horizontal, m.
    Vector3d origin = Vector3d::Zero();
    double without_feet = 0.0;  // s since a foot last kept its place
  };

  void start(const EstimatorInput& input, const Estimate& measured) noexcept;
  void spread(Parameters p) noexcept;
  void follow_feet(const model::ControlModel& model, Parameters p) noexcept;
  double correct(Parameters p) noexcept;
  void write(Estimate& estimate) const noexcept;
  void place_deviation(EstimateQuality& quality) const noexcept;
  Vector3d h(const Anchor& a) const noexcept { return a.foot.contact - measured_.imu(); }

  Measured measured_;
  double gravity_;
  Memory memory_;
};

// What the believed ground lifts a foot's ball above its place on the plane, m, with the base's
// origin above the world's. Before the first estimate the model is anywhere: its normal is not
// where the foot will be.
double terrain_below(const model::ControlModel& model, int contact, const Matrix3d& R) noexcept {
  const Matrix3d R_BW = matrix_of(model.R_WB()).transpose();
  const double radius = model.contact_radius(contact);
  const Vector3d n = vector_of(model.contact_normal(contact));
  const Vector3d ball = vector_of(model.point_position(contact)) + radius * n;
  const Vector3d place = R * (R_BW * (ball - vector_of(model.state().p_WB)));
  const double level = (R * (R_BW * (radius * (Vector3d::UnitZ() - n))))[2];
  return model.terrain().rest_height(place[0], place[1], radius) - radius - level;
}

// Level by the first measured force; the base's origin above the world's, the touching feet (or
// else all) on the believed ground. What the base's acceleration makes wrong, the filter corrects
// by its feet.
template <int Feet>
void ContactKalman<Feet>::start(const EstimatorInput& input, const Estimate& measured) noexcept {
  const Vector3d rate = measured_.gyro();
  const Matrix3d R = level(measured_.accelerometer());
  const bool touches = std::any_of(measured.contact.begin(), measured.contact.end(),
                                   [](bool contact) { return contact; });
  double height = 0.0;
  int count = 0;
  for (int c = 0; c < input.model.contact_count(); ++c) {
    if (touches && !measured.contact[at(c)]) continue;
    height -= (R * foot_kinematics(input.model, c, measured.state).contact)[2];
    height += terrain_below(input.model, c, R);
    ++count;
  }
  const Vector3d p(0.0, 0.0, height / std::max(count, 1));
  const Vector3d v = measured_.leg_velocity(rate) + rate.cross(measured_.imu());
  memory_.filter.start(R, R * v, p + R * measured_.imu());
  spread(input.parameters);
  memory_.started = true;
}

template <int Feet>
void ContactKalman<Feet>::spread(Parameters p) noexcept {
  Filter& f = memory_.filter;
  const Vector3d one = Vector3d::Ones();
  f.set_deviation(Filter::kGyroBias, p[kalman::start_gyro_bias] * one);
  f.set_deviation(Filter::kAccelerometerBias, p[kalman::start_accelerometer_bias] * one);
  const double tilt = p[kalman::start_attitude];
  f.set_deviation(Filter::kR, Vector3d(tilt, tilt, 0.0));
  f.set_deviation(Filter::kV, p[kalman::start_velocity] * one);
  f.tie_place(f.p() - f.R() * measured_.imu());
  memory_.spread = true;
}

// Feet that have become anchors are taken in where they are, others let go; those that stay roll:
// a ball's contact point moves with its centre, at w x r n on ground with the normal n.
template <int Feet>
void ContactKalman<Feet>::follow_feet(const model::ControlModel& model, Parameters p) noexcept {
  Filter& f = memory_.filter;
  std::array<const Anchor*, Feet> held{};
  for (const Anchor& a : measured_.anchors()) {
    if (a.contact < Feet) held[at(a.contact)] = &a;
  }
  for (int i = 0; i < Feet; ++i) {
    const Anchor* anchor = held[at(i)];
    if (anchor == nullptr) {
      if (f.has_foot(i)) f.drop_foot(i);
    } else if (!f.has_foot(i)) {
      memory_.origin += f.anchor();
      f.add_foot(i, h(*anchor), p[kalman::foot_noise]);
      if (p[kalman::ground_noise] > 0.0) {
        const std::array<double, 3>& point = model.point_position(i);
        f.correct_height(i, model.terrain().rest_height(point[0], point[1], 0.0),
                         p[kalman::ground_noise]);
      }
    } else {
      const Vector3d spin = f.R() * anchor->foot.spin;
      const Vector3d n = vector_of(model.contact_normal(i));
      f.move_foot(i, measured_.period() * model.contact_radius(i) * spin.cross(n));
    }
  }
}

// The largest innovation, m.
template <int Feet>
double ContactKalman<Feet>::correct(Parameters p) noexcept {
  Filter& f = memory_.filter;
  double largest = 0.0;
  for (const Anchor& a : measured_.anchors()) {
    if (a.contact >= Feet || !f.has_foot(a.contact)) continue;
    const double innovation =
        f.correct_by_foot(a.contact, h(a), p[kalman::foot_noise], p[kalman::slip_gate]);
    if (innovation < 0.0) f.add_foot(a.contact, h(a), p[kalman::foot_noise]);
    largest = std::max(largest, std::abs(innovation));
  }
  return largest;
}

// The mean goes on in every tick. The covariance does in every second one and the feet correct in
// those between, so that no tick has both to do.
template <int Feet>
bool ContactKalman<Feet>::estimate(const EstimatorInput& input, Estimate& estimate) noexcept {
  const Parameters p = input.parameters;
  if (p.size() < kalman::count) return false;
  Estimate next = estimate;
  if (!measured_.update(input, next)) return false;
  Memory& m = memory_;
  const double dt = measured_.period();
  m.gyro_noise = p[kalman::gyro_noise];
  next.quality.marker_innovation = next.quality.kinematic_innovation = 0.0;
  if (!m.started) {
    start(input, next);
  } else {
    if (!m.spread) spread(p);
    m.filter.propagate(measured_.gyro(), measured_.accelerometer(), gravity_, dt);
    follow_feet(input.model, p);
    if (m.ticks % 2 == 0) {
      m.filter.propagate_covariance({.gyro = p[kalman::gyro_noise],
                                     .accelerometer = p[kalman::accelerometer_noise],
                                     .gyro_bias_walk = p[kalman::gyro_bias_walk],
                                     .accelerometer_bias_walk = p[kalman::accelerometer_bias_walk],
                                     .slip = p[kalman::foot_slip],
                                     .sample = dt},
                                    gravity_, 2.0 * dt);
    } else {
      next.quality.kinematic_innovation = correct(p);
    }
  }
  ++m.ticks;
  m.without_feet = measured_.anchors().empty() ? m.without_feet + dt : 0.0;
  if (p[kalman::lost_after] > 0.0 && m.without_feet > p[kalman::lost_after]) return false;
  write(next);
  estimate = next;
  return true;
}

template <int Feet>
void ContactKalman<Feet>::write(Estimate& estimate) const noexcept {
  const Filter& f = memory_.filter;
  const Vector3d rate = measured_.gyro() - f.gyro_bias();
  const Vector3d arm = f.R() * measured_.imu();
  model::State& state = estimate.state;
  state.p_WB = array_of(memory_.origin + f.p() - arm);
  state.q_WB = quaternion_of(f.R());
  state.v_WB = array_of(f.v() - f.R() * rate.cross(measured_.imu()));
  state.w_WB_B = array_of(rate);
  EstimateQuality& quality = estimate.quality;
  const Matrix3d to_imu = measured_.R_BI().transpose();
  quality.gyro_bias = array_of(to_imu * f.gyro_bias());
  quality.accelerometer_bias = array_of(to_imu * f.accelerometer_bias());
  quality.markers = 0;
  place_deviation(quality);
}

// Of x = v and p: x̂ - x = xi_x + xi_R x x; at the IMU, whose difference to the base's origin is
// small beside it. The place's is that in the filter's world and that of the way there.
template <int Feet>
void ContactKalman<Feet>::place_deviation(EstimateQuality& quality) const noexcept {
  const Filter& f = memory_.filter;
  const auto& P = f.covariance();
  const auto of = [&](int block, const Matrix3d& S) {
    const Matrix3d cross = P.template block<3, 3>(block, Filter::kR) * S.transpose();
    const Matrix3d turned = S * P.template block<3, 3>(Filter::kR, Filter::kR) * S.transpose();
    return Vector3d(P.diagonal().template segment<3>(block) + 2.0 * cross.diagonal() +
                    turned.diagonal());
  };
  const auto deviation = [](const Vector3d& variance) {
    return array_of(variance.cwiseMax(0.0).cwiseSqrt());
  };
  quality.attitude = deviation(P.diagonal().template segment<3>(Filter::kR));
  quality.velocity = deviation(of(Filter::kV, -skew(f.v())));
  const Matrix3d S = -skew(f.p());
  Vector3d place = of(Filter::kP, S);
  const auto& way = f.way_with_error();
  for (int k = 0; k < 2; ++k) {
    place[k] +=
        f.way_covariance()(k, k) +
        2.0 * (way(k, Filter::kP + k) + S.row(k).dot(way.row(k).template segment<3>(Filter::kR)));
  }
  quality.position = deviation(place);
}

// By the map from the filter's error to that of the base's origin, with r from it to the IMU:
//   dv = xi_v + xi_R x v_B + R (zeta_g x r),   dp = xi_p + xi_R x p_B,
// and the gyroscope's white noise, which v_B = v - R (w x r) has.
template <int Feet>
bool ContactKalman<Feet>::covariance(ErrorCovariance& covariance) const noexcept {
  const Filter& f = memory_.filter;
  if (!memory_.spread) return false;
  const Matrix3d R = f.R();
  const Vector3d r = measured_.imu();
  const Vector3d p_B = f.p() - R * r;
  const Vector3d v_B = f.v() - R * (measured_.gyro() - f.gyro_bias()).cross(r);
  Eigen::Matrix<double, 9, 15> map = Eigen::Matrix<double, 9, 15>::Zero();
  map.template block<3, 3>(0, Filter::kR).setIdentity();
  map.template block<3, 3>(3, Filter::kR) = -skew(v_B);
  map.template block<3, 3>(3, Filter::kV).setIdentity();
  map.template block<3, 3>(3, Filter::kGyroBias) = -R * skew(r);
  map.template block<3, 3>(6, Filter::kR) = -skew(p_B);
  map.template block<3, 3>(6, Filter::kP).setIdentity();
  Eigen::Map<Eigen::Matrix<double, 9, 9, Eigen::RowMajor>> out(covariance.data());
  out = map * f.covariance().template topLeftCorner<15, 15>() * map.transpose();
  const Eigen::Matrix<double, 9, 2> way =
      map * f.way_with_error().template leftCols<15>().transpose();
  out.template middleCols<2>(6) += way;
  out.template middleRows<2>(6) += way.transpose();
  out.template block<2, 2>(6, 6) += f.way_covariance();
  const Matrix3d arm = memory_.gyro_noise * R * skew(r);
  out.template block<3, 3>(3, 3) += arm * arm.transpose();
  return true;
}

template <int Feet>
void ContactKalman<Feet>::take_over(const Estimator& old, const Estimate& last) noexcept {
  if (const auto* same = dynamic_cast<const ContactKalman*>(&old)) {
    measured_.take_over(same->measured_);
    memory_ = same->memory_;
    return;
  }
  const Matrix3d R = rotation_of(last.state.q_WB);
  const Vector3d arm = R * measured_.imu();
  const Vector3d w = R * vector_of(last.state.w_WB_B);
  memory_ = {};
  memory_.filter.start(R, vector_of(last.state.v_WB) + w.cross(arm),
                       vector_of(last.state.p_WB) + arm);
  memory_.started = true;  // its spread follows with the parameters of the first tick
}

}  // namespace

std::unique_ptr<Estimator> make_contact_kalman(const behaviors::EstimatorSpec& spec,
                                               const model::RobotDescription& robot,
                                               const model::ControlModel& model) {
  if (robot.contacts.empty()) {
    throw std::runtime_error("robot '" + robot.name +
                             "' has no contact, which its estimator needs");
  }
  if (robot.contacts.size() <= 2) return std::make_unique<ContactKalman<2>>(spec, robot, model);
  if (robot.contacts.size() <= 4) return std::make_unique<ContactKalman<4>>(spec, robot, model);
  return std::make_unique<ContactKalman<8>>(spec, robot, model);
}

}  // namespace footfall::engine
