// The control model against its own definitions: finite differences and conservation laws.
#include "model/control_model.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/allocation_guard.h"
#include "tests/support/hume.h"
#include "tests/support/matrix.h"

namespace footfall::tests {
namespace {

class ControlModelOfHume : public testing::Test {
 protected:
  Matrix jacobian(const model::Kinematics3& k) const {
    return Matrix::of_rows(k.jacobian.data(), 3, model_.nv());
  }
  Matrix mass_matrix() const {
    Matrix A(12, 12);  // symmetric: rows or columns first
    model_.mass_matrix(A.data());
    return A;
  }
  Matrix bias() const { return Matrix::vector(model_.bias().data(), 12); }
  Matrix gravity() const {
    Matrix g(12);
    model_.gravity_force(g.data());
    return g;
  }
  static Matrix velocity_of(const model::State& s) {
    Matrix v(12);
    for (int k = 0; k < 3; ++k) v(k) = s.v_WB[static_cast<std::size_t>(k)];
    for (int k = 0; k < 3; ++k) v(3 + k) = s.w_WB_B[static_cast<std::size_t>(k)];
    for (int k = 0; k < 6; ++k) v(6 + k) = s.qd[static_cast<std::size_t>(k)];
    return v;
  }
  double kinetic_energy(const model::State& s) {
    model_.update(s);
    const Matrix v = velocity_of(s);
    return 0.5 * dot(v, mass_matrix() * v);
  }
  // J̇q̇ by central differences along the motion at constant generalised velocity.
  template <typename Pick>
  Matrix differenced_bias(const model::State& s, Pick pick) {
    constexpr double h = 1e-4;
    model_.update(integrated(s, h, 6));
    const Matrix after = jacobian(pick());
    model_.update(integrated(s, -h, 6));
    return (after - jacobian(pick())) / (2 * h) * velocity_of(s);
  }

  model::RobotDescription robot_ = load_hume();
  model::ControlModel model_{robot_};
  Random random_{42};
};

// Central differences with h = 1e-4: h²/6 times third derivatives (angular speed cubed, up to
// 40 rad³/s³ on 1 m) is below 1e-7; round-off 1e-16/h far below.
constexpr double kDifference = 1e-6;

TEST_F(ControlModelOfHume, WeighsTwentyKilograms) {
  EXPECT_NEAR(model_.mass(), 20.0, 0.005);
  EXPECT_EQ(model_.nv(), 12);
  EXPECT_EQ(model_.contact_count(), 2);
  EXPECT_DOUBLE_EQ(model_.gravity(), 9.81);
}

TEST_F(ControlModelOfHume, StandsWithItsFeetOnTheGroundAndItsCentreOfMassOverThem) {
  model_.update(standing_state(robot_));
  EXPECT_NEAR(model_.point(0).position[2], 0.0, 1e-4);
  EXPECT_NEAR(model_.point(1).position[2], 0.0, 1e-4);
  EXPECT_NEAR(model_.com().position[2], 0.91, 0.01);
  const double middle = 0.5 * (model_.point(0).position[0] + model_.point(1).position[0]);
  EXPECT_NEAR(model_.com().position[0], middle, 1e-3);
  EXPECT_GT(model_.point(1).position[1], 0.1);
}

// Rows of external aids: of the torso's centre of mass along y, whose point the robot file names,
// and of the base's rotation about z.
TEST_F(ControlModelOfHume, AxesThatAidsHoldAreThoseOfTheirBody) {
  model::ModelDeviation known;
  known.held = {{"torso", 1}, {"torso", 5}};
  model::ControlModel held(robot_, known);
  const auto named = std::ranges::find(robot_.points, "torso_com", &model::PointDescription::name);
  const int point = 2 + static_cast<int>(named - robot_.points.begin());
  for (int i = 0; i < 10; ++i) {
    held.update(random_state(robot_, random_));
    const Matrix y = Matrix::vector(held.held_jacobian(0), 12);
    const Matrix yaw = Matrix::vector(held.held_jacobian(1), 12);
    EXPECT_LE((y - Matrix::vector(held.point(point).jacobian.data() + 12, 12)).max_abs(), 1e-12);
    EXPECT_LE((yaw - Matrix::vector(held.base_rotation().jacobian.data() + 24, 12)).max_abs(),
              1e-12);
    EXPECT_NEAR(held.held_bias(0), held.point(point).bias[1], 1e-9);
    EXPECT_NEAR(held.held_bias(1), held.base_rotation().bias[2], 1e-9);
  }
}

TEST_F(ControlModelOfHume, BiasAccelerationsAreTheDerivativeOfTheJacobians) {
  for (int i = 0; i < 30; ++i) {
    const model::State s = random_state(robot_, random_);
    model_.update(s);
    const auto com = model_.com().bias;
    const auto base = model_.base_rotation().bias;
    const auto knee = model_.point(5).bias;
    const Matrix com_fd = differenced_bias(
        s, [&]() -> auto& { return model_.com(); });
    const Matrix base_fd = differenced_bias(
        s, [&]() -> auto& { return model_.base_rotation(); });
    const Matrix knee_fd = differenced_bias(
        s, [&]() -> auto& { return model_.point(5); });
    for (int k = 0; k < 3; ++k) {
      const auto q = static_cast<std::size_t>(k);
      EXPECT_NEAR(com[q], com_fd(k), kDifference);
      EXPECT_NEAR(base[q], base_fd(k), kDifference);
      EXPECT_NEAR(knee[q], knee_fd(k), kDifference);
    }
  }
}

TEST_F(ControlModelOfHume, VelocitiesAreDerivativesOfPositions) {
  constexpr double h = 1e-4;
  for (int i = 0; i < 30; ++i) {
    const model::State s = random_state(robot_, random_);
    model_.update(s);
    const auto com = model_.com().velocity;
    const auto knee = model_.point(5).velocity;
    model_.update(integrated(s, h, 6));
    const auto com_after = model_.com().position, knee_after = model_.point(5).position;
    model_.update(integrated(s, -h, 6));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(com[k], (com_after[k] - model_.com().position[k]) / (2 * h), kDifference);
      EXPECT_NEAR(knee[k], (knee_after[k] - model_.point(5).position[k]) / (2 * h), kDifference);
    }
  }
}

// The contact point is fixed to the foot while it is looked at: its velocity is that of the ball's
// centre plus ω x (-r z), not the centre's own.
TEST_F(ControlModelOfHume, TheContactPointIsAMaterialPointOfTheFoot) {
  model::RobotDescription robot = robot_;
  robot.points.push_back({"centre", robot.contacts[0].site});
  robot.points.push_back({"knee", "right_knee"});
  model::ControlModel m(robot);
  const int centre = m.point_count() - 2;
  model::State s = standing_state(robot);
  s.qd[2] = 2.0;  // right knee, about y
  m.update(s);
  const double radius = robot.contacts[0].radius;
  EXPECT_NEAR(m.point(0).position[2], m.point(centre).position[2] - radius, 1e-15);
  EXPECT_NEAR(m.point(0).velocity[0], m.point(centre).velocity[0] - 2.0 * radius, 1e-12);
  // Centripetal: towards the knee's axis, ω² times the distance.
  const auto& knee = m.point(m.point_count() - 1).position;
  for (std::size_t k : {std::size_t{0}, std::size_t{2}}) {
    EXPECT_NEAR(m.point(0).bias[k], 4.0 * (knee[k] - m.point(0).position[k]), 1e-12);
  }
}

TEST_F(ControlModelOfHume, GravityForceIsTheGradientOfPotentialEnergy) {
  constexpr double h = 1e-4;
  for (int i = 0; i < 30; ++i) {
    const model::State s = random_state(robot_, random_);
    model_.update(s);
    const double power = dot(gravity(), velocity_of(s));
    model_.update(integrated(s, h, 6));
    const double after = model_.mass() * model_.gravity() * model_.com().position[2];
    model_.update(integrated(s, -h, 6));
    const double before = model_.mass() * model_.gravity() * model_.com().position[2];
    EXPECT_NEAR(power, (after - before) / (2 * h), 200.0 * kDifference);  // m g = 196 N
  }
}

TEST_F(ControlModelOfHume, BiasAtRestIsGravityAlone) {
  for (int i = 0; i < 10; ++i) {
    model::State s = random_state(robot_, random_);
    s.v_WB = s.w_WB_B = {};
    s.qd = {};
    model_.update(s);
    EXPECT_LE((bias() - gravity()).max_abs(), 1e-11);
  }
}

// In free flight without torque: d/dt ½q̇ᵀAq̇ = -gᵀq̇, which ties A, b and g together.
TEST_F(ControlModelOfHume, FreeFlightConservesEnergy) {
  constexpr double h = 1e-5;
  for (int i = 0; i < 30; ++i) {
    const model::State s = random_state(robot_, random_);
    model_.update(s);
    const double power = -dot(gravity(), velocity_of(s));
    const Matrix a = -solve(mass_matrix(), bias());
    const auto moved = [&](double dt) {
      model::State mean = s;  // velocity at the middle of the interval: second order
      model::State end = s;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto q = static_cast<int>(k);
        mean.v_WB[k] += 0.5 * dt * a(q);
        mean.w_WB_B[k] += 0.5 * dt * a(3 + q);
        end.v_WB[k] += dt * a(q);
        end.w_WB_B[k] += dt * a(3 + q);
      }
      for (std::size_t k = 0; k < 6; ++k) {
        mean.qd[k] += 0.5 * dt * a(6 + static_cast<int>(k));
        end.qd[k] += dt * a(6 + static_cast<int>(k));
      }
      const model::State place = integrated(mean, dt, 6);
      end.p_WB = place.p_WB;
      end.q_WB = place.q_WB;
      end.q = place.q;
      return end;
    };
    const double rate = (kinetic_energy(moved(h)) - kinetic_energy(moved(-h))) / (2 * h);
    EXPECT_NEAR(rate, power, 1e-5 * (1.0 + a.norm() * 20.0));
  }
}

TEST_F(ControlModelOfHume, MomentumIsTheMassMatrixTimesVelocityOfTheBase) {
  for (int i = 0; i < 30; ++i) {
    const model::State s = random_state(robot_, random_);
    model_.update(s);
    const Matrix p = (mass_matrix() * velocity_of(s)).head(6);
    const Matrix R = Matrix::of_rows(model_.R_WB().data(), 3, 3);
    const Matrix linear = p.head(3);
    Matrix arm(3);
    for (int k = 0; k < 3; ++k) {
      const auto q = static_cast<std::size_t>(k);
      arm(k) = model_.com().position[q] - s.p_WB[q];
    }
    const Matrix angular = R * p.tail(3) - cross(arm, linear);
    for (int k = 0; k < 3; ++k) {
      const auto q = static_cast<std::size_t>(k);
      EXPECT_NEAR(model_.centroidal_momentum()[q], linear(k), 1e-11);
      EXPECT_NEAR(model_.centroidal_momentum()[q], model_.mass() * model_.com().velocity[q], 1e-11);
      EXPECT_NEAR(model_.centroidal_momentum()[3 + q], angular(k), 1e-11);
    }
  }
}

TEST_F(ControlModelOfHume, WhitenedColumnsMultiplyAsInTheInverseMassMatrix) {
  for (int i = 0; i < 10; ++i) {
    model_.update(random_state(robot_, random_));
    Matrix J(9, 12);
    J.set_block(0, 0, jacobian(model_.point(0)));
    J.set_block(3, 0, jacobian(model_.com()));
    J.set_block(6, 0, jacobian(model_.base_rotation()));
    std::vector<double> padded = beside(J.transpose(), Matrix(12)).by_rows();
    model::whiten(model_.factor(), padded.data(), 9, 10);
    const Matrix X = Matrix::of_rows(padded.data(), 12, 10).block(0, 0, 12, 9);
    const Matrix expected = J * solve(mass_matrix(), J.transpose());
    EXPECT_LE((X.transpose() * X - expected).max_abs(), 1e-11 * expected.max_abs());
  }
}

TEST_F(ControlModelOfHume, AnAssumedMassErrorScalesTheWholeMassMatrix) {
  model::ModelDeviation deviation;
  deviation.mass_scale = 1.1;
  model::ControlModel heavy(robot_, deviation);
  const model::State s = random_state(robot_, random_);
  heavy.update(s);
  model_.update(s);
  Matrix A(12, 12);  // symmetric: rows or columns first
  heavy.mass_matrix(A.data());
  EXPECT_NEAR(heavy.mass(), 1.1 * model_.mass(), 1e-12);
  EXPECT_LE((A - 1.1 * mass_matrix()).max_abs(), 1e-12);
}

TEST_F(ControlModelOfHume, AnAssumedShiftOfALinkMovesTheCentreOfMassByItsShare) {
  model::ModelDeviation deviation;
  deviation.com_shift["torso"] = {0.02, 0.0, 0.0};
  model::ControlModel shifted(robot_, deviation);
  shifted.update(standing_state(robot_));
  model_.update(standing_state(robot_));
  const double share = 12.61 * 0.8565 / model_.mass();  // the torso's
  EXPECT_NEAR(shifted.com().position[0] - model_.com().position[0], 0.02 * share, 1e-9);
}

TEST_F(ControlModelOfHume, RollPitchAndYawRebuildTheRotation) {
  for (int i = 0; i < 30; ++i) {
    model_.update(random_state(robot_, random_));
    const auto& r = model_.rpy();
    const double pitch_element = -std::sin(r[1]);
    EXPECT_NEAR(model_.R_WB()[6], pitch_element, 1e-14);
    EXPECT_NEAR(model_.R_WB()[0], std::cos(r[1]) * std::cos(r[2]), 1e-14);
    EXPECT_NEAR(model_.R_WB()[7], std::cos(r[1]) * std::sin(r[0]), 1e-14);
  }
}

TEST_F(ControlModelOfHume, UpdatingAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  const model::State s = random_state(robot_, random_);
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) model_.update(s);
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace footfall::tests
