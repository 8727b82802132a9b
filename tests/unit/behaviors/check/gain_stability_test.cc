// Gains against the period. Oracles: the conditions of docs/behaviors.md 7.1 by hand (Jury), and
// the loop itself stepped through time, one physics step after the other.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "behaviors/check/physics/sampled_loop.h"
#include "tests/unit/behaviors/check/physics_test_support.h"

namespace footfall::tests {
namespace {

using behaviors::growth;
using behaviors::SampledLoop;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr double kPeriod = 1.0 / 1500.0;

SampledLoop simulated(double kp, double ki, double kd, int steps = 2, double delay = 0.0) {
  return {kp, ki, kd, kPeriod, steps, false, delay};
}
SampledLoop held(double kp, double ki, double kd) { return {kp, ki, kd, kPeriod, 1, true}; }

// How an error grows in a period, from the second half of many.
double stepped_growth(const SampledLoop& loop, int periods) {
  double x = 1e-3, v = 0.0, sum = 0.0, log_size = 0.0, log_half = 0.0;
  const double h = loop.period / loop.steps;
  std::deque<double> line(static_cast<std::size_t>(std::lround(loop.delay / h)), 0.0);
  for (int k = 0; k < periods; ++k) {
    if (loop.ki != 0.0) sum += x * loop.period;
    const double u = -loop.kp * x - loop.kd * v - loop.ki * sum;
    for (int s = 0; s < loop.steps; ++s) {
      line.push_back(u);
      const double a = line.front();
      line.pop_front();
      if (loop.exact) x += h * v + 0.5 * h * h * a;
      v += h * a;
      if (!loop.exact) x += h * v;
    }
    // Kept near 1 on the way.
    const double size = std::max(
        {std::abs(x), std::abs(v) * loop.period, std::abs(u) * loop.period * loop.period, 1e-200});
    log_size += std::log(size);
    for (double* value : {&x, &v, &sum}) *value /= size;
    for (double& value : line) value /= size;
    if (k == periods / 2) log_half = log_size;
  }
  return std::exp((log_size - log_half) / (periods - 1 - periods / 2));
}

TEST(SampledLoop, ATorqueHeldOverThePeriodNeedsDampingBeyondHalfAPeriodsDelay) {
  for (int i = 1; i <= 40; ++i) {
    for (int j = 1; j <= 40; ++j) {
      const double kd = 0.101 * i / kPeriod, kp = 0.1507 * j / (kPeriod * kPeriod);
      const bool stable = kd * kPeriod < 2.0 && kd > 0.5 * kp * kPeriod;
      EXPECT_EQ(growth(held(kp, 0.0, kd)) < 1.0, stable) << kp << ' ' << kd;
    }
  }
}

TEST(SampledLoop, OneSemiImplicitStepAPeriodSharesItsBoundBetweenTheGains) {
  for (int i = 1; i <= 40; ++i) {
    for (int j = 1; j <= 40; ++j) {
      const double kd = 0.0511 * i / kPeriod, kp = 0.1203 * j / (kPeriod * kPeriod);
      const bool stable = kd * kPeriod + 0.5 * kp * kPeriod * kPeriod < 2.0;
      EXPECT_EQ(growth(simulated(kp, 0.0, kd, 1)) < 1.0, stable) << kp << ' ' << kd;
    }
  }
}

// det = 1 - kd T + kp T²/4, 1 + tr + det = 4 - 2 kd T - kp T²/2.
TEST(SampledLoop, TwoStepsAPeriodAreBetweenTheTwo) {
  for (int i = 1; i <= 40; ++i) {
    for (int j = 1; j <= 40; ++j) {
      const double a = 0.0511 * i, b = 0.2003 * j;
      const bool stable = a > 0.25 * b && 2.0 * a + 0.5 * b < 4.0;
      EXPECT_EQ(growth(simulated(b / (kPeriod * kPeriod), 0.0, a / kPeriod)) < 1.0, stable);
    }
  }
}

TEST(SampledLoop, DampingAloneIsStableBelowTwoOverThePeriod) {
  EXPECT_LE(growth(held(0.0, 0.0, 1.999 / kPeriod)), 1.0);
  EXPECT_NEAR(growth(held(0.0, 0.0, 2.1 / kPeriod)), 1.1, 1e-9);
  EXPECT_NEAR(growth(simulated(0.0, 0.0, 2.1 / kPeriod)), 1.1, 1e-9);
}

TEST(SampledLoop, ASlowIntegralIsStableBelowTheProductOfTheOthers) {
  for (const double kp : {50.0, 200.0, 800.0}) {
    for (const double kd : {5.0, 10.0, 40.0}) {
      EXPECT_LT(growth(held(kp, 0.9 * kp * kd, kd)), 1.0);
      EXPECT_GT(growth(held(kp, 1.02 * kp * kd, kd)), 1.0);
    }
  }
}

// A rate needs no second integrator: ẋ = u with an integral that is summed before it is used.
TEST(SampledLoop, ARateIsJudgedByItsOwnMap) {
  for (int i = 1; i <= 30; ++i) {
    for (int j = 1; j <= 30; ++j) {
      const double a = 0.0711 * i, b = 0.1503 * j;
      SampledLoop loop = held(b / (kPeriod * kPeriod), 0.0, a / kPeriod);
      loop.is_rate = true;
      EXPECT_EQ(growth(loop) < 1.0, 2.0 * a + b < 4.0) << a << ' ' << b;
    }
  }
}

TEST(SampledLoop, GrowthIsThatOfTheLoopItselfWithIntegralsAndDelays) {
  for (const double kp : {3e2, 1e5, 2e6}) {
    for (const double kd : {20.0, 400.0, 2500.0}) {
      for (const double ki : {0.0, 1e4, 1e8}) {
        for (const double delay : {0.0, 1.0 / 3000.0, 2e-3}) {
          for (const int steps : {1, 2, 3}) {
            const SampledLoop loop = simulated(kp, ki, kd, steps, delay);
            const double expected = stepped_growth(loop, 40000);
            EXPECT_NEAR(growth(loop), expected, 2e-3 * expected)
                << kp << ' ' << ki << ' ' << kd << ' ' << delay << ' ' << steps;
          }
        }
      }
    }
  }
}

// The checks judge the most delay that a seed can draw, and none below it.
TEST(SampledLoop, MoreDelayNeverMakesALoopStable) {
  for (const double kp : {0.0, 50.0, 1e3, 3e4, 1e6}) {
    for (const double kd : {5.0, 100.0, 800.0, 2000.0, 2900.0}) {
      for (const double ki : {0.0, 0.5 * kp * kd}) {
        bool stable = true;
        for (int late = 0; late < 14; ++late) {
          const bool now = growth(simulated(kp, ki, kd, 2, late * kPeriod / 2.0)) <= 1.0 + 1e-9;
          EXPECT_TRUE(stable || !now) << kp << ' ' << ki << ' ' << kd << ' ' << late;
          stable = now;
        }
      }
    }
  }
}

std::string with_gains(const std::string& gains, const std::string& task = "height") {
  const std::string axes = "axes: [z], reference: entry, ";
  std::string tasks = "      height: {type: com_position, " + axes +
                      (task == "height" ? "gains: " + gains : "gains: {kp: 1}") + "}\n" +
                      attitude("[yaw, pitch, roll]") +
                      "      rest: {type: joint_damping, priority: 2, gains: " +
                      (task == "rest" ? gains : "{kd: 1}") + "}\n";
  return standing("[right_foot, left_foot]", tasks);
}

TEST(PhysicsGains, DampingBeyondTwoOverThePeriodIsRefused) {
  const std::string text = with_gains("{kp: 100, kd: 5000}");
  const std::string said = physics(text);
  EXPECT_THAT(
      said, StartsWith(place_of(text, "z], ref") + "error: task 'height' is unstable in 'z': kd "
                                                   "5000 1/s is too much for a period of 0.667 ms: "
                                                   "an error grows 2.33 times in each period; kd "
                                                   "3000 1/s is the most"));
  EXPECT_THAT(physics(with_gains("{kp: 100, kd: 2990}")), Not(HasSubstr("unstable")));
  EXPECT_THAT(physics(with_gains("{kp: 100, kd: 3005}")),
              HasSubstr("error: task 'height' is unst"));
}

TEST(PhysicsGains, JointDampingIsAmongThem) {
  EXPECT_THAT(physics(with_gains("{kd: 4000}", "rest")),
              HasSubstr("error: task 'rest' is unstable in 'right_abduction': kd 4000 1/s"));
  EXPECT_EQ(physics(with_gains("{kd: 2900}", "rest")), "");
}

TEST(PhysicsGains, AStiffnessWithoutTheDampingThatSamplingCostsIsRefused) {
  EXPECT_THAT(physics(with_gains("{kp: 1e7, kd: 100}")),
              HasSubstr("error: task 'height' is unstable in 'z': kp 1e+07 1/s^2"));
  EXPECT_THAT(physics(with_gains("{kp: 1e7}")), HasSubstr("error: task 'height' is unstable"));
  // Half a period's delay on a robot, a quarter in simulation: 1e5 needs 33 and 17.
  EXPECT_THAT(physics(with_gains("{kp: 1e5, kd: 34}")), Not(HasSubstr("unstable")));
  EXPECT_THAT(physics(with_gains("{kp: 1e5, kd: 20}")),
              HasSubstr("warning: task 'height' is unstable in 'z' on a robot, which holds its "
                        "torque over the whole period: kp 100000 1/s^2"));
  EXPECT_THAT(physics(with_gains("{kp: 1e5, kd: 16}")), HasSubstr("error: task 'height'"));
}

TEST(PhysicsGains, AnIntegralBeyondTheProductOfTheOthersIsRefused) {
  const std::string said = physics(with_gains("{kp: 100, ki: 600, kd: 5}"));
  EXPECT_THAT(said, HasSubstr("error: task 'height' is unstable in 'z': ki 600 1/s^3"));
  EXPECT_THAT(said, HasSubstr("ki 49"));  // 500, less what sampling costs
  EXPECT_THAT(said, HasSubstr("is the most with kp 100 and kd 5"));
  EXPECT_EQ(physics(with_gains("{kp: 100, ki: 490, kd: 5}")), "");
}

// It swings for ever, and grows more slowly than the robot falls by itself.
// 2 kd T + kp T^2 / 2 < 4 with the two steps of the default world.
TEST(PhysicsGains, TheMostIsThatWithTheOthersAsTheyAre) {
  const double most = 2.0 / kPeriod - 0.25 * 1e6 * kPeriod;
  EXPECT_THAT(physics(with_gains("{kp: 1e6, kd: 5000}")),
              HasSubstr(fmt::format("; kd {:.4g} 1/s is the most with kp 1e+06\n", most)));
  EXPECT_NEAR(most, 2833.3, 0.1);
  EXPECT_GT(growth(simulated(1e6, 0.0, 1.001 * most)), 1.0);
  EXPECT_LT(growth(simulated(1e6, 0.0, 0.999 * most)), 1.0);
  // 3000 - 1e2 / 6000, which is not 3000.
  EXPECT_THAT(
      physics(with_gains("{kp: 100, kd: 3000}")),
      HasSubstr(": kd 3000 1/s is too much for a period of 0.667 ms: an error grows by e in "));
  EXPECT_THAT(physics(with_gains("{kp: 100, kd: 3000}")),
              HasSubstr("; kd 2999.983 1/s is the most with kp 100\n"));
  // With kp 1e7 no kd is: kd T > kp T^2 / 4 = 1.11 contradicts kd T < 2 - kp T^2 / 4 = 0.89.
  EXPECT_THAT(physics(with_gains("{kp: 1e7, kd: 5000}")),
              HasSubstr("; kd 3000 1/s is the most without kp\n"));
  EXPECT_THAT(physics(with_gains("{kp: 100, ki: 600, kd: 5}")),
              HasSubstr(", or kp must be above 1"));
  EXPECT_THAT(physics(with_gains("{ki: 20, kd: 10}")),
              testing::AllOf(HasSubstr("; kp must be above 1.99 1/s^2 with ki 20 and kd 10\n"),
                             Not(HasSubstr("is the most"))));
}

TEST(PhysicsGains, ALawWithoutDampingIsNotRefusedForThat) {
  EXPECT_EQ(physics(with_gains("{kp: 400}")), "");
  EXPECT_EQ(physics(with_gains("{kp: 100, ki: 20}")), "");
  EXPECT_EQ(physics(with_gains("{kp: 0, kd: 0}")), "");
}

// 9.81 m/s^2 at 1 mm and 1 cm/s: kd 981 alone, or kp 9810.
TEST(PhysicsGains, AHeightThatAsksForMoreThanGravityAtSmallErrorsIsWarnedOf) {
  const std::string text = with_gains("{kp: 2000, kd: 900}");
  EXPECT_THAT(physics(text),
              StartsWith(place_of(text, "z], ref") +
                         "warning: task 'height' asks for 11 m/s^2 when the CoM is 1 mm too high"));
  EXPECT_EQ(physics(with_gains("{kp: 100, kd: 970}")), "");
  EXPECT_EQ(physics(with_gains("{kp: 2000, kd: 900}, acceleration_limit: 5 m/s^2")), "");
  EXPECT_THAT(physics(with_gains("{kp: 2000, kd: 900}, acceleration_limit: 10 m/s^2")),
              HasSubstr("warning: task 'height' asks for 10 m/s^2 when the CoM"));
  EXPECT_EQ(
      physics(with_gains("{kp: 2000, kd: 900}, acceleration_limit: \"= 20 m/s^2*(1 - t/1 s)\"")),
      "");
  EXPECT_EQ(physics(with_gains("{kd: 2000}", "rest")), "");
}

// Hume's feet stand 0.28 m apart below a CoM at about 0.91 m: 9.81 * 0.14 / 0.91 = 1.5 m/s^2.
TEST(PhysicsGains, ACoMThatAsksForMoreThanTheFeetGiveAlongTheirLineIsWarnedOf) {
  const auto with = [](const std::string& gains, const std::string& axis = "y") {
    return standing("[right_foot, left_foot]",
                    height() + attitude("[pitch, roll]") +
                        "      shift: {type: com_position, axes: [" + axis +
                        "], priority: 2, reference: entry, gains: " + gains + "}\n" + rest());
  };
  const std::string said = physics(with("{kp: 100, kd: 300}"));
  EXPECT_THAT(said,
              HasSubstr("warning: task 'shift' asks for 3.1 m/s^2 in 'y' when the CoM is 1 mm "
                        "away and 1 cm/s too fast (kp 100, kd 300): feet cannot pull, so "
                        "beyond 1."));
  const std::size_t beyond = said.find("beyond ");
  ASSERT_NE(beyond, std::string::npos);
  EXPECT_NEAR(std::stod(said.substr(beyond + 7)), 1.5, 0.05);
  EXPECT_THAT(physics(with("{kp: 100, kd: 130}")), Not(HasSubstr("asks for")));
  EXPECT_THAT(physics(with("{kp: 100, kd: 300}, acceleration_limit: 1 m/s^2")),
              Not(HasSubstr("asks for")));
  EXPECT_THAT(physics(with("{kp: 100, kd: 300}, acceleration_limit: 2 m/s^2")),
              HasSubstr("asks for 2 m/s^2 in 'y'"));
}

std::string tabled(const std::string& gains, const std::string& ranges) {
  return "behavior: 1\nrobot: hume\ngains:\n  ranges: " + ranges + "\n  s: {height: " + gains +
         ", attitude: {kp: 10}, rest: {kd: 1}}\nstacks:\n  s:\n    contacts: [right_foot, "
         "left_foot]\n    gains: s\n    tasks:\n      height: {type: com_position, axes: [z], "
         "reference: entry}\n      attitude: {type: body_orientation, reference: 0}\n      rest: "
         "{type: joint_damping, priority: 2}\nmachine:\n  stack: s\n  states: {stand: {doc: "
         "here}}\n";
}

TEST(PhysicsGains, EachEndOfALiveGainsRangeIsJudged) {
  EXPECT_EQ(
      physics(tabled("{kp: 270, ki: 20, kd: 10}", "{kp: [5, 800], ki: [0, 200], kd: [0, 120]}")),
      "");
  EXPECT_EQ(physics(tabled("{kp: 270, kd: 10}", "{kp: [0, 800], kd: [0, 120]}")), "");
  EXPECT_THAT(physics(tabled("{kp: 270, kd: 10}", "{kd: [0, 5000]}")),
              HasSubstr("warning: task 'height' is unstable in 'z' at the end of the range of "
                        "'gains.s.height.kd': kd 5000 1/s"));
  EXPECT_THAT(physics(tabled("{kp: 270, ki: 20, kd: 10}", "{ki: [0, 4000]}")),
              HasSubstr("at the end of the range of 'gains.s.height.ki': ki 4000 1/s^3"));
  EXPECT_THAT(physics(tabled("{kp: 270, ki: 20, kd: 10}", "{kp: [1, 800]}")),
              HasSubstr("at the end of the range of 'gains.s.height.kp': ki 20 1/s^3"));
  EXPECT_THAT(physics(tabled("{kp: 270, ki: 20, kd: 10}", "{kp: [0, 800]}")),
              HasSubstr("kp must be above 1.99 1/s^2 with ki 20 and kd 10"));
}

TEST(PhysicsGains, AGainFromAParameterIsJudgedAtTheEndsOfItsRange) {
  const std::string text = with_gains("{kp: 100, kd: \"= 2 * $d\"}");
  const auto with = [&text](const std::string& parameter) {
    std::string out = text;
    return out.replace(out.find("robot: hume\n"), 12,
                       "robot: hume\nparameters: {d: " + parameter + "}\n");
  };
  EXPECT_EQ(physics(with("{value: 10 1/s, range: [1 1/s, 100 1/s], live: true}")), "");
  EXPECT_THAT(
      physics(with("{value: 10 1/s, range: [1 1/s, 2000 1/s], live: true}")),
      HasSubstr("warning: task 'height' is unstable in 'z' at the end of the range of 'd'"));
  EXPECT_THAT(physics(with("2000 1/s")), HasSubstr("error: task 'height' is unstable in 'z': kd"));
}

// The world may be late, or step the physics differently.
TEST(PhysicsGains, TheWorldsDelayCounts) {
  const std::string text = with_gains("{kp: 4000, kd: 10}");
  EXPECT_EQ(judged_in(text, {}), "");
  EXPECT_THAT(judged_in(text, {.command_delay = 4e-3}),
              HasSubstr("period of 0.667 ms and a delay of 4 ms: an error grows by e in "));
}

}  // namespace
}  // namespace footfall::tests
