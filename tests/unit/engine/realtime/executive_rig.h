// What an executive is tested with: a robot that counts its stops, an observer that may throw, a
// live port and a source of loops that write down what they are asked.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "behaviors/compiled/take_over_map.h"
#include "engine/realtime/executive.h"
#include "tests/support/fake_robot.h"

namespace footfall::tests {

inline constexpr const char* kHang = R"(
behavior: 1
robot: hume
machine:
  reload: ok
  safe: limp
  states:
    hang: {contacts: [], tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}}
    limp: {contacts: []}
)";

// Counts what it is told, may do something at a tick, and ends the run after some.
class Watcher final : public engine::TickObserver {
 public:
  explicit Watcher(std::int64_t last) : last_(last) { done.reserve(100); }
  void started(engine::ControlLoop& /*loop*/) override { done += "start "; }
  bool ends(const engine::ControlLoop& loop) override { return loop.ticks() >= last_; }
  void before_tick(engine::ControlLoop& loop) override {
    ++before;
    if (at_tick) at_tick(loop);
  }
  void after_compute(engine::ControlLoop& loop) override {
    ++after;
    if (at_compute) at_compute(loop);
  }
  void withdrawn(engine::ControlLoop& /*loop*/) override { done += "withdrawn "; }
  void exchanged(engine::ControlLoop& now) override {
    done += now.behavior().name == "inline" ? "exchanged " : "";
  }

  std::function<void(engine::ControlLoop&)> at_tick, at_compute;
  int before = 0, after = 0;
  std::string done;

 private:
  std::int64_t last_;
};

// Hardware that counts its stops.
class Stops final : public hal::Hardware {
 public:
  explicit Stops(hal::Hardware& real) : real_(real) {}
  std::string name() const override { return real_.name(); }
  void start() override {
    if (broken) throw std::runtime_error("no robot there");
    real_.start();
  }
  bool read(hal::Sensors& sensors) noexcept override { return real_.read(sensors); }
  void write(const hal::Commands& commands) noexcept override {
    ++writes;
    real_.write(commands);
  }
  void safe_stop() noexcept override {
    ++stops;
    real_.safe_stop();
  }
  bool broken = false;
  int writes = 0, stops = 0;

 private:
  hal::Hardware& real_;
};

struct Robot {
  StubRig rig{kHang};
  Stops hardware{*rig.hardware};
  engine::ControlLoop loop{*rig.behavior, hardware, engine::LoopSettings{}};
};

// A live port that writes down what it is asked.
class FakePort final : public engine::LivePort {
 public:
  struct Binding final : engine::LiveBinding {
    engine::ControlLoop* loop = nullptr;
  };
  void start() override {
    if (broken) throw std::runtime_error("no network");
    calls += "start ";
  }
  void post(const engine::ControlLoop& loop, std::int64_t /*tick_ns*/) noexcept override {
    ++posts;
    last = &loop;
  }
  void stop() noexcept override { calls += "stop "; }
  std::unique_ptr<engine::LiveBinding> prepare(engine::ControlLoop& loop) const override {
    auto binding = std::make_unique<Binding>();
    binding->loop = &loop;
    return binding;
  }
  void rebind(std::unique_ptr<engine::LiveBinding> binding) noexcept override {
    bound = std::move(binding);
    free = false;
  }
  bool rebound() const noexcept override { return free; }

  std::string calls;
  std::unique_ptr<engine::LiveBinding> bound;
  bool broken = false, free = true;
  int posts = 0;
  const engine::ControlLoop* last = nullptr;
};

// Another loop takes over at a tick, and is taken back when it fails.
class Exchange final : public engine::LoopExchange {
 public:
  Exchange(engine::ControlLoop& first, std::unique_ptr<behaviors::Behavior> next,
           hal::Hardware& hardware, const engine::LivePort* port, std::int64_t at)
      : first_(first),
        behavior_(std::move(next)),
        there_(behaviors::map_take_over(first.behavior(), *behavior_)),
        back_(behaviors::map_take_over(*behavior_, first.behavior())),
        next_(*behavior_, hardware, engine::LoopSettings{}),
        at_(at) {
    if (port == nullptr) return;
    bindings_.push_back(port->prepare(first_));
    bindings_.push_back(port->prepare(next_));
  }
  engine::ControlLoop* swap() override {
    if (broken) throw std::runtime_error("the reload broke");
    if (swapped_ || first_.ticks() < at_) return nullptr;
    swapped_ = true;
    next_.take_over(first_, there_, engine::ValueChange::ramped);
    next_.set_probation(true);
    return &next_;
  }
  engine::ControlLoop* take_back() override {
    first_.take_over(next_, back_, engine::ValueChange::at_once);
    return &first_;
  }
  std::unique_ptr<engine::LiveBinding> take_binding() override {
    auto binding = std::move(bindings_.back());
    bindings_.pop_back();
    return binding;
  }
  engine::ControlLoop& next() { return next_; }
  bool broken = false;

 private:
  engine::ControlLoop& first_;
  std::unique_ptr<behaviors::Behavior> behavior_;
  behaviors::TakeOverMap there_, back_;
  engine::ControlLoop next_;
  std::int64_t at_;
  bool swapped_ = false;
  std::vector<std::unique_ptr<engine::LiveBinding>> bindings_;
};

}  // namespace footfall::tests
