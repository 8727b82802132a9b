// The engine's side of live tuning: requests in, answers out; no network, no clock, no thread. It
// checks client, order and content of requests, passes edits to the door, keeps the undo history,
// and reports the current values. Used by one thread, that of the link; the tick is separated by
// the door.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "behaviors/check/physics/check.h"
#include "engine/edits/door.h"

namespace footfall_lcm {
class answer_t;
class catalogue_t;
class request_t;
class values_t;
}  // namespace footfall_lcm

namespace footfall::engine {

// Values of Machine::parameters() just after a tick's edits, by slot: copied by the tick
// (EditDoor::copy_targets), passed on by the link.
struct LiveState {
  std::int64_t tick = 0;
  std::uint64_t revision = 0;  // revision of the door in that tick
  std::span<const double> now;
  std::span<const double> target;  // ramp targets; equal to `now` for values at rest
};

struct LiveSettings {
  std::int64_t session = 0;  // random number of the run
  bool keyed = true;         // requests need the key; only reported to clients, not checked here
  // Identity for clients: host, process, start (us since 1970).
  std::string host{};
  std::int64_t pid = 0, start = 0;
};

// Numbers of requests with a valid key, by result.
struct LiveCounters {
  std::int64_t requests = 0;
  std::int64_t applied = 0;
  std::int64_t refused = 0;   // each counted once
  std::int64_t repeated = 0;  // repetitions, answered with the same content
};

class LiveServer {
 public:
  using Answers = std::vector<footfall_lcm::answer_t>;

  // `behavior` and `entrance` must outlive the server, or its next rebind().
  LiveServer(const behaviors::Behavior& behavior, EditEntrance& entrance,
             const LiveSettings& settings);
  ~LiveServer();

  // Edits are judged by this from now on, until the next rebind(): with what `run` would refuse to
  // start, no edit is accepted. nullptr: not judged. Not owned.
  void judge_by(behaviors::EditedValues* edited);

  // Handles a request whose key was already checked. Immediate answers (refusals, repetitions) are
  // appended to `answers`; the others are returned by poll(). Each (client, sequence) is executed
  // at most once and always answered with the same content; before the first answer, repetitions
  // are ignored. `mac` is set by the link.
  void request(const footfall_lcm::request_t& request, Answers& answers);
  // Takes the door's answers and continues undo or redo requests that waited for them. Call it
  // often, for short response times: without news it only reads one atomic number.
  void poll(Answers& answers);

  // Everything that is constant until the next rebind(), and the current revision. Signals, states,
  // tasks, feet and faults are complete, in the order of their indices in the behavior.
  void fill_catalogue(footfall_lcm::catalogue_t& catalogue) const;
  // The current values in the order of the catalogue.
  void fill_values(const LiveState& state, footfall_lcm::values_t& values);
  // Whether an edit was applied since the last fill_values(), through any entrance.
  bool changed() const noexcept;

  std::int64_t session() const noexcept;
  std::int64_t generation() const noexcept;
  // Number of changes so far, including reloads: the revision that a request may expect.
  std::int64_t revision() const noexcept;
  // The same number for a LiveState or an EditAnswer.
  std::int64_t revision_of(std::uint64_t door_revision) const noexcept;
  const LiveCounters& counters() const noexcept;

  // Switches to another behavior and its door. The old ones must still exist, with their tick
  // ended: applied edits are answered so, waiting ones are refused with `reason`. The revision
  // continues (the reload counts as a change), the undo history is cleared, the generation is
  // incremented.
  void rebind(const behaviors::Behavior& behavior, EditEntrance& entrance,
              const std::string& reason, Answers& answers);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::engine
