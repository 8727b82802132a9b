// Swapping and taking back; see reload.h.
#include "lab/run/reload.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "core/fault.h"
#include "core/index.h"

namespace footfall::lab {
namespace {

constexpr double kPatience = 5.0;  // s that a reload waits before people are told

std::int64_t ticks_of(double seconds, const engine::ControlLoop& loop) {
  return behaviors::periods_of(seconds, loop.behavior().rate_mhz);
}

// A text composed in the tick's thread: no heap; what is too long is cut.
class Line {
 public:
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) noexcept {
    const auto to = fmt::format_to_n(bytes_.data() + size_, bytes_.size() - size_, format,
                                     std::forward<Values>(values)...);
    size_ = std::min(bytes_.size(), size_ + to.size);
  }
  // The paths of the innermost active states.
  void add_states(const engine::ControlLoop& loop) noexcept {
    const char* comma = "";
    for (const int s : loop.machine().active_atomic()) {
      add("{}'{}'", std::exchange(comma, ", "), loop.behavior().states[at(s)].path);
    }
  }
  std::string_view view() const noexcept { return {bytes_.data(), size_}; }

 private:
  std::array<char, 2 * kMostReloadText> bytes_{};
  std::size_t size_ = 0;
};

}  // namespace

Reloads::Reloads(engine::ControlLoop& first, ReloadSetup setup)
    : setup_(std::move(setup)),
      robot_(robot_files(first.behavior())),
      now_(std::make_unique<ReloadCandidate>()) {
  // Owned by whoever started the run.
  running_ = std::shared_ptr<const behaviors::Behavior>(&first.behavior(), [](const auto*) {});
  now_->behavior = running_;
  now_->loop = &first;
  if (!setup_.folder.empty()) now_->header = make_log_header(first.behavior(), setup_.source);
}

Reloads::~Reloads() = default;

// --- The thread beside the run. ---

std::vector<std::string> Reloads::request(const std::string& path) {
  drop_offer();
  tend();
  std::shared_ptr<const behaviors::Behavior> from;
  {
    const std::lock_guard lock(meeting_);
    from = running_;
  }
  loaded_ = std::make_unique<ReloadCandidate>(prepare_reload(path, from, robot_, setup_));
  std::vector<std::string> files = loaded_->files;
  if (!loaded_->reasons.empty()) {
    refuse(*loaded_);
    loaded_.reset();
  }
  tend();
  return files;
}

// A newer file replaces what waits, and so does one that is refused: what waits is not that file
// any more.
void Reloads::drop_offer() {
  std::unique_ptr<ReloadCandidate> offer;
  {
    const std::lock_guard lock(meeting_);
    offer = std::move(offer_);
  }
  loaded_.reset();
}

void Reloads::tend() {
  std::unique_ptr<ReloadCandidate> retired;
  std::unique_ptr<RunOutputs> unused;
  ReloadCandidate* running = nullptr;
  int done = 0;
  {
    const std::lock_guard lock(meeting_);
    retired = std::move(retired_);
    unused = std::move(unused_);
    if (settled_) {
      running = now_.get();
      done = done_;
    }
  }
  for (; reports_.waiting() > 0; reports_.release(1)) {
    const Report& report = reports_.at(0);
    if (report.used != nullptr) report.used->name();
    if (setup_.tell) setup_.tell(std::string(report.line.view()));
  }
  unused.reset();  // its number is free again
  if (retired != nullptr) retire(std::move(retired));
  if (running != nullptr && loaded_ != nullptr) arm(*running, done);
  waits_.store(loaded_ != nullptr);
}

// Opens all that the candidate will write to, and what the running loop will if it is brought back.
// Nothing else was offered, so that `running` runs on meanwhile.
void Reloads::arm(ReloadCandidate& running, int done) {
  if (loaded_->from != running.behavior) aim_reload(*loaded_, running.behavior);
  if (!loaded_->reasons.empty()) {
    refuse(*loaded_);
    loaded_.reset();
    return;
  }
  const auto watch = ticks_of(loaded_->behavior->robot.reload_watch, *loaded_->loop);
  loaded_->outputs = open_outputs(*loaded_, {done + 1, false, watch}, setup_);
  loaded_->way_back = open_outputs(running, {done + 2, true, 0}, setup_);
  const std::lock_guard lock(meeting_);
  offer_ = std::move(loaded_);
}

void Reloads::refuse(const ReloadCandidate& candidate) {
  if (ReloadNews* const news = refusals_.next()) {
    news->what.set("refused");
    news->detail.set(fmt::format("{}: {}", candidate.path, candidate.reasons.front()));
    refusals_.publish();
  }
  if (!setup_.tell) return;
  std::string line = fmt::format("{}: not reloaded:", candidate.path);
  for (const std::string& reason : candidate.reasons) line += "\n  " + reason;
  setup_.tell(line);
}

void Reloads::retire(std::unique_ptr<ReloadCandidate> stage) {
  close_outputs(stage->outputs.get());
  close_outputs(stage->way_back.get());
}

void Reloads::close_outputs(RunOutputs* outputs) {
  if (outputs == nullptr) return;
  try {
    outputs->close();
  } catch (const std::exception& problem) {
    if (failure_.empty()) failure_ = problem.what();
  }
}

void Reloads::close() {
  drop_offer();
  tend();
  for (ReloadCandidate* stage : {now_.get(), former_.get(), failed_.get()}) {
    if (stage == nullptr) continue;
    close_outputs(stage->outputs.get());
    close_outputs(stage->way_back.get());
  }
  if (!failure_.empty()) throw std::runtime_error(failure_);
}

// --- The thread that ticks. ---

// If the thread beside holds the mutex just now, the next tick will do.
engine::ControlLoop* Reloads::swap() {
  if (former_ != nullptr && now_->loop->ticks() >= proven_at_) now_->loop->set_probation(false);
  const std::unique_lock lock(meeting_, std::try_to_lock);
  if (!lock) return nullptr;
  hand_over();
  if (offer_ == nullptr || !settled_) return nullptr;
  engine::ControlLoop& loop = *offer_->loop;
  if (!loop.may_take_over(*now_->loop, offer_->there)) {
    complain_once();
    return nullptr;
  }
  loop.take_over(*now_->loop, offer_->there, engine::ValueChange::ramped);
  former_ = std::exchange(now_, std::move(offer_));
  running_ = now_->behavior;
  settled_ = false;
  ++done_;
  now_->outputs->used = true;
  proven_at_ = loop.ticks() + ticks_of(loop.behavior().robot.reload_watch, loop);
  loop.set_probation(loop.ticks() < proven_at_);
  Line detail, line;
  detail.add("{} in ", now_->path);
  detail.add_states(loop);
  line.add("{}: reloaded at {:.3f} s, in ", now_->path, loop.time());
  line.add_states(loop);
  tell_from_tick("done", detail.view(), line.view());
  return &loop;
}

// The thread beside frees what is handed over. One slot each is enough: another offer is armed only
// after it has emptied them.
void Reloads::hand_over() noexcept {
  if (failed_ != nullptr) {
    retired_ = std::move(failed_);
  } else if (former_ != nullptr && now_->loop->ticks() >= proven_at_) {
    retired_ = std::move(former_);
    unused_ = std::move(now_->way_back);
  } else {
    return;
  }
  running_ = now_->behavior;
  settled_ = true;
}

engine::ControlLoop* Reloads::take_back() {
  if (former_ == nullptr) return nullptr;
  const core::Fault fault = now_->loop->failed_by();
  engine::ControlLoop& loop = *former_->loop;
  loop.take_over(*now_->loop, now_->back, engine::ValueChange::at_once);
  failed_ = std::exchange(now_, std::move(former_));
  std::swap(now_->outputs, failed_->way_back);
  ++done_;
  now_->outputs->used = true;
  Line detail, line;
  detail.add("{}: fault {}", failed_->path, core::fault_name(fault));
  line.add(
      "{}: taken back at {:.3f} s: fault {}; the file is not tried again until it "
      "changes",
      failed_->path, loop.time(), core::fault_name(fault));
  tell_from_tick("taken back", detail.view(), line.view());
  return &loop;
}

std::unique_ptr<engine::LiveBinding> Reloads::take_binding() {
  return std::move(now_->outputs->live);
}

void Reloads::tell_from_tick(const char* what, std::string_view detail,
                             std::string_view line) noexcept {
  if (ReloadNews* const news = news_.next()) {
    news->what.set(what);
    news->detail.set(detail);
    news_.publish();
  }
  if (Report* const report = reports_.next()) {
    report->line.set(line);
    report->used = now_->outputs.get();
    reports_.publish();
  }
}

bool Reloads::take_news(ReloadNews& news) noexcept {
  for (auto* const queue : {&refusals_, &news_}) {
    if (queue->waiting() == 0) continue;
    news = queue->at(0);
    queue->release(1);
    return true;
  }
  return false;
}

std::string Reloads::note() {
  if (waits_.load()) return "a reload waits: the one before is on probation";
  const std::lock_guard lock(meeting_);
  return offer_ == nullptr ? "" : "a reload waits for a state with `reload: ok`";
}

void Reloads::complain_once() noexcept {
  const std::int64_t ticks = now_->loop->ticks();
  if (offer_->waits_since < 0) offer_->waits_since = ticks;
  if (offer_->complained || ticks - offer_->waits_since < ticks_of(kPatience, *now_->loop)) return;
  offer_->complained = true;
  Line line;
  line.add(
      "{}: not reloaded yet: since {:g} s no state was active that permits it (`reload: ok`) and "
      "is in the file; active: ",
      offer_->path, kPatience);
  line.add_states(*now_->loop);
  if (Report* const report = reports_.next()) {
    report->line.set(line.view());
    report->used = nullptr;
    reports_.publish();
  }
}

}  // namespace footfall::lab
