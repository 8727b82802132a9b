// Internal forces between every pair of three and four contacts, on a quadruped made for the test.
// Equations: [Kim16] eqs. (7)-(10) with E10, pair by pair.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

#include "tasks/whole_body_controller.h"
#include "tests/support/hume.h"
#include "tests/support/matrix.h"

namespace footfall::tests {
namespace {

using tasks::ControlSet;

// A trunk on four legs of three hinges each; feet at its corners.
class Quadruped : public testing::Test {
 protected:
  Quadruped() {
    const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                       ("quadruped_" + std::to_string(::getpid()) + ".xml");
    std::ofstream(file) << mjcf();
    robot_.name = "quadruped";
    robot_.path = "quadruped.yaml";
    robot_.model_path = file.string();
    robot_.floating_base = "trunk";
    for (int leg = 0; leg < 4; ++leg) {
      for (const char* joint : {"roll", "hip", "knee"}) {
        model::JointDescription description;
        description.name = joint + std::to_string(leg);
        robot_.joints.push_back(description);
      }
      model::ContactDescription contact;
      contact.name = contact.site = "foot" + std::to_string(leg);
      robot_.contacts.push_back(contact);
    }
    model_ = std::make_unique<model::ControlModel>(robot_);
    std::filesystem::remove(file);
    model::State state;
    state.p_WB = {0.0, 0.0, 0.45};
    for (std::size_t leg = 0; leg < 4; ++leg) {
      state.q[3 * leg] = 0.1 - 0.05 * static_cast<double>(leg);
      state.q[3 * leg + 1] = 0.5 + 0.1 * static_cast<double>(leg);
      state.q[3 * leg + 2] = -1.0;
    }
    model_->update(state);
    controller_ = std::make_unique<tasks::WholeBodyController>(
        *model_, std::vector<double>{}, tasks::ControllerSizes{2, 8, 2, 4}, 1e-3);
  }

  // All legs alike: the feet are in a horizontal plane.
  void stand_level() {
    model::State state;
    state.p_WB = {0.0, 0.0, 0.45};
    for (std::size_t leg = 0; leg < 4; ++leg) {
      state.q[3 * leg + 1] = 0.5;
      state.q[3 * leg + 2] = -1.0;
    }
    model_->update(state);
  }

  static std::string mjcf() {
    std::string legs;
    for (int leg = 0; leg < 4; ++leg) {
      const std::string n = std::to_string(leg);
      const std::string place =
          std::string(leg < 2 ? "0.3" : "-0.3") + (leg % 2 == 0 ? " -0.15 0" : " 0.15 0");
      legs += "<body pos='" + place + "'><joint name='roll" + n +
              "' axis='1 0 0'/><geom type='sphere' size='0.04' mass='0.5'/>"
              "<body><joint name='hip" +
              n +
              "' axis='0 1 0'/><geom type='capsule' fromto='0 0 0 0 0 -0.25' size='0.02' mass='1'/>"
              "<body pos='0 0 -0.25'><joint name='knee" +
              n +
              "' axis='0 1 0'/><geom type='capsule' fromto='0 0 0 0 0 -0.25' size='0.02' "
              "mass='0.3'/><site name='foot" +
              n + "' pos='0 0 -0.25'/></body></body></body>";
    }
    return "<mujoco><worldbody><body name='trunk'><freejoint/>"
           "<geom type='box' size='0.3 0.15 0.05' mass='10'/>" +
           legs + "</body></worldbody></mujoco>";
  }

  // The CoM held by one task, every pair of these contacts under `tension`.
  static ControlSet set_of(const std::vector<int>& contacts, double tension) {
    ControlSet set;
    for (const int c : contacts) set.contacts[static_cast<std::size_t>(set.contact_count++)] = c;
    set.task_count = 1;
    set.tasks[0].axis_count = set.axis_count = 3;
    for (int k = 0; k < 3; ++k) {
      tasks::AxisCommand& axis = set.axes[static_cast<std::size_t>(k)];
      axis.axis = k;
      axis.ref_acc = 0.3 - 0.2 * k;
    }
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      for (std::size_t j = i + 1; j < contacts.size(); ++j) {
        set.internals[static_cast<std::size_t>(set.internal_count++)] = {
            .contacts = {contacts[i], contacts[j]}, .reference = tension};
      }
    }
    return set;
  }
  void compute(const ControlSet& set) {
    tasks::ActiveControl control;
    control.primary = set;
    std::array<double, 12> tau{};
    controller_->compute(control, tick_++, nullptr, tau.data());
  }
  Matrix force(int contact) const {
    return Matrix::vector(controller_->result().force[static_cast<std::size_t>(contact)]);
  }
  Matrix place(int contact) const { return Matrix::vector(model_->point(contact).position); }

  model::RobotDescription robot_;
  std::unique_ptr<model::ControlModel> model_;
  std::unique_ptr<tasks::WholeBodyController> controller_;
  std::int64_t tick_ = 0;
};

TEST_F(Quadruped, EveryPairOfThreeContactsPushesWithTheForceThatIsAskedFor) {
  const std::vector<int> contacts = {0, 1, 2};
  compute(set_of(contacts, 40.0));
  std::size_t pair = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i + 1; j < 3; ++j, ++pair) {
      const Matrix x = place(contacts[i]) - place(contacts[j]);
      const double apart = -0.5 * dot(x, force(contacts[i]) - force(contacts[j])) / x.norm();
      EXPECT_NEAR(apart, 40.0, 1e-8);
      EXPECT_NEAR(controller_->result().internal[pair], 40.0, 1e-8);
    }
  }
}

TEST_F(Quadruped, ForcesBetweenAllMoveNothing) {
  for (const auto& contacts : {std::vector<int>{0, 1, 2}, std::vector<int>{0, 1, 2, 3}}) {
    compute(set_of(contacts, 0.0));
    const tasks::ControllerResult without = controller_->result();
    std::vector<Matrix> before;
    for (const int c : contacts) before.push_back(force(c));
    compute(set_of(contacts, 40.0));
    Matrix sum(3), moment(3);
    double largest = 0.0;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Matrix change = force(contacts[i]) - before[i];
      sum += change;
      moment += cross(place(contacts[i]), change);
      largest = std::max(largest, change.norm());
    }
    // The pushes cancel: neither the sum of all forces nor their moment changes, nor the CoM's
    // acceleration.
    EXPECT_LE(sum.norm(), 1e-8);
    EXPECT_LE(moment.norm(), 1e-8);
    EXPECT_GT(largest, 20.0);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(controller_->result().achieved[k], without.achieved[k], 1e-9);
      EXPECT_NEAR(without.achieved[k], 0.3 - 0.2 * static_cast<double>(k), 1e-9);
    }
  }
}

// Six tensions of four points in a plane fulfil one equation (a plane frame of four joints bears
// one stress of its own), and no tension changes a vertical force.
TEST_F(Quadruped, TensionsAndWarpAreTheCompleteBasisOnAPlane) {
  stand_level();
  compute(set_of({0, 1, 2, 3}, 0.0));
  const tasks::WboscSolution& out = controller_->primary().solution();
  EXPECT_EQ(12 - out.actuation_rank, 6);
  EXPECT_EQ(out.named_internal_rank, 5);
  EXPECT_EQ(out.internal_rank, 6);
  compute(set_of({0, 1, 2}, 0.0));
  EXPECT_EQ(out.named_internal_rank, 3);
  compute(set_of({0, 1}, 0.0));
  EXPECT_EQ(out.named_internal_rank, 1);
}

TEST_F(Quadruped, TheWarpLoadsOneDiagonalAndUnloadsTheOther) {
  stand_level();
  const std::vector<int> around = {0, 1, 3, 2};
  ControlSet set = set_of(around, 0.0);
  set.internal_count = 1;
  set.internals[0] = {.contact_count = 4, .contacts = {0, 1, 3, 2}};
  compute(set);
  const tasks::ControllerResult without = controller_->result();
  set.internals[0].reference = 20.0;
  compute(set);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto c = static_cast<std::size_t>(around[i]);
    const double change = controller_->result().force[c][2] - without.force[c][2];
    EXPECT_NEAR(change, i % 2 == 0 ? 20.0 : -20.0, 1e-7);
    EXPECT_NEAR(controller_->result().force[c][0], without.force[c][0], 1e-7);
    EXPECT_NEAR(controller_->result().force[c][1], without.force[c][1], 1e-7);
  }
  EXPECT_NEAR(controller_->result().internal[0], 20.0, 1e-8);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(controller_->result().achieved[k], without.achieved[k], 1e-9);
  }
}

TEST_F(Quadruped, AForceBetweenContactsThatDoNotHoldIsNotReported) {
  ControlSet set = set_of({0, 1}, 40.0);
  set.internals[1] = set.internals[0];
  set.internals[0] = {.contacts = {2, 3}, .reference = 10.0};
  set.internal_count = 2;
  compute(set);
  EXPECT_TRUE(std::isnan(controller_->result().internal[0]));
  EXPECT_NEAR(controller_->result().internal[1], 40.0, 1e-8);
}

}  // namespace
}  // namespace footfall::tests
