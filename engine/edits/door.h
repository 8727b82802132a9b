// The one door for live edits: a batch of new values and events is checked whole, waits in a
// bounded queue, and is applied whole or not at all at the start of a tick, before the machine's.
// Each thread that submits has an entrance of its own; the tick applies what came through the
// first, then the second; nobody waits for anybody.
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

namespace footfall::behaviors {
struct TakeOverMap;
}

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

struct EditBatch {
  std::uint64_t id = 0;  // the asker's; 0: the door gives one
  EditSource source = EditSource::live;
  std::vector<behaviors::SlotValue> values;  // each slot at most once
  double over = 0.0;                         // s: the values move linearly, tick by tick
  std::vector<int> events;                // into Behavior::events, raised in the tick that applies
  std::optional<std::uint64_t> revision;  // refused unless this many batches were applied before
  std::string who;                        // for the log; printable, cut at kMaxWho bytes
  std::string note;                       // likewise, kMaxNote bytes: `undo`
};

// What submit() says at once: accepted, or every reason against it.
struct EditReply {
  std::uint64_t id = 0;
  std::vector<std::string> reasons;
  bool accepted() const { return reasons.empty(); }
};

// refused: what did not come so far is told to the log (EditEntrance::tell_refused).
enum class EditOutcome : std::uint8_t { applied, stale_revision, refused };

// What the tick says later, in the order of submission.
struct EditAnswer {
  std::uint64_t id = 0;
  EditOutcome outcome = EditOutcome::applied;
  std::int64_t tick = 0;
  std::uint64_t revision = 0;  // batches applied so far, this one included
  std::size_t value_count = 0;
};

inline constexpr std::size_t kMaxEditEvents = 16;  // of one batch
inline constexpr std::size_t kMaxWho = 48, kMaxNote = 160;

// A short text that a queue can carry.
template <std::size_t N>
class FixedText {
 public:
  // Cut at N bytes, never within a UTF-8 character.
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

// A batch on its way through the queue, and what was done with it.
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
  // Of the tick:
  EditOutcome outcome = EditOutcome::applied;
  std::uint64_t revision = 0;

  std::span<const behaviors::SlotValue> new_values() const noexcept {
    return {values.data(), value_count};
  }
  std::span<const int> new_events() const noexcept { return {events.data(), event_count}; }
};

// Where one thread submits its batches and takes their answers.
class EditEntrance {
 public:
  EditEntrance(const behaviors::Behavior& behavior, std::size_t capacity,
               const std::atomic<std::uint64_t>& revision);

  // Every reason against the batch, each a text for people; none: it is in the queue. Batches of
  // one entrance that meet in one tick are applied in the order of their submission.
  EditReply submit(const EditBatch& batch);
  // What a log recorded, unchecked but for its indices; false: no room, or not of this behavior.
  bool resubmit(const EditOrder& order);
  // A batch that came no further, for the log, in its turn; without answer. False: no room.
  bool tell_refused(EditSource source, std::string_view who, std::string_view note) noexcept;
  // The next answer; false: none yet. Answers must be taken: submit() refuses a batch while as many
  // as the queue has places are not. `former` gets, as far as it has room, where each value of the
  // batch was, or was going, before.
  bool take_answer(EditAnswer& answer, std::span<double> former = {}) noexcept;
  // Batches submitted whose answers were not taken.
  std::size_t outstanding() const noexcept { return outstanding_; }
  // Batches applied so far, from any entrance.
  std::uint64_t revision() const noexcept { return revision_.load(std::memory_order_acquire); }

 private:
  friend class EditDoor;
  struct Answer {
    EditAnswer answer;
    std::vector<double> former;  // room for every slot
  };
  EditOrder* free_order() noexcept;
  void publish() noexcept;

  const behaviors::Behavior& behavior_;
  core::Ring<EditOrder> orders_;
  core::Ring<Answer> answers_;
  const std::atomic<std::uint64_t>& revision_;
  std::uint64_t next_id_ = 1;    // of the submitting thread
  std::size_t outstanding_ = 0;  // submitted, answer not taken; likewise
  std::size_t taken_ = 0;        // of the tick: orders that it still shows
};

class EditDoor {
 public:
  // Each entrance has room for `capacity` batches between submission and the end of the tick that
  // applies them.
  explicit EditDoor(const behaviors::Behavior& behavior, std::size_t capacity = 64,
                    std::size_t entrances = 2);

  // --- Threads that submit, each at its own entrance: 0 is that of the thread that ticks (goals,
  // scenarios), 1 that of the network. ---
  EditEntrance& entrance(std::size_t i) noexcept { return entrances_[i]; }
  // Entrance 0.
  EditReply submit(const EditBatch& batch) { return entrances_[0].submit(batch); }
  bool resubmit(const EditOrder& order) { return entrances_[0].resubmit(order); }
  bool take_answer(EditAnswer& answer) noexcept { return entrances_[0].take_answer(answer); }
  // Batches applied so far.
  std::uint64_t revision() const noexcept { return revision_.load(std::memory_order_acquire); }

  // --- The tick; allocates nothing. ---
  // Moves what ramps, then applies what waits, entrance by entrance: writes parameters, raises
  // outside events. A batch whose events find no room in the machine's queue waits for the next
  // tick, and those behind it.
  void apply(std::int64_t tick, behaviors::Machine& machine) noexcept;
  // What the last apply() took from the queues, in order; valid until the next apply().
  std::size_t taken() const noexcept { return taken_.size(); }
  const EditOrder& taken(std::size_t i) const noexcept { return *taken_[i]; }
  // Whether the last apply() wrote values of a live or scenario edit, by ramp or at once.
  bool moved() const noexcept { return moved_; }
  // Where each of `values` goes: the end of its ramp, itself if it is at rest.
  void copy_targets(std::span<const double> values, std::span<double> targets) const noexcept;

  // Between two ticks, in the place of another behavior's door (engine/tick/take_over.cc).
  struct TakeOver {
    const behaviors::Behavior& from;
    const behaviors::Behavior& to;  // this door's
    const behaviors::TakeOverMap& map;
    std::span<const double> before;  // values in force so far, of `from`
    std::span<const double> own;     // of this door's machine, which will go on from `before`
    std::int64_t tick = 0;
    std::int64_t periods = 0;  // over which values go to where they are to be; 0: in this tick
  };
  // An edited value stays where the two files say the same, else the own one comes in force. What
  // waits in the old door is answered there with stale_revision, since the revision grows by one.
  void take_over(EditDoor& old, const TakeOver& change) noexcept;
  // Nothing ramps any more: what moved stays where it is.
  void rest() noexcept;

 private:
  struct Ramp {
    double from = 0.0, to = 0.0;
    std::int64_t start = 0, ticks = 0;  // ticks 0: at rest
    bool smooth = false;                // torque steps are to be limited
  };
  void take_slot(const EditDoor& old, const behaviors::ParameterInfo& info, int slot, double own,
                 const TakeOver& change) noexcept;
  void refuse_waiting(EditEntrance& entrance, std::int64_t tick, std::uint64_t revision) noexcept;
  void advance_ramps(std::int64_t tick, std::span<double> values) noexcept;
  void take(EditEntrance& entrance, std::int64_t tick, behaviors::Machine& machine) noexcept;
  void write(const EditOrder& order, std::int64_t tick, std::span<double> values,
             std::span<double> former) noexcept;

  std::atomic<std::uint64_t> revision_{0};
  std::deque<EditEntrance> entrances_;
  // Of the tick:
  std::vector<const EditOrder*> taken_;
  std::vector<Ramp> ramps_;  // by slot
  std::vector<int> moving_;  // slots that ramp
  bool moved_ = false;
};

// Adds new values of a parameter, of all its slots or (component >= 0) of one. A wrong component or
// number of values adds a reason instead.
void add_values(const behaviors::Behavior& behavior, behaviors::ParameterPart part,
                std::span<const double> values, std::vector<behaviors::SlotValue>& to,
                std::vector<std::string>& reasons);

// Every reason against a batch, naming parameter, value, unit and range; `revision`: in force.
std::vector<std::string> reasons_against(const behaviors::Behavior& behavior,
                                         const EditBatch& batch, std::uint64_t revision);

// Over which a batch's values move, s: a person's at least over the robot's edit_ramp, since what
// is turned at once would step the torque.
double ramp_time(const behaviors::Behavior& behavior, const EditBatch& batch);

// Events that the engine raises itself: they cannot come from outside.
bool is_built_in_event(const behaviors::Behavior& behavior, int event);

}  // namespace footfall::engine
