// The only way for live edits: a batch of new values and events is validated as a whole, waits in a
// bounded queue, and is applied as a whole or not at all at the start of a tick, before the
// machine's tick. Each submitting thread has its own entrance; the tick applies the batches of the
// first, then of the second; no thread waits for another one.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/machine/machine.h"
#include "core/realtime/ring.h"
#include "engine/edits/ramps.h"

namespace footfall::behaviors {
struct TakeOverMap;
}

namespace footfall::engine {

// Origin of an edit. `set` and `command` may also write parameters that are not live, within their
// range.
enum class EditSource : std::uint8_t {
  live,      // a user, over the network or a tool
  scenario,  // `edit` of a scenario
  set,       // `set` of a scenario
  command,   // the command line's --goal and --goal-velocity
  replay,    // from a log
};
const char* edit_source_name(EditSource source);

struct EditBatch {
  std::uint64_t id = 0;  // chosen by the sender; 0: chosen by the door
  EditSource source = EditSource::live;
  std::vector<behaviors::SlotValue> values;  // each slot at most once
  double over = 0.0;                         // s, duration of a linear ramp of the values
  std::vector<int> events;                   // into Behavior::events, raised in the same tick
  std::optional<std::uint64_t> revision;     // refused unless this many were applied before
  std::string who;                           // for the log; printable, truncated to kMaxWho bytes
  std::string note;                          // same, kMaxNote bytes: `undo`
};

// Immediate result of submit(): accepted, or all reasons against it.
struct EditReply {
  std::uint64_t id = 0;
  std::vector<std::string> reasons;
  bool accepted() const { return reasons.empty(); }
};

// refused: rejected before the queue, only logged (EditEntrance::tell_refused).
enum class EditOutcome : std::uint8_t { applied, stale_revision, refused };

// Result from the tick, in the order of submission.
struct EditAnswer {
  std::uint64_t id = 0;
  EditOutcome outcome = EditOutcome::applied;
  std::int64_t tick = 0;
  std::uint64_t revision = 0;  // batches applied so far, including this one
  std::size_t value_count = 0;
};

inline constexpr std::size_t kMaxEditEvents = 16;  // limit per batch
inline constexpr std::size_t kMaxWho = 48, kMaxNote = 160;

// A short text of fixed capacity, for queues.
template <std::size_t N>
class FixedText {
 public:
  // Truncates to N bytes at a UTF-8 character boundary.
  void set(std::string_view text) noexcept {
    size_ = text.size() <= N ? text.size() : N;
    while (size_ < text.size() && size_ > 0 &&
           (static_cast<unsigned char>(text[size_]) & 0xC0U) == 0x80U) {
      --size_;
    }
    text.copy(bytes_.data(), size_);
  }
  std::string_view view() const noexcept { return {bytes_.data(), size_}; }

 private:
  std::array<char, N> bytes_{};
  std::size_t size_ = 0;
};

// A batch in the queue, and its result.
struct EditOrder {
  std::uint64_t id = 0;
  EditSource source = EditSource::live;
  std::int64_t ramp_ticks = 0;               // 0: at once
  std::vector<behaviors::SlotValue> values;  // room for every slot; the first value_count count
  std::size_t value_count = 0;
  std::array<int, kMaxEditEvents> events{};
  std::size_t event_count = 0;
  bool expects_revision = false;
  std::uint64_t expected_revision = 0;
  FixedText<kMaxWho> who;
  FixedText<kMaxNote> note;
  // Set by the tick:
  EditOutcome outcome = EditOutcome::applied;
  std::uint64_t revision = 0;

  std::span<const behaviors::SlotValue> new_values() const noexcept {
    return {values.data(), value_count};
  }
  std::span<const int> new_events() const noexcept { return {events.data(), event_count}; }
};

// Entrance of one thread: submits batches and takes answers.
class EditEntrance {
 public:
  EditEntrance(const behaviors::Behavior& behavior, std::size_t capacity,
               const std::atomic<std::uint64_t>& revision);

  // Returns all reasons against the batch, each as text; if there are none, it is in the queue.
  // Batches of one entrance in one tick are applied in the order of submission.
  EditReply submit(const EditBatch& batch);
  // Submits an order from a log, with only its indices checked; false if full or of another
  // behavior.
  bool resubmit(const EditOrder& order);
  // Logs a batch that was refused before the queue, in order; without answer. False if full.
  bool tell_refused(EditSource source, std::string_view who, std::string_view note) noexcept;
  // Takes the next answer; false if there is none. Answers must be taken: submit() refuses batches
  // while the queue's capacity is used by untaken answers. `former` gets, as far as it has room,
  // the previous value or ramp target of each value of the batch.
  bool take_answer(EditAnswer& answer, std::span<double> former = {}) noexcept;
  // Number of submitted batches whose answers were not taken.
  std::size_t outstanding() const noexcept { return outstanding_; }
  // Number of batches applied so far, through any entrance.
  std::uint64_t revision() const noexcept { return revision_.load(std::memory_order_acquire); }

 private:
  friend class EditDoor;
  struct Answer {
    EditAnswer answer;
    std::vector<double> former;  // capacity for every slot
  };
  EditOrder* free_order() noexcept;
  void publish() noexcept;

  const behaviors::Behavior& behavior_;
  core::Ring<EditOrder> orders_;
  core::Ring<Answer> answers_;
  const std::atomic<std::uint64_t>& revision_;
  std::uint64_t next_id_ = 1;    // used by the submitting thread
  std::size_t outstanding_ = 0;  // submitted, answer not taken; same thread
  std::size_t taken_ = 0;        // used by the tick: orders of the last apply()
};

class EditDoor {
 public:
  // Each entrance has a capacity of `capacity` batches between submission and the end of the tick
  // that applies them.
  explicit EditDoor(const behaviors::Behavior& behavior, std::size_t capacity = 64,
                    std::size_t entrances = 2);

  // --- Submitting threads, each at its own entrance: 0 for the tick's thread (goals, scenarios), 1
  // for the network. ---
  EditEntrance& entrance(std::size_t i) noexcept { return entrances_[i]; }
  // Entrance 0.
  EditReply submit(const EditBatch& batch) { return entrances_[0].submit(batch); }
  bool resubmit(const EditOrder& order) { return entrances_[0].resubmit(order); }
  bool take_answer(EditAnswer& answer) noexcept { return entrances_[0].take_answer(answer); }
  // Number of batches applied so far.
  std::uint64_t revision() const noexcept { return revision_.load(std::memory_order_acquire); }

  // --- The tick; allocates nothing. --- Advances ramps, then applies waiting batches, entrance by
  // entrance: writes parameters, raises external events. If the machine's queue has no room for a
  // batch's events, it waits for the next tick, and so do those behind it.
  void apply(std::int64_t tick, behaviors::Machine& machine) noexcept;
  // Orders applied by the last apply(), in order; valid until the next apply().
  std::size_t taken() const noexcept { return taken_.size(); }
  const EditOrder& taken(std::size_t i) const noexcept { return *taken_[i]; }
  // Whether the last apply() wrote values of a live or scenario edit, by ramp or at once.
  bool moved() const noexcept { return moved_; }
  const ParameterRamps& ramps() const noexcept { return ramps_; }

  // Between two ticks: replaces the door of another behavior (engine/tick/take_over.cc).
  struct TakeOver {
    const behaviors::Behavior& from;
    const behaviors::Behavior& to;  // the behavior of this door
    const behaviors::TakeOverMap& map;
    std::span<const double> before;  // current values, of `from`
    std::span<const double> own;     // initial ones of this door's machine
    std::int64_t tick = 0;
    std::int64_t periods = 0;  // duration of the ramps to the new values, ticks; 0: in this tick
  };
  // How differing parameter values take effect: an edited value is kept if both files have the same
  // value, otherwise the new file's value is used. Edits waiting in the old door are answered with
  // stale_revision, because the revision is incremented.
  void take_over(EditDoor& old, const TakeOver& change) noexcept;
  // Stops all ramps; their values stay as they are.
  void rest() noexcept { ramps_.clear(); }

 private:
  void take_slot(const EditDoor& old, const behaviors::ParameterInfo& info, int slot, double own,
                 const TakeOver& change) noexcept;
  void refuse_waiting(EditEntrance& entrance, std::int64_t tick, std::uint64_t revision) noexcept;
  void take(EditEntrance& entrance, std::int64_t tick, behaviors::Machine& machine) noexcept;
  void write(const EditOrder& order, std::int64_t tick, std::span<double> values,
             std::span<double> former) noexcept;

  std::atomic<std::uint64_t> revision_{0};
  std::deque<EditEntrance> entrances_;
  // Used by the tick:
  std::vector<const EditOrder*> taken_;
  ParameterRamps ramps_;
  bool moved_ = false;
};

// Adds new values of a parameter, of all its slots or (component >= 0) of one. A wrong component or
// number of values adds a reason instead.
void add_values(const behaviors::Behavior& behavior, behaviors::ParameterPart part,
                std::span<const double> values, std::vector<behaviors::SlotValue>& to,
                std::vector<std::string>& reasons);

// Completes 'it is not live, because ...'.
std::string reason_not_live(const behaviors::ParameterInfo& info);

// What a behavior says of its estimator with words: no values, so nothing that an edit can name.
inline std::array<std::string_view, 2> estimator_choices() {
  return {"estimator.type", "estimator.contact"};
}
inline constexpr std::string_view kChosenBefore =
    "an estimator is chosen before a run starts: in the file, or with '--set'";

// All reasons against a batch, naming parameter, value, unit and range; `revision`: the current
// one.
std::vector<std::string> reasons_against(const behaviors::Behavior& behavior,
                                         const EditBatch& batch, std::uint64_t revision);

// Duration of a batch's ramps, s: at least the robot's edit_ramp for edits by users, because a step
// of a value could cause a torque step.
double ramp_time(const behaviors::Behavior& behavior, const EditBatch& batch);

// Whether the engine raises the event itself: then it cannot be raised externally.
bool is_built_in_event(const behaviors::Behavior& behavior, int event);

}  // namespace footfall::engine
