// A foot that slides: what counts as a slide, and what does not. Hume on both feet; states and
// measured torques are made by hand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "engine/tick/feet_watch.h"
#include "tests/support/hume.h"
#include "tests/support/hume_control.h"

namespace footfall::tests {
namespace {

using core::Fault;
using Force = std::array<double, 3>;

TEST(ConeUse, IsOneAtTheEdgeOfTheConeOnAnySlope) {
  const double s = std::sqrt(0.5);
  const Force up = {0.0, 0.0, 1.0}, slope = {s, 0.0, s};
  EXPECT_DOUBLE_EQ(engine::cone_use({30.0, 40.0, 100.0}, up, 0.5), 1.0);
  EXPECT_DOUBLE_EQ(engine::cone_use({0.0, 0.0, 100.0}, up, 0.5), 0.0);
  EXPECT_NEAR(engine::cone_use({0.0, 0.0, 100.0}, slope, 1.0), 1.0, 1e-12);  // 45 degrees
  EXPECT_NEAR(engine::cone_use({70.0, 0.0, 70.0}, slope, 1.0), 0.0, 1e-12);
  EXPECT_TRUE(std::isinf(engine::cone_use({1.0, 0.0, -1.0}, up, 0.5)));
}

class Slip : public testing::Test {
 protected:
  Slip() {
    behavior_.robot = load_hume();
    set_.contact_count = 2;
    set_.contacts = {kRightFoot, kLeftFoot};
    result_.force_measured[kRightFoot] = {50.0, 0.0, 100.0};  // 0.56 of the cone at 0.9
    result_.force_measured[kLeftFoot] = {1.0, 0.0, 100.0};
  }

  // The whole robot moves along x; ticks until the fault, -1: none within a second.
  int ticks_at(double speed, double turning = 0.0) {
    model::State state = standing_state(behavior_.robot);
    state.v_WB[0] = speed;
    state.w_WB_B[1] = turning;
    model_.update(state);
    for (int n = 0; n < 1500; ++n) {
      if (watch_.check(set_, model_, result_).has(Fault::slip)) return n;
    }
    return -1;
  }

  behaviors::Behavior behavior_;
  model::ControlModel model_{load_hume()};
  engine::SlipWatch watch_{behavior_};
  tasks::ControlSet set_;
  tasks::ControllerResult result_;
};

// The way is v tau (1 - exp(-t/tau)) with tau = 0.2 s: 1 cm at 0.1 m/s after tau ln 2.
TEST_F(Slip, OneCentimetreOfFastMotionIsASlide) {
  EXPECT_NEAR(ticks_at(0.1), 0.2 * std::log(2.0) * 1500.0, 2.0);
}

TEST_F(Slip, ACreepIsNone) {
  EXPECT_EQ(ticks_at(0.0005), -1);  // the simulator's, on 45 degrees
  EXPECT_EQ(ticks_at(0.049), -1);   // never reaches 1 cm
}

TEST_F(Slip, AFootThatIsNotPushedAlongTheGroundHasNoCauseToSlide) {
  result_.force_measured[kRightFoot] = {1.0, 0.0, 100.0};
  EXPECT_EQ(ticks_at(0.1), -1);
}

TEST_F(Slip, AFootThatIsPutDownBeginsAnew) {
  ASSERT_GT(ticks_at(0.1), 0);
  set_.contact_count = 0;
  watch_.check(set_, model_, result_);
  set_.contact_count = 2;
  EXPECT_FALSE(watch_.check(set_, model_, result_).has(Fault::slip));
}

}  // namespace
}  // namespace footfall::tests
