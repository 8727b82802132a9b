// Terrain: distances and normals by hand, and the normal as the gradient of the distance; where
// the control model's contact points are on it.
#include "model/terrain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/control_model.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/hume.h"
#include "tests/support/matrix.h"

namespace footfall::tests {
namespace {

using Vector = std::array<double, 3>;

// 1 m x 0.4 m x 0.2 m, its lower face on the plane.
model::TerrainPiece upright() {
  return {{2.0, 0.0, 0.1}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.5, 0.2, 0.1}};
}

// A cube of 1 m about (0, 0, 1), turned about y by an angle; at 45 deg its top is an edge along y.
model::TerrainPiece turned(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{0.0, 0.0, 1.0}, {c, 0, s, 0, 1, 0, -s, 0, c}, {0.5, 0.5, 0.5}};
}

void expect_ground(const model::GroundAt& found, const Vector& normal, double distance) {
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found.normal[k], normal[k], 1e-15);
  EXPECT_NEAR(found.distance, distance, 1e-15);
}

TEST(Terrain, WithoutBoxesIsThePlaneExactly) {
  const model::GroundAt found = model::Terrain{}.nearest({0.3, -0.2, 0.25});
  EXPECT_EQ(found.normal, (Vector{0.0, 0.0, 1.0}));
  EXPECT_EQ(found.distance, 0.25);
}

TEST(Terrain, PushesStraightOutOfTheFaceAboveOrBesideIt) {
  const model::Terrain terrain{{upright()}};
  expect_ground(terrain.nearest({2.1, 0.1, 0.25}), {0, 0, 1}, 0.05);
  expect_ground(terrain.nearest({1.45, 0.0, 0.15}), {-1, 0, 0}, 0.05);
  expect_ground(terrain.nearest({2.0, 0.21, 0.15}), {0, 1, 0}, 0.01);
}

TEST(Terrain, PushesAwayFromTheClosestPointOfAnEdge) {
  const model::Terrain terrain{{upright()}};
  // 3 cm beyond the edge at x = 1.5 and 4 cm above it.
  expect_ground(terrain.nearest({1.47, 0.0, 0.24}), {-0.6, 0, 0.8}, 0.05);
}

TEST(Terrain, PushesOutOfTheFaceOfLeastDepthInside) {
  const model::Terrain terrain{{upright()}};
  expect_ground(terrain.nearest({2.0, 0.0, 0.17}), {0, 0, 1}, -0.03);
  expect_ground(terrain.nearest({2.0, -0.19, 0.15}), {0, -1, 0}, -0.01);
}

TEST(Terrain, IsThePlaneWhereThatIsNearer) {
  const model::Terrain terrain{{upright()}};
  EXPECT_EQ(terrain.nearest({1.2, 0.0, 0.1}).normal, (Vector{0.0, 0.0, 1.0}));
}

TEST(Terrain, OfAnInclinedBoxHasItsFaceNormal) {
  const double angle = 30.0 * M_PI / 180.0;
  const model::Terrain terrain{{turned(angle)}};
  const Vector n = {std::sin(angle), 0.0, std::cos(angle)};  // of the top face
  const Vector point = {0.6 * n[0], 0.1, 1.0 + 0.6 * n[2]};
  expect_ground(terrain.nearest(point), n, 0.1);
}

// Where the distance is smooth: its gradient, by central differences, is the normal. Second
// derivatives are at most 1/distance = 1/1 cm, third ones 1/distance^2: h^2/6 of those is 2e-9.
TEST(Terrain, HasTheGradientOfTheDistanceAsNormal) {
  const model::Terrain terrain{{upright(), turned(0.7)}};
  constexpr double h = 1e-6;
  Random random(7);
  int judged = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector p = {random.within(2.5), random.within(1.0), 1.0 + random.within(1.0)};
    const model::GroundAt here = terrain.nearest(p);
    if (std::abs(here.distance) < 0.01) continue;
    Vector gradient{};
    for (std::size_t k = 0; k < 3; ++k) {
      Vector a = p, b = p;
      a[k] += h;
      b[k] -= h;
      gradient[k] = (terrain.nearest(a).distance - terrain.nearest(b).distance) / (2 * h);
    }
    const double length = std::hypot(gradient[0], gradient[1], gradient[2]);
    if (std::abs(length - 1.0) > 1e-6) continue;  // a ridge between two pieces or faces
    ++judged;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(here.normal[k], gradient[k], 1e-7);
  }
  EXPECT_GT(judged, 1900);
}

TEST(Terrain, LetsABallDownToItsRadius) {
  const double angle = M_PI / 4.0;
  const model::Terrain terrain{{turned(angle)}};
  EXPECT_EQ(model::Terrain{}.rest_height(0.0, 0.0, 0.012), 0.012);
  // The slope through the edge (0, 0, 1 + sqrt(1/2)): z = edge - x, the centre r sqrt(2) above it.
  const double slope = 1.0 + std::sqrt(0.5) - 0.3 + 0.02 * std::sqrt(2.0);
  EXPECT_NEAR(terrain.rest_height(0.3, 0.0, 0.02), slope, 1e-11);
  EXPECT_NEAR(terrain.rest_height(3.0, 0.0, 0.02), 0.02, 1e-11);
}

TEST(Terrain, GivesHumeItsContactPointsAndTheirJacobians) {
  const model::RobotDescription robot = load_hume();
  const double angle = M_PI / 4.0, c = std::cos(angle);
  model::ModelDeviation deviation;
  // A slope that goes through the whole of the space below the robot's feet, falling along x.
  deviation.terrain.boxes = {{{-c, 0.0, -c}, {c, 0, c, 0, 1, 0, -c, 0, c}, {20.0, 20.0, 1.0}}};
  model::ControlModel level(robot), inclined(robot, deviation);
  Random random(3);
  model::State state = random_state(robot, random);
  state.p_WB = {0.0, 0.0, 5.0};
  level.update(state);
  {
    const AllocationGuard guard;
    inclined.update(state);
    EXPECT_EQ(guard.allocations(), 0);
  }
  const double r = robot.contacts[0].radius;
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(level.contact_normal(i), (Vector{0.0, 0.0, 1.0}));
    const Vector& n = inclined.contact_normal(i);
    EXPECT_NEAR(n[0], c, 1e-14);
    EXPECT_NEAR(n[2], c, 1e-14);
    Vector apart{};
    for (std::size_t k = 0; k < 3; ++k) {
      apart[k] = inclined.point(i).position[k] - level.point(i).position[k];
    }
    EXPECT_NEAR(apart[0], -r * c, 1e-14);
    EXPECT_NEAR(apart[2], r - r * c, 1e-14);
    // Both are points of the same link: their velocities differ by w x (their distance).
    const Vector w = level.point_angular_velocity(i);
    const Vector turn = {w[1] * apart[2] - w[2] * apart[1], w[2] * apart[0] - w[0] * apart[2],
                         w[0] * apart[1] - w[1] * apart[0]};
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(inclined.point(i).velocity[k] - level.point(i).velocity[k], turn[k], 1e-12);
    }
  }
}

}  // namespace
}  // namespace footfall::tests
