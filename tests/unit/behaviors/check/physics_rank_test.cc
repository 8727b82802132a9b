// Tasks against the freedom that contacts leave; ranks by SVD of dense matrices as the oracle.
// Equations: [Kim16] eqs. (32), (33), (38).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "behaviors/check/physics/configurations.h"
#include "behaviors/check/physics/law.h"
#include "behaviors/check/physics/postures.h"
#include "behaviors/loader.h"
#include "tests/support/matrix.h"
#include "tests/unit/behaviors/check/physics_test_support.h"

namespace footfall::tests {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(PhysicsRank, YawOnASinglePointFootIsRefusedWhereItIsWritten) {
  const std::string text =
      standing("[right_foot]", height() + attitude("[yaw, pitch, roll]") + swing());
  const std::string said = physics(text);
  EXPECT_THAT(said, StartsWith(place_of(text, "yaw") +
                               "error: task 'attitude' cannot meet 'yaw' on right_foot alone: no "
                               "contact can produce it"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1);
}

TEST(PhysicsRank, YawIsRefusedAlsoWhereTheLegInTheAirCouldLendIt) {
  const std::string text = standing("[left_foot]", height() + attitude("[yaw]") + rest());
  EXPECT_THAT(physics(text), HasSubstr("no contact can produce it"));
}

TEST(PhysicsRank, YawOnTwoFeetAndTheRestOnOneAreClean) {
  EXPECT_EQ(physics(standing("[right_foot, left_foot]", dual_tasks())), "");
  EXPECT_EQ(physics(standing("[right_foot]", single_tasks())), "");
}

TEST(PhysicsRank, NothingMovesTheCentreOfMassInTheAir) {
  const std::string text = standing("[]", height() + rest());
  EXPECT_THAT(physics(text),
              StartsWith(place_of(text, "z]") +
                         "error: task 'height' cannot meet 'z' in the air: no contact can "
                         "produce it"));
}

TEST(PhysicsRank, AFootThatHoldsDoesNotMove) {
  const std::string text = standing("[right_foot, left_foot]", dual_tasks() + swing());
  EXPECT_THAT(physics(text), HasSubstr("error: task 'swing' cannot move 'x': left_foot is held by "
                                       "its own contact on right_foot and left_foot"));
}

TEST(PhysicsRank, TheFreedomWithoutATaskIsWarnedAbout) {
  const std::string text =
      standing("[right_foot, left_foot]", height() + attitude("[yaw, pitch, roll]"));
  EXPECT_THAT(physics(text),
              StartsWith(place_of(text, "height") +
                         "warning: 1 of 5 actuated directions has no task on right_foot and "
                         "left_foot: "));
  EXPECT_THAT(physics(text), HasSubstr("may drift; add a joint_damping of a last priority"));
}

TEST(PhysicsRank, AContactWithoutTasksIsWarnedAbout) {
  const std::string text =
      "behavior: 1\nrobot: hume\nmachine:\n  states: {stand: {contacts: [right_foot]}}\n";
  EXPECT_THAT(physics(text), HasSubstr("warning: 6 of 6 actuated directions have no task"));
}

TEST(PhysicsRank, TasksOfOneLevelThatFightAreNamed) {
  const std::string both =
      "      place: {type: com_position, axes: [x, y], reference: entry, gains: {kp: 1}}\n";
  const std::string text =
      standing("[right_foot, left_foot]", height() + attitude("[yaw, pitch, roll]") + both);
  EXPECT_THAT(physics(text), HasSubstr("warning: task 'place' fights with "));
  EXPECT_THAT(physics(text), HasSubstr("'attitude'"));
  EXPECT_THAT(physics(text), HasSubstr("of the same priority 1"));
}

TEST(PhysicsRank, AWeightOrAPrioritySaysWhatGivesWay) {
  const std::string head = height() + attitude("[yaw, pitch, roll]");
  const std::string place = "      place: {type: com_position, axes: [x, y], reference: entry, ";
  EXPECT_EQ(
      physics(standing("[right_foot, left_foot]", head + place + "gains: {kp: 1}, weight: 0.1}\n")),
      "");
  EXPECT_EQ(
      physics(standing("[right_foot, left_foot]", head + place + "gains: {kp: 1}, priority: 2}\n")),
      "");
}

TEST(PhysicsRank, TheShippedBehaviorsAreClean) {
  for (const char* file :
       {"behaviors/library/balance.yaml", "behaviors/library/balance_best.yaml",
        "behaviors/library/balance_paper.yaml", "examples/high_steps.yaml", "examples/squat.yaml",
        "tests/unit/behaviors/load/kim2016_printed.yaml"}) {
    core::Diagnostics diagnostics;
    const auto behavior = behaviors::load_behavior(std::string(FOOTFALL_SOURCE_DIR) + "/" + file,
                                                   options_for_tests(), diagnostics);
    ASSERT_NE(behavior, nullptr) << file;
    behaviors::check_physics(*behavior, diagnostics);
    EXPECT_EQ(diagnostics.to_string(), "") << file;
  }
}

TEST(PhysicsRank, PosturesAreWithinTheJointsLimitsAndTheSameEveryTime) {
  const auto behavior = load(standing("[right_foot]", single_tasks()));
  model::ControlModel model(behavior->robot);
  const auto postures = behaviors::physics_postures(behavior->robot, model, {});
  ASSERT_EQ(postures.size(), 21U);
  const auto again = behaviors::physics_postures(behavior->robot, model, {});
  for (std::size_t k = 0; k < postures.size(); ++k) {
    for (std::size_t j = 0; j < behavior->robot.joints.size(); ++j) {
      const auto& joint = behavior->robot.joints[j];
      EXPECT_GE(postures[k].q[j], joint.position_min);
      EXPECT_LE(postures[k].q[j], joint.position_max);
      EXPECT_NEAR(postures[k].q[j], joint.posture, k == 0 ? 0.0 : 0.2);
      EXPECT_EQ(postures[k].q[j], again[k].q[j]);
    }
  }
}

// phi = U N_s A^-1 (U N_s)^T and J A^-1 N_s^T U^T, dense: their ranks by SVD. Singular values that
// count lie above 1e-2 of the largest on these postures, those that do not below 1e-12.
int svd_rank(const Matrix& m) {
  if (m.size() == 0) return 0;
  const std::vector<double> s = singular_values(m);
  return static_cast<int>(
      std::count_if(s.begin(), s.end(), [&](double value) { return value > 1e-8 * s[0]; }));
}

Matrix dense(const double* rows, int count, int n) { return Matrix::of_rows(rows, count, n); }

void expect_dense_ranks(const std::string& text) {
  const auto behavior = load(text);
  model::ControlModel model(behavior->robot);
  behaviors::PhysicsLaw law(*behavior, model);
  const auto& control = behavior->controls.front();
  const auto rows = law.rows(control);
  const int n = model.nv();
  for (const model::State& posture : behaviors::physics_postures(behavior->robot, model, {})) {
    model.update(posture);
    std::vector<double> mass(static_cast<std::size_t>(n * n));
    model.mass_matrix(mass.data());
    const Matrix A_inv = inverse(dense(mass.data(), n, n));
    Matrix Js(3 * static_cast<int>(control.contacts.size()), n);
    for (std::size_t i = 0; i < control.contacts.size(); ++i) {
      Js.set_block(3 * static_cast<int>(i), 0,
                   dense(model.point(control.contacts[i]).jacobian.data(), 3, n));
    }
    Matrix J(static_cast<int>(rows.size()), n);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const int axis = rows[r].axis->axis;
      Matrix row(1, n);
      const auto type = rows[r].task->type;
      if (type == tasks::TaskType::com_position) {
        row = dense(model.com().jacobian.data(), 3, n).row(axis);
      } else if (type == tasks::TaskType::point_position) {
        row = dense(model.point(rows[r].task->point).jacobian.data(), 3, n).row(axis);
      } else if (type == tasks::TaskType::body_orientation) {
        const double yaw = model.rpy()[2];
        const std::array<double, 3> axes[3] = {
            {std::cos(yaw), std::sin(yaw), 0}, {-std::sin(yaw), std::cos(yaw), 0}, {0, 0, 1}};
        row = Matrix::vector(axes[axis]).transpose() *
              dense(model.base_rotation().jacobian.data(), 3, n);
      } else {
        row(0, 6 + axis) = 1.0;
      }
      J.set_row(static_cast<int>(r), row);
    }
    // A^-1 N_s^T U^T: what torques do to accelerations under the contacts.
    const Matrix weighted = Js * A_inv * Js.transpose();
    const Matrix free = A_inv - A_inv * Js.transpose() * inverse(weighted) * Js * A_inv;
    const Matrix act = free.block(0, 6, n, n - 6);
    const behaviors::RowRanks found = law.ranks(control.contacts, rows);
    EXPECT_EQ(found.actuated, svd_rank(act.tail(n - 6)));
    EXPECT_EQ(found.covered, svd_rank(J * act));
    for (std::size_t r = 1; r <= rows.size(); ++r) {  // what each row adds to those before it
      const int count = static_cast<int>(r);
      EXPECT_EQ(std::accumulate(found.added.begin(), found.added.begin() + count, 0),
                svd_rank(J.head(count) * act));
    }
  }
}

TEST(PhysicsRank, RanksAreThoseOfDenseMatricesByEquations32And33And38) {
  expect_dense_ranks(standing("[right_foot, left_foot]", dual_tasks()));
  expect_dense_ranks(
      standing("[right_foot, left_foot]", height() + attitude("[yaw, pitch, roll]")));
  expect_dense_ranks(standing("[right_foot]", single_tasks()));
  expect_dense_ranks(standing("[left_foot]", height() + attitude("[pitch, roll]") + rest()));
}

TEST(PhysicsConfigurations, AMirroredStrideIsPassedThroughItsFinalChild) {
  core::Diagnostics diagnostics;
  const auto b = behaviors::load_behavior(balance_path(), options_for_tests(), diagnostics);
  ASSERT_NE(b, nullptr);
  for (const auto& change : behaviors::control_changes(*b)) {
    for (const int s : change.entered) {
      const auto& state = b->states[static_cast<std::size_t>(s)];
      EXPECT_FALSE(state.kind == behaviors::StateKind::final) << state.path;
    }
  }
}

TEST(PhysicsConfigurations, RegionsMultiply) {
  const auto b = load(R"(behavior: 1
robot: hume
machine:
  type: parallel
  states:
    feet:
      states:
        both: {contacts: [right_foot, left_foot], transitions: [{on: "*", to: one}]}
        one: {contacts: [right_foot]}
    body:
      states:
        still: {tasks: {rest: {type: joint_damping, gains: {kd: 1}}}, transitions: [{on: "*", to: loose}]}
        loose: {tasks: {rest: {type: joint_damping, gains: {kd: 2}}}}
)");
  EXPECT_EQ(behaviors::controlling_states(*b).size(), 4U);
  std::vector<std::pair<int, int>> feet;
  for (const auto& change : behaviors::control_changes(*b)) {
    const auto& from = b->controls[static_cast<std::size_t>(change.from)].contacts;
    const auto& to = b->controls[static_cast<std::size_t>(change.to)].contacts;
    if (from != to) feet.emplace_back(from.size(), to.size());
  }
  ASSERT_EQ(feet.size(), 2U);  // once with the body still, once with it loose
  EXPECT_EQ(feet[0], std::pair(2, 1));
  EXPECT_EQ(feet[1], std::pair(2, 1));
}

}  // namespace
}  // namespace footfall::tests
