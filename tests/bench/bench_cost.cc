// What a control tick costs, against a physics step of the same robot standing, in one process:
// rounds of every part in turn, the lowest round of each counts. The algebra is also compared with
// Appendix A taken literally (naive); its share of the mass matrix factorisation is counted in.
// Needs about 15 s. `--profile dual|single|tension`: 20000 ticks and nothing else, for callgrind.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/bench/algebra_cases.h"
#include "tests/bench/timing.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rig.h"

namespace footfall::tests {
namespace {

constexpr int kRounds = 11;
constexpr int kCalls = 3000;       // of the allocation count
constexpr int kStates = 64;        // recorded, gone through in turn
constexpr int kPacedTicks = 3000;  // of each stance
constexpr long kPeriodNs = 666'667;

// Table I's two laws, each for ever; and the first with its tension fed back.
constexpr const char* kStances = R"(
behavior: 1
robot: hume
stacks:
  dual:
    contacts: [right_foot, left_foot]
    tasks:
      height: {type: com_position, axes: [z], priority: 1, reference: 0.91 m, gains: {kp: 270, ki: 20, kd: 10}}
      attitude: {type: body_orientation, axes: [yaw, pitch, roll], priority: 1, reference: 0, gains: {kp: [100, 200, 210], ki: [0, 20, 35], kd: [0, 15, 10]}}
      rest: {type: joint_damping, priority: 2, gains: {kd: 2}}
  single:
    contacts: [right_foot]
    tasks:
      height: {type: com_position, axes: [z], priority: 1, reference: 0.91 m, gains: {kp: 270, ki: 20, kd: 10}}
      attitude: {type: body_orientation, axes: [pitch, roll], priority: 1, reference: 0, gains: {kp: [200, 210], ki: [20, 35], kd: [15, 10]}}
      swing: {type: point_position, point: left_foot, priority: 1, reference: {trajectory: hold}, gains: {kp: [220, 237, 400], ki: [35, 40, 35], kd: [35, 40, 60]}}
machine:
  safe: limp
  states:
    stance: {stack: STANCE}
    limp: {contacts: [], tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}}
)";

// Sensors of the simulated robot standing on two feet, and the same with the left foot lifted.
struct Recording {
  std::vector<hal::Sensors> dual, single;
};

Recording record() {
  constexpr int kEvery = 7;  // ticks
  Rig rig("balance");
  rig.loop->start();
  Recording r;
  for (int tick = 0; tick < 2 * kEvery * kStates && r.dual.size() < kStates; ++tick) {
    rig.loop->tick();
    hal::Sensors sensors = rig.loop->sensors();
    if (tick % kEvery != 0 || !sensors.contact[0] || !sensors.contact[1]) continue;
    r.dual.push_back(sensors);
    sensors.contact[1] = false;
    sensors.q[4] -= 0.15;
    sensors.q[5] += 0.3 + 1e-3 * static_cast<double>(r.single.size());
    sensors.qd[5] += 0.5;
    r.single.push_back(sensors);
  }
  if (r.dual.size() < kStates) throw std::runtime_error("the robot did not stand long enough");
  return r;
}

// Hands out the recorded sensors in turn; commands go nowhere.
class Playback final : public hal::Hardware {
 public:
  explicit Playback(const std::vector<hal::Sensors>& frames) : frames_(frames) {}
  std::string name() const override { return "playback"; }
  void start() override {}
  bool read(hal::Sensors& sensors) noexcept override {
    sensors = frames_[next_++ % frames_.size()];
    return true;
  }
  void write(const hal::Commands& commands) noexcept override { last_ = commands.tau[0]; }
  void safe_stop() noexcept override {}

 private:
  const std::vector<hal::Sensors>& frames_;
  std::size_t next_ = 0;
  double last_ = 0.0;
};

struct Stance {
  std::unique_ptr<behaviors::Behavior> behavior;
  std::unique_ptr<Playback> playback;
  std::unique_ptr<engine::ControlLoop> loop;

  Stance(const std::string& name, const std::vector<hal::Sensors>& frames) {
    std::string text = kStances;
    // `tension` is `dual` with its internal force fed back.
    const char* const force =
        "dual, internal: {tension: {between: [right_foot, left_foot], reference: 20 N, feedback: "
        "2, integral: 5 1/s}}";
    text.replace(text.find("STANCE"), 6, name == "tension" ? force : name.c_str());
    const auto path = std::filesystem::temp_directory_path() / ("footfall_bench_" + name + ".yaml");
    std::ofstream(path) << text;
    core::Diagnostics diagnostics;
    behaviors::LoadOptions options;
    options.search = {FOOTFALL_SOURCE_DIR};
    behavior = behaviors::load_behavior(path.string(), options, diagnostics);
    std::filesystem::remove(path);
    if (!behavior) throw std::runtime_error(diagnostics.to_string());
    playback = std::make_unique<Playback>(frames);
    loop = std::make_unique<engine::ControlLoop>(*behavior, *playback, engine::LoopSettings{});
    loop->start();
  }
};

// MuJoCo with its own copy of the physics scene.
class Physics {
 public:
  explicit Physics(const std::vector<hal::Sensors>& frames) : rig_("balance"), frames_(frames) {
    rig_.backend->start();
  }
  mjModel* model() { return rig_.backend->model(); }
  mjData* data() { return rig_.backend->data(); }
  // Sets a recorded standing state and advances it by one physics step under its torques.
  void step() {
    const hal::Sensors& s = frames_[next_++ % frames_.size()];
    mjData* d = data();
    std::copy_n(s.p_WB.data(), 3, d->qpos);
    std::copy_n(s.q_WB.data(), 4, d->qpos + 3);
    std::copy_n(s.q.data(), 6, d->qpos + 7);
    std::copy_n(s.v_WB.data(), 3, d->qvel);
    std::copy_n(s.w_WB_B.data(), 3, d->qvel + 3);
    std::copy_n(s.qd.data(), 6, d->qvel + 6);
    std::copy_n(s.tau.data(), 6, d->ctrl);
    mj_step(model(), d);
    contacts_ += d->ncon;
    ++steps_;
  }
  double mean_contacts() const {
    return static_cast<double>(contacts_) / static_cast<double>(steps_);
  }

 private:
  Rig rig_;
  const std::vector<hal::Sensors>& frames_;
  std::size_t next_ = 0;
  long contacts_ = 0, steps_ = 0;
};

// Thread CPU time of ticks at their real pace, sleeping in between.
std::vector<double> paced(engine::ControlLoop& loop) {
  std::vector<double> us;
  timespec next{};
  clock_gettime(CLOCK_MONOTONIC, &next);
  for (int i = 0; i < kPacedTicks; ++i) {
    next.tv_nsec += kPeriodNs;
    if (next.tv_nsec >= 1'000'000'000) {
      next.tv_nsec -= 1'000'000'000;
      ++next.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
    const double start = now_us(CLOCK_THREAD_CPUTIME_ID);
    loop.tick();
    us.push_back(now_us(CLOCK_THREAD_CPUTIME_ID) - start);
  }
  return us;
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

int profile(const std::string& name) {
  const Recording recording = record();
  Stance stance(name, name == "single" ? recording.single : recording.dual);
  for (int i = 0; i < 20000; ++i) stance.loop->tick();
  return 0;
}

enum {
  kDual,
  kTension,
  kSingle,
  kStep,
  kFactor,
  kUpdate,
  kWbosc2,
  kWbosc1,
  kNaive2,
  kNaive1,
  kPartCount
};
using Parts = std::array<Part, kPartCount>;

// Figures of one stance: `tick`, `wbosc` and `naive` are its places in `parts`.
nlohmann::ordered_json stance_json(const Parts& parts, std::size_t tick, std::size_t wbosc,
                                   std::size_t naive, double difference) {
  const double algebra = parts[wbosc].lowest() + parts[kFactor].lowest();
  return nlohmann::ordered_json{
      {"tick_us", rounded(parts[tick].lowest())},
      {"tick_median_us", rounded(parts[tick].median())},
      {"mj_step_us", rounded(parts[kStep].lowest())},
      {"mj_step_median_us", rounded(parts[kStep].median())},
      {"tick_over_mj_step", rounded(parts[tick].lowest() / parts[kStep].lowest())},
      {"tick_over_mj_step_median", rounded(parts[tick].median() / parts[kStep].median())},
      {"model_us", rounded(parts[kUpdate].lowest())},
      {"wbosc_us", rounded(algebra)},
      {"naive_us", rounded(parts[naive].lowest())},
      {"naive_over_reduced", rounded(parts[naive].lowest() / algebra)},
      {"naive_over_reduced_median",
       rounded(parts[naive].median() / (parts[wbosc].median() + parts[kFactor].median()))},
      {"torque_difference", difference}};
}

long allocations_of(engine::ControlLoop& dual, engine::ControlLoop& tension,
                    engine::ControlLoop& single) {
  const AllocationGuard guard;
  for (int i = 0; i < kCalls; ++i) {
    dual.tick();
    tension.tick();
    single.tick();
  }
  return guard.allocations();
}

int run() {
  const Recording recording = record();
  Stance dual("dual", recording.dual), tension("tension", recording.dual);
  Stance single("single", recording.single);
  Algebra dual_algebra(true), single_algebra(false);
  Physics physics(recording.dual);
  const model::RobotDescription robot = load_hume();
  model::ControlModel control_model(robot);
  std::vector<model::State> states;
  Random random(3);
  for (int i = 0; i < kStates; ++i) states.push_back(random_state(robot, random));

  const auto at = [](int i, std::size_t n) { return static_cast<std::size_t>(i) % n; };
  const auto solve = [&](Algebra& a) {
    return [&a, at](int i) { a.cases[at(i, kProblems)].solver->solve(); };
  };
  const auto literal = [&](Algebra& a) {
    return [&a, at](int i) { naive_wbosc(a.cases[at(i, kProblems)].naive); };
  };
  Parts parts;
  parts[kDual].call = [&](int) { dual.loop->tick(); };
  parts[kTension].call = [&](int) { tension.loop->tick(); };
  parts[kSingle].call = [&](int) { single.loop->tick(); };
  parts[kStep].call = [&](int) { physics.step(); };
  parts[kFactor].call = [&](int) { mj_factorM(physics.model(), physics.data()); };
  parts[kUpdate].call = [&](int i) { control_model.update(states[at(i, kStates)]); };
  parts[kWbosc2].call = solve(dual_algebra);
  parts[kWbosc1].call = solve(single_algebra);
  parts[kNaive2].call = literal(dual_algebra);
  parts[kNaive1].call = literal(single_algebra);
  for (Part& part : parts) {
    for (int i = 0; i < 500; ++i) part.call(i);
  }
  for (int round = 0; round < kRounds; ++round) {
    for (Part& part : parts) part.round();
  }

  const long allocations = allocations_of(*dual.loop, *tension.loop, *single.loop);
  std::vector<double> pace = paced(*dual.loop);
  const std::vector<double> more = paced(*single.loop);
  pace.insert(pace.end(), more.begin(), more.end());

  const nlohmann::ordered_json result = {
      {"dual", stance_json(parts, kDual, kWbosc2, kNaive2, dual_algebra.torque_difference)},
      {"single", stance_json(parts, kSingle, kWbosc1, kNaive1, single_algebra.torque_difference)},
      {"tension",
       {{"tick_us", rounded(parts[kTension].lowest())},
        {"over_dual", rounded(parts[kTension].lowest() / parts[kDual].lowest())},
        {"over_dual_median", rounded(parts[kTension].median() / parts[kDual].median())}}},
      {"mj_step_contacts", rounded(physics.mean_contacts())},
      {"allocations", allocations},
      {"paced_tick_us", rounded(percentile(pace, 0.5))},
      {"paced_tick_percentiles_us",
       {{"p50", rounded(percentile(pace, 0.5))},
        {"p99", rounded(percentile(pace, 0.99))},
        {"p999", rounded(percentile(pace, 0.999))}}}};
  std::printf("%s\n", result.dump(2).c_str());
  return 0;
}

}  // namespace
}  // namespace footfall::tests

int main(int argc, char** argv) {
  try {
    if (argc == 3 && std::string(argv[1]) == "--profile") return footfall::tests::profile(argv[2]);
    return footfall::tests::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_cost: %s\n", error.what());
    return 4;
  }
}
