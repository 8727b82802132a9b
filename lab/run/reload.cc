// Swapping and taking back; see reload.h.
#include "lab/run/reload.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "core/fault.h"
#include "core/index.h"
#include "lab/run/log_setup.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;

constexpr double kPatience = 5.0;  // s that a reload waits before it is told that it does

std::int64_t ticks_of(double seconds, const engine::ControlLoop& loop) {
  return behaviors::periods_of(seconds, loop.behavior().rate_mhz);
}

// The paths of the innermost active states.
std::string active_states(const engine::ControlLoop& loop) {
  std::string text;
  for (const int s : loop.machine().active_atomic()) {
    text += fmt::format("{}'{}'", text.empty() ? "" : ", ", loop.behavior().states[at(s)].path);
  }
  return text;
}

}  // namespace

std::string reload_log(const std::string& folder, int number) {
  return fmt::format("{}/reload-{}/log.mcap", folder, number);
}

Reloads::Reloads(engine::ControlLoop& first, engine::LogWriter* log, ReloadSetup setup)
    : setup_(std::move(setup)), robot_(robot_files(first.behavior())) {
  // Owned by whoever started the run.
  running_ = std::shared_ptr<const behaviors::Behavior>(&first.behavior(), [](const auto*) {});
  now_.behavior = running_;
  now_.loop = &first;
  now_.log = log;
  if (log != nullptr) now_.header = make_log_header(first.behavior(), setup_.source);
}

Reloads::~Reloads() { delete offered_.exchange(nullptr); }

std::vector<std::string> Reloads::request(const std::string& path) {
  std::shared_ptr<const behaviors::Behavior> from;
  std::vector<Stage> retired;
  {
    const std::lock_guard lock(running_mutex_);
    from = running_;
    retired.swap(retired_);
  }
  retired.clear();
  auto candidate =
      std::make_unique<ReloadCandidate>(prepare_reload(path, std::move(from), robot_, setup_));
  std::vector<std::string> files = candidate->files;
  delete offered_.exchange(candidate.release());
  return files;
}

// A newer one replaces what waits; one that is refused does, too: its file is not what waits any
// more.
void Reloads::take_offer() {
  if (offered_.load(std::memory_order_relaxed) == nullptr) return;
  waiting_.reset(offered_.exchange(nullptr));
  waits_since_ = now_.loop->ticks();
  complained_ = false;
}

// Drops what waits if there are reasons against it; it was prepared for the behavior that ran then.
void Reloads::judge_waiting() {
  if (waiting_ == nullptr) return;
  if (waiting_->loop != nullptr && waiting_->from != now_.behavior) {
    aim_reload(*waiting_, now_.behavior);
  }
  if (waiting_->reasons.empty()) return;
  std::string line = fmt::format("{}: not reloaded:", waiting_->path);
  for (const std::string& reason : waiting_->reasons) line += "\n  " + reason;
  say("refused", fmt::format("{}: {}", waiting_->path, waiting_->reasons.front()), line);
  waiting_.reset();
}

bool Reloads::swap() {
  if (failed_.loop != nullptr) set_running(failed_);
  if (before_.loop != nullptr && now_.loop->ticks() >= proven_at_) {
    now_.loop->set_probation(false);
    set_running(before_);
  }
  take_offer();
  judge_waiting();
  if (waiting_ == nullptr || before_.loop != nullptr) return false;
  if (!waiting_->loop->may_take_over(*now_.loop, waiting_->there)) {
    complain_once();
    return false;
  }
  engine::LogWriter* log = open_log(waiting_->header, *waiting_->behavior, false);
  engine::ControlLoop& loop = *waiting_->loop;
  loop.take_over(*now_.loop, waiting_->there, engine::ValueChange::ramped);
  loop.set_probation(true);
  before_ = std::exchange(now_, {});
  now_ = {waiting_->behavior, std::move(waiting_->loop), &loop, log, std::move(waiting_->header)};
  back_ = std::move(waiting_->back);
  path_ = waiting_->path;
  proven_at_ = loop.ticks() + ticks_of(loop.behavior().robot.reload_watch, loop);
  set_running(failed_);
  waiting_.reset();
  const std::string place = active_states(loop);
  say("done", fmt::format("{} in {}", path_, place),
      fmt::format("{}: reloaded at {:.3f} s, in {}", path_, loop.time(), place));
  return true;
}

bool Reloads::take_back() {
  if (before_.loop == nullptr || now_.loop->failed_by() == core::Fault::count) return false;
  const core::Fault fault = now_.loop->failed_by();
  engine::LogWriter* log = open_log(before_.header, *before_.behavior, true);
  before_.loop->take_over(*now_.loop, back_, engine::ValueChange::at_once);
  failed_ = std::exchange(now_, std::exchange(before_, {}));
  now_.log = log;
  say("taken back", fmt::format("{}: fault {}", path_, core::fault_name(fault)),
      fmt::format("{}: taken back at {:.3f} s: fault {}; the file is not tried again until it "
                  "changes",
                  path_, now_.loop->time(), core::fault_name(fault)));
  return true;
}

// Nobody uses `retired` any more; freeing it takes too long between two ticks.
void Reloads::set_running(Stage& retired) {
  const std::lock_guard lock(running_mutex_);
  running_ = now_.behavior;
  if (retired.own) retired_.push_back(std::exchange(retired, {}));
  retired = {};
}

void Reloads::say(const std::string& what, const std::string& detail, const std::string& line) {
  news_.emplace_back(what, detail);
  if (setup_.tell) setup_.tell(line);
}

std::vector<std::pair<std::string, std::string>> Reloads::take_news() {
  return std::exchange(news_, {});
}

std::string Reloads::note() const {
  if (waiting_ == nullptr) return "";
  if (before_.loop != nullptr) return "a reload waits: the one before is on probation";
  return "a reload waits for a state with `reload: ok`";
}

void Reloads::complain_once() {
  if (complained_ || now_.loop->ticks() - waits_since_ < ticks_of(kPatience, *now_.loop)) return;
  complained_ = true;
  if (setup_.tell) {
    setup_.tell(
        fmt::format("{}: not reloaded yet: since {:g} s no state was active that permits it "
                    "(`reload: ok`) and is "
                    "in the file; active: {}",
                    waiting_->path, kPatience, active_states(*now_.loop)));
  }
}

// What follows the log before it: its setup says which one that is, and that it is the behavior
// from before the last one that goes on (`back`).
engine::LogWriter* Reloads::open_log(const engine::LogHeader& header,
                                     const behaviors::Behavior& behavior, bool back) {
  LogContinuation continues{++done_, back, now_.loop->ticks()};
  if (now_.log == nullptr) return nullptr;
  if (!back) continues.proven += ticks_of(behavior.robot.reload_watch, *now_.loop);
  const std::string path = reload_log(setup_.folder, continues.number);
  engine::LogHeader own = header;
  own.setup = setup_text(header.setup, continues);
  try {
    fs::create_directories(fs::path(path).parent_path());
    logs_.push_back(std::make_unique<engine::LogWriter>(path, behavior.signals, own));
    return logs_.back().get();
  } catch (const std::exception& problem) {  // the robot steps on
    if (setup_.tell) setup_.tell(fmt::format("the run goes on without a log: {}", problem.what()));
    return nullptr;
  }
}

void Reloads::close() {
  for (const auto& log : logs_) log->close();
}

}  // namespace footfall::lab
