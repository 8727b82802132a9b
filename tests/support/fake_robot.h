// Hume on the stub backend, ready to tick, and a wrapper that spoils what a backend says.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "behaviors/loader.h"
#include "engine/tick/control_loop.h"
#include "hal/backends/stub.h"

namespace footfall::tests {

inline std::unique_ptr<behaviors::Behavior> load_inline(const std::string& text) {
  core::Diagnostics diagnostics;
  behaviors::LoadOptions options;
  options.search = {FOOTFALL_SOURCE_DIR};
  auto behavior = behaviors::load_behavior_text(text, "inline.yaml", options, diagnostics);
  if (!behavior) throw std::runtime_error(diagnostics.to_string());
  return behavior;
}

// Passes everything on to a backend, with a word in each direction.
class Meddler final : public hal::Hardware {
 public:
  explicit Meddler(hal::Hardware& real) : real_(real) {}
  std::string name() const override { return "meddler"; }
  void start() override {
    tick_ = 0;
    real_.start();
  }
  bool read(hal::Sensors& sensors) noexcept override {
    const bool fresh = real_.read(sensors);
    if (spoil) spoil(sensors, tick_);
    return fresh && !stale;
  }
  void write(const hal::Commands& commands) noexcept override {
    hal::Commands passed = commands;
    if (add) add(passed, tick_);
    ++tick_;
    real_.write(passed);
  }
  void safe_stop() noexcept override { real_.safe_stop(); }

  std::function<void(hal::Sensors&, std::int64_t tick)> spoil;
  std::function<void(hal::Commands&, std::int64_t tick)> add;
  bool stale = false;

 private:
  hal::Hardware& real_;
  std::int64_t tick_ = 0;
};

// A behavior for Hume whose joints are double integrators.
struct StubRig {
  std::unique_ptr<behaviors::Behavior> behavior;
  std::unique_ptr<hal::StubBackend> stub;
  std::unique_ptr<Meddler> hardware;
  std::unique_ptr<engine::ControlLoop> loop;

  explicit StubRig(const std::string& text, double inertia = 1.0,
                   std::function<bool(int, double)> contacts = nullptr,
                   const std::function<void(behaviors::Behavior&)>& change = nullptr)
      : behavior(load_inline(text)) {
    if (change) change(*behavior);
    hal::StubSettings settings;
    settings.joints = behavior->robot.joint_count();
    settings.contacts = static_cast<int>(behavior->robot.contacts.size());
    settings.period = behavior->robot.period_s();
    settings.inertia = inertia;
    settings.base = {0.0, 0.0, behavior->robot.standing_height};
    for (const auto& joint : behavior->robot.joints) settings.start.push_back(joint.posture);
    settings.contact_script = std::move(contacts);
    stub = std::make_unique<hal::StubBackend>(settings);
    hardware = std::make_unique<Meddler>(*stub);
    loop = std::make_unique<engine::ControlLoop>(*behavior, *hardware, engine::LoopSettings{});
  }

  std::string state() const {
    const auto active = loop->machine().active_atomic();
    return active.empty() ? "" : behavior->states[static_cast<std::size_t>(active.front())].path;
  }
  std::int64_t faults(core::Fault fault) const { return loop->faults().of(fault); }
};

}  // namespace footfall::tests
