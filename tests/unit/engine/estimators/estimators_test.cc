// Estimators by type, and what each makes of the sensors.
#include <gtest/gtest.h>

#include "engine/estimators/catalogue.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

TEST(Estimators, TheTrueStateIsThatOfTheSimulator) {
  const model::RobotDescription robot = load_hume();
  const model::ControlModel model(robot);
  const auto estimator = engine::make_estimator({}, robot, model);
  hal::Sensors sensors;
  engine::Estimate estimate;
  estimate.state.p_WB = {9.0, 9.0, 9.0};
  EXPECT_FALSE(estimator->estimate({sensors, model}, estimate));
  EXPECT_EQ(estimate.state.p_WB, (std::array<double, 3>{9.0, 9.0, 9.0}));
  sensors.has_truth = true;
  sensors.p_WB = {1.0, 2.0, 3.0};
  sensors.q_WB = {0.6, 0.8, 0.0, 0.0};
  sensors.v_WB = {4.0, 5.0, 6.0};
  sensors.w_WB_B = {7.0, 8.0, 9.0};
  sensors.q[1] = 0.25;
  sensors.qd[0] = -2.0;
  sensors.contact[1] = true;
  EXPECT_TRUE(estimator->estimate({sensors, model}, estimate));
  const model::State& state = estimate.state;
  EXPECT_EQ(state.p_WB, sensors.p_WB);
  EXPECT_EQ(state.q_WB, sensors.q_WB);
  EXPECT_EQ(state.v_WB, sensors.v_WB);
  EXPECT_EQ(state.w_WB_B, sensors.w_WB_B);
  EXPECT_EQ(state.q[1], 0.25);
  EXPECT_EQ(state.qd[0], -2.0);
  EXPECT_TRUE(estimate.contact[1]);
  sensors.sensor_truth = true;  // what is measured has errors
  sensors.true_q[1] = 0.24;
  EXPECT_TRUE(estimator->estimate({sensors, model}, estimate));
  EXPECT_EQ(state.q[1], 0.24);
}

}  // namespace
}  // namespace footfall::tests
