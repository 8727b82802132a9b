// A link to a script, without a robot.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include "behaviors/loader.h"
#include "engine/links/script_link.h"

namespace footfall::tests {

// A statechart with a script beside it, in a folder of its own.
class Scripted {
 public:
  Scripted(const std::string& machine, const std::string& lua,
           const behaviors::ScriptSettings& settings = {}, bool paced = false)
      : folder_(place("")) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "s.lua") << lua;
    core::Diagnostics diagnostics;
    behavior = behaviors::load_behavior_text(
        "behavior: 1\nscripts: s.lua\nparameters: {x: {value: 0, range: [-9, 9], live: true}}\n"
        "events: {a: '', b: ''}\n" +
            machine,
        (folder_ / "b.yaml").string(), {}, diagnostics);
    if (!behavior) throw std::runtime_error(diagnostics.to_string());
    signals = behavior->signals;
    machine_ = std::make_unique<behaviors::Machine>(*behavior, signals);
    link = std::make_unique<engine::ScriptLink>(*behavior, settings, paced);
    machine_->start();
  }
  ~Scripted() { std::filesystem::remove_all(folder_); }

  bool tick(bool wait = true) {
    if (wait) link->wait();
    link->deliver(*machine_);
    machine_->tick(now_++);
    return link->post(*machine_, signals.values(), 0.0);
  }
  // A file in the folder.
  static std::string place(const std::string& name) {
    const std::string folder = "footfall-script-" + std::to_string(getpid());
    return (std::filesystem::temp_directory_path() / folder / name).string();
  }
  void raise(const char* event) { machine_->raise(behavior->find_event(event)); }
  std::string state() const {
    return behavior->states[static_cast<std::size_t>(machine_->active_atomic().front())].name;
  }
  double x() const { return machine_->parameters()[0]; }

  std::unique_ptr<behaviors::Behavior> behavior;
  core::SignalTable signals;
  std::unique_ptr<engine::ScriptLink> link;

 private:
  std::filesystem::path folder_;
  std::unique_ptr<behaviors::Machine> machine_;
  std::int64_t now_ = 0;
};

}  // namespace footfall::tests
