// Estimators by name, and what each makes of the sensors.
#include <gtest/gtest.h>

#include <stdexcept>

#include "engine/estimators/catalogue.h"

namespace footfall::engine {
namespace {

model::RobotDescription two_joints() {
  model::RobotDescription robot;
  robot.joints.resize(2);
  return robot;
}

TEST(Estimators, TheDefaultIsOneOfTheCatalogue) {
  EXPECT_NE(make_estimator(kDefaultEstimator, two_joints()), nullptr);
}
TEST(Estimators, AnUnknownNameIsAnErrorThatNamesTheNearest) {
  try {
    make_estimator("true_stat", two_joints());
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "unknown estimator 'true_stat' (did you mean 'true_state'?)");
  }
}
TEST(Estimators, NoneGivesAStateWithoutSensorDataAndTheStateStaysAsItWas) {
  for (const std::string& name : estimator_names()) {
    model::State state;
    state.p_WB = {1.0, 2.0, 3.0};
    state.q[1] = 0.5;
    EXPECT_FALSE(make_estimator(name, two_joints())->estimate(hal::Sensors{}, state)) << name;
    EXPECT_EQ(state.p_WB, (std::array<double, 3>{1.0, 2.0, 3.0})) << name;
    EXPECT_EQ(state.q[1], 0.5) << name;
  }
}
TEST(Estimators, TheTrueStateIsThatOfTheSimulator) {
  hal::Sensors sensors;
  sensors.has_truth = true;
  sensors.p_WB = {1.0, 2.0, 3.0};
  sensors.q_WB = {0.6, 0.8, 0.0, 0.0};
  sensors.v_WB = {4.0, 5.0, 6.0};
  sensors.w_WB_B = {7.0, 8.0, 9.0};
  sensors.q[1] = 0.25;
  sensors.qd[0] = -2.0;
  model::State state;
  EXPECT_TRUE(make_estimator("true_state", two_joints())->estimate(sensors, state));
  EXPECT_EQ(state.p_WB, sensors.p_WB);
  EXPECT_EQ(state.q_WB, sensors.q_WB);
  EXPECT_EQ(state.v_WB, sensors.v_WB);
  EXPECT_EQ(state.w_WB_B, sensors.w_WB_B);
  EXPECT_EQ(state.q[1], 0.25);
  EXPECT_EQ(state.qd[0], -2.0);
}

}  // namespace
}  // namespace footfall::engine
