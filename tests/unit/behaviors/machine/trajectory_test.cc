#include "behaviors/compiled/trajectory.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace footfall::tests {
namespace {

using behaviors::make_segment;
using behaviors::Motion;
using behaviors::sample;
using behaviors::Segment;
using behaviors::Shape;

constexpr Shape kMoving[] = {Shape::polynomial3, Shape::polynomial5, Shape::cosine,
                             Shape::minimum_jerk};

TEST(Trajectory, EveryShapeStartsWhereItIsAndEndsWhereItShould) {
  for (const Shape shape : kMoving) {
    const Segment g = make_segment(shape, {0.3, 0.0, 0.0}, 0.8, 0.0, 0.15);
    EXPECT_NEAR(sample(g, 0.0).pos, 0.3, 1e-15);
    EXPECT_NEAR(sample(g, 0.15 - 1e-12).pos, 0.8, 1e-12);
    EXPECT_EQ(sample(g, 0.15).pos, 0.8);
    EXPECT_EQ(sample(g, 9.0).pos, 0.8);
  }
}
TEST(Trajectory, EveryShapeTakesOverTheVelocityAtItsStart) {
  for (const Shape shape : kMoving) {
    EXPECT_NEAR(sample(make_segment(shape, {0.3, -0.7, 0.0}, 0.8, 0.0, 0.2), 0.0).vel, -0.7, 1e-12);
  }
}
TEST(Trajectory, VelocityAndAccelerationAreTheDerivatives) {
  const double d = 1e-5;  // central differences: error d² x''''/6, far below 1e-5 here
  for (const Shape shape : kMoving) {
    const Segment g =
        make_segment(shape, {0.3, 0.4, 1.0}, 0.8, shape == Shape::cosine ? 0 : 0.2, 0.5);
    for (const double t : {0.05, 0.2, 0.31, 0.45}) {
      EXPECT_NEAR(sample(g, t).vel, (sample(g, t + d).pos - sample(g, t - d).pos) / (2 * d), 1e-5);
      EXPECT_NEAR(sample(g, t).acc, (sample(g, t + d).vel - sample(g, t - d).vel) / (2 * d), 1e-5);
    }
  }
}
TEST(Trajectory, TheEndVelocityIsReachedAndKeptOn) {
  for (const Shape shape : {Shape::polynomial3, Shape::polynomial5, Shape::minimum_jerk}) {
    const Segment g = make_segment(shape, {0.1, 0.0, 0.0}, 0.0, -0.25, 0.15);
    EXPECT_NEAR(sample(g, 0.15 - 1e-13).vel, -0.25, 1e-9);
    EXPECT_NEAR(sample(g, 0.35).pos, -0.05, 1e-15);
    EXPECT_EQ(sample(g, 0.35).vel, -0.25);
  }
}
TEST(Trajectory, MinimumJerkIsTheQuinticWithRestAtBothEnds) {
  // x = d (10 s³ - 15 s⁴ + 6 s⁵), Flash and Hogan 1985.
  const Segment g = make_segment(Shape::minimum_jerk, {0.0, 0.0, 0.0}, 2.0, 0.0, 4.0);
  const double s = 0.3;
  EXPECT_NEAR(sample(g, 4.0 * s).pos,
              2.0 * (10 * std::pow(s, 3) - 15 * std::pow(s, 4) + 6 * std::pow(s, 5)), 1e-14);
}
TEST(Trajectory, TheCosineIsHalfWayAtHalfTime) {
  const Segment g = make_segment(Shape::cosine, {0.0, 0.0, 0.0}, 0.06, 0.0, 0.145);
  EXPECT_NEAR(sample(g, 0.0725).pos, 0.03, 1e-15);
  EXPECT_NEAR(sample(g, 0.0725).vel, 0.5 * 0.06 * M_PI / 0.145, 1e-12);
}
TEST(Trajectory, HoldStaysAtItsStartWithoutVelocity) {
  const Segment g = make_segment(Shape::hold, {0.4, 1.0, 5.0}, 9.0, 1.0, 0.1);
  EXPECT_EQ(sample(g, 7.0).pos, 0.4);
  EXPECT_EQ(sample(g, 7.0).vel, 0.0);
}
TEST(Trajectory, NoTimeAtAllMeansBeingThere) {
  for (const Shape shape : kMoving) {
    const Motion m = sample(make_segment(shape, {0.4, 0.0, 0.0}, 0.9, 0.0, 0.0), 0.0);
    EXPECT_EQ(m.pos, 0.9);
    EXPECT_TRUE(std::isfinite(m.vel) && std::isfinite(m.acc));
  }
}

std::vector<behaviors::Knot> knots_of(const std::vector<std::array<double, 2>>& points,
                                      double start_velocity, double end_velocity) {
  std::vector<behaviors::Knot> knots;
  for (const auto& [time, pos] : points) knots.push_back({time, pos, 0.0, 0.0});
  knots.front().vel = start_velocity;
  knots.back().vel = end_velocity;
  behaviors::fit_knots(knots);
  return knots;
}

TEST(Trajectory, KnotsArePassedInTime) {
  const auto knots = knots_of({{0.0, 0.3}, {0.1, 0.9}, {0.25, 0.2}, {0.4, 0.5}}, 0.7, -0.2);
  for (const auto& knot : knots) {
    EXPECT_NEAR(behaviors::sample_knots(knots, knot.time).pos, knot.pos, 1e-14);
  }
  EXPECT_NEAR(behaviors::sample_knots(knots, 0.0).vel, 0.7, 1e-13);
  EXPECT_NEAR(behaviors::sample_knots(knots, 0.6).pos, 0.5 - 0.2 * 0.2, 1e-14);
}
TEST(Trajectory, ACubicIsItsOwnSpline) {
  // x = t³ - t²: the complete spline through points of a cubic with its end velocities is that
  // cubic.
  const auto x = [](double t) { return t * t * t - t * t; };
  const auto v = [](double t) { return 3 * t * t - 2 * t; };
  const auto knots = knots_of({{0.0, x(0)}, {0.3, x(0.3)}, {0.8, x(0.8)}, {1.0, x(1)}}, v(0), v(1));
  EXPECT_NEAR(knots[1].vel, v(0.3), 1e-14);
  EXPECT_NEAR(knots[2].vel, v(0.8), 1e-14);
  EXPECT_NEAR(knots[1].acc, 6 * 0.3 - 2, 1e-13);
  EXPECT_NEAR(behaviors::sample_knots(knots, 0.55).pos, x(0.55), 1e-14);
}
TEST(Trajectory, AcrossKnotsNothingJumps) {
  const auto knots = knots_of({{0.0, 0.3}, {0.1, 0.9}, {0.25, 0.2}, {0.4, 0.5}}, 0.0, 0.0);
  for (const double t : {0.1, 0.25, 0.4}) {
    const Motion before = behaviors::sample_knots(knots, t - 1e-12);
    const Motion after = behaviors::sample_knots(knots, t);
    // 1e-12 s of the next derivative each: acceleration ~1e3, jerk ~1e5.
    EXPECT_NEAR(before.pos, after.pos, 1e-10);
    EXPECT_NEAR(before.vel, after.vel, 1e-8);
    EXPECT_NEAR(before.acc, after.acc, 1e-5);
  }
}
TEST(Trajectory, KnotsHaveTheirOwnDerivatives) {
  const auto knots = knots_of({{0.0, 0.3}, {0.4, 0.9}, {1.0, 0.2}}, 0.4, 0.1);
  const double d = 1e-5;  // central differences: d²/6 of the third derivative, far below 1e-5 here
  for (const double t : {0.1, 0.35, 0.5, 0.9}) {
    const Motion before = behaviors::sample_knots(knots, t - d);
    const Motion after = behaviors::sample_knots(knots, t + d);
    const Motion now = behaviors::sample_knots(knots, t);
    EXPECT_NEAR(now.vel, (after.pos - before.pos) / (2 * d), 1e-5);
    EXPECT_NEAR(now.acc, (after.vel - before.vel) / (2 * d), 1e-5);
  }
}

}  // namespace
}  // namespace footfall::tests
