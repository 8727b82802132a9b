// A swing foot on the ground: counted when it bears load for more than half of its phase.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/fake_robot.h"

namespace footfall::tests {
namespace {

using core::Fault;

constexpr int kPhase = 30;  // ticks: 20 ms at 1500 Hz
constexpr int kLeft = 1;

// Both feet, the left one in the air for kPhase ticks, and so on.
std::string stepping(const std::string& swing_contacts, const std::string& mark) {
  return fmt::format(R"(
behavior: 1
robot: hume
machine:
  tasks: {{rest: {{type: joint_damping, priority: 1, gains: {{kd: 5}}}}}}
  states:
    dual: {{contacts: [right_foot, left_foot], {}after: 20 ms, to: swing}}
    swing: {{contacts: {}, after: 20 ms, to: dual}}
)",
                     mark, swing_contacts);
}

// The left foot touches the ground in the first `loaded` ticks of each swing.
std::int64_t faults_of(const std::string& text, int loaded, int ticks,
                       Fault fault = Fault::swing_contact) {
  StubRig rig(text, 1e6);
  rig.hardware->spoil = [loaded](hal::Sensors& sensors, std::int64_t tick) {
    const std::int64_t in_cycle = tick % (2 * kPhase);
    sensors.contact[kLeft] = in_cycle < kPhase + loaded;
  };
  rig.loop->start();
  for (int k = 0; k < ticks; ++k) rig.loop->tick();
  return rig.faults(fault);
}

TEST(SwingWatch, AFootThatBearsLoadForMoreThanHalfOfItsSwingIsCountedOnceASwing) {
  const std::string text = stepping("[right_foot]", "on_entry: [{mark: step}], ");
  EXPECT_EQ(faults_of(text, kPhase, 6 * kPhase + 5), 3);
  EXPECT_EQ(faults_of(text, kPhase / 2 + 2, 6 * kPhase + 5), 3);
  EXPECT_EQ(faults_of(text, kPhase / 2 - 2, 6 * kPhase + 5), 0);
  EXPECT_EQ(faults_of(text, 0, 6 * kPhase + 5), 0);
}

// The sensors of a tick are those before it: the foot is back one tick after the law takes it, or
// with it.
TEST(SwingWatch, AFootThatIsTakenBackInTheAirIsCountedOnceASwing) {
  const std::string text = stepping("[right_foot]", "on_entry: [{mark: step}], ");
  EXPECT_EQ(faults_of(text, 0, 6 * kPhase + 5, Fault::load_air), 0);
  StubRig rig(text, 1e6);
  rig.hardware->spoil = [](hal::Sensors& sensors, std::int64_t tick) {
    sensors.contact[kLeft] = tick % (2 * kPhase) > 1 && tick % (2 * kPhase) < kPhase;
  };
  rig.loop->start();
  for (int k = 0; k < 6 * kPhase + 5; ++k) rig.loop->tick();
  EXPECT_EQ(rig.faults(Fault::load_air), 3);
  EXPECT_EQ(rig.loop->last_place(Fault::load_air).joint, kLeft);
}

TEST(SwingWatch, OnlyOfABehaviorThatStepsAndWhileAnotherFootHolds) {
  EXPECT_EQ(faults_of(stepping("[right_foot]", ""), kPhase, 6 * kPhase), 0);
  EXPECT_EQ(faults_of(stepping("[]", "on_entry: [{mark: step}], "), kPhase, 6 * kPhase), 0);
}

// A phase that does not end is judged when half of limits.swing (1 s) was under load.
TEST(SwingWatch, AFootThatIsNeverTakenBackIsCountedAfterHalfOfTheLimit) {
  StubRig rig(R"(
behavior: 1
robot: hume
machine:
  tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}
  states: {swing: {contacts: [right_foot], on_entry: [{mark: step}]}}
)",
              1e6);
  rig.hardware->spoil = [](hal::Sensors& sensors, std::int64_t) { sensors.contact[kLeft] = true; };
  rig.loop->start();
  for (int k = 0; k < 750; ++k) rig.loop->tick();
  EXPECT_EQ(rig.faults(Fault::swing_contact), 0);
  for (int k = 0; k < 50; ++k) rig.loop->tick();
  EXPECT_EQ(rig.faults(Fault::swing_contact), 1);
  EXPECT_EQ(rig.loop->last_place(Fault::swing_contact).joint, kLeft);
}

}  // namespace
}  // namespace footfall::tests
