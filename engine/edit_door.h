// The one door for live edits: a batch of new values and events is checked whole, waits in a
// bounded queue, and is applied whole or not at all at the start of a tick, before the machine's.
// One thread submits and takes the answers, the tick applies; neither waits for the other.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "behaviors/machine.h"
#include "core/ring.h"

namespace footfall::engine {

// Who asks. `set` and `command` may also write what is not live, within its range.
enum class EditSource : std::uint8_t {
  live,      // a person, over the network or a tool
  scenario,  // `edit` of a scenario
  set,       // `set` of a scenario
  command,   // the command line's --goal and --goal-velocity
  replay,    // as it was logged
};
const char* edit_source_name(EditSource source);

// New values of a parameter or gain.
struct EditValue {
  int parameter = -1;          // into Behavior::parameters
  int component = -1;          // one of its values; -1: all of them
  std::vector<double> values;  // SI, one for each that is meant
};

struct EditBatch {
  std::uint64_t id = 0;  // the asker's; 0: the door gives one
  EditSource source = EditSource::live;
  std::vector<EditValue> values;
  double over = 0.0;                      // s: the values move linearly, tick by tick
  std::vector<int> events;                // into Behavior::events, raised in the tick that applies
  std::optional<std::uint64_t> revision;  // refused unless this many batches were applied before
};

// What submit() says at once: accepted, or every reason against it.
struct EditReply {
  std::uint64_t id = 0;
  std::vector<std::string> reasons;
  bool accepted() const { return reasons.empty(); }
};

enum class EditOutcome : std::uint8_t { applied, stale_revision };

// What the tick says later, in the order of submission.
struct EditAnswer {
  std::uint64_t id = 0;
  EditOutcome outcome = EditOutcome::applied;
  std::int64_t tick = 0;
  std::uint64_t revision = 0;  // batches applied so far, this one included
};

struct SlotValue {
  int slot = 0;  // of Machine::parameters()
  double value = 0.0;
};

inline constexpr std::size_t kMaxEditEvents = 16;  // of one batch

// A batch on its way through the queue, and what was done with it.
struct EditOrder {
  std::uint64_t id = 0;
  EditSource source = EditSource::live;
  std::int64_t ramp_ticks = 0;    // 0: at once
  std::vector<SlotValue> values;  // room for every slot; the first value_count count
  std::size_t value_count = 0;
  std::array<int, kMaxEditEvents> events{};
  std::size_t event_count = 0;
  bool expects_revision = false;
  std::uint64_t expected_revision = 0;
  // Of the tick:
  EditOutcome outcome = EditOutcome::applied;
  std::uint64_t revision = 0;

  std::span<const SlotValue> new_values() const noexcept { return {values.data(), value_count}; }
  std::span<const int> new_events() const noexcept { return {events.data(), event_count}; }
};

class EditDoor {
 public:
  // Room for `capacity` batches between submission and the end of the tick that applies them.
  explicit EditDoor(const behaviors::Behavior& behavior, std::size_t capacity = 64);

  // --- The thread that submits. ---
  // Every reason against the batch, each a text for people; none: it is in the queue. Batches that
  // meet in one tick are applied in the order of their submission.
  EditReply submit(const EditBatch& batch);
  // What a log recorded, unchecked but for its indices; false: no room, or not of this behavior.
  bool resubmit(const EditOrder& order);
  // The next answer; false: none yet. Answers must be taken: submit() refuses a batch while as many
  // as the queue has places are not.
  bool take_answer(EditAnswer& answer) noexcept;
  // Batches applied so far.
  std::uint64_t revision() const noexcept { return revision_.load(std::memory_order_acquire); }

  // --- The tick; allocates nothing. ---
  // Moves what ramps, then applies what waits: writes parameters, raises outside events. A batch
  // whose events find no room in the machine's queue waits for the next tick, and those behind it.
  void apply(std::int64_t tick, behaviors::Machine& machine) noexcept;
  // What the last apply() took from the queue, in order; valid until the next apply().
  std::size_t taken() const noexcept { return taken_; }
  const EditOrder& taken(std::size_t i) const noexcept { return orders_.at(i); }

 private:
  struct Ramp {
    double from = 0.0, to = 0.0;
    std::int64_t start = 0, ticks = 0;  // ticks 0: at rest
  };
  void advance_ramps(std::int64_t tick, std::span<double> values) noexcept;
  void write(const EditOrder& order, std::int64_t tick, std::span<double> values) noexcept;

  const behaviors::Behavior& behavior_;
  core::Ring<EditOrder> orders_;
  core::Ring<EditAnswer> answers_;
  std::atomic<std::uint64_t> revision_{0};
  std::uint64_t next_id_ = 1;    // of the submitting thread
  std::size_t outstanding_ = 0;  // submitted, answer not taken; likewise
  std::size_t taken_ = 0;        // of the tick
  std::vector<Ramp> ramps_;      // by slot
  std::vector<int> moving_;      // slots that ramp
};

// Every reason against a batch, naming parameter, value, unit and range; `revision`: in force.
std::vector<std::string> reasons_against(const behaviors::Behavior& behavior,
                                         const EditBatch& batch, std::uint64_t revision);

// Events that the engine raises itself: they cannot come from outside.
bool is_built_in_event(const behaviors::Behavior& behavior, int event);

}  // namespace footfall::engine
