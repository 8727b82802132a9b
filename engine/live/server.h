// What an engine answers to people who tune it: requests in, answers out, with no network, no
// clock and no thread in it. It checks who asks, in which order and for what, hands edits to the
// door, keeps what can be undone, and says which values are in force. Used by one thread, that of
// the link; the tick goes on behind the door.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/edits/door.h"

namespace footfall_lcm {
class answer_t;
class catalogue_t;
class request_t;
class values_t;
}  // namespace footfall_lcm

namespace footfall::engine {

// Values of Machine::parameters() just after a tick's edits, by slot: the tick copies them
// (EditDoor::copy_targets), the link hands them over.
struct LiveState {
  std::int64_t tick = 0;
  std::uint64_t revision = 0;  // of the door, in that tick
  std::span<const double> now;
  std::span<const double> target;  // where those are going that ramp; else as `now`
};

struct LiveSettings {
  std::int64_t session = 0;  // drawn at random for each run
  bool keyed = true;         // requests need the key: only told to clients, here
};

// Requests that arrived with the right key, by what became of them.
struct LiveCounters {
  std::int64_t requests = 0;
  std::int64_t applied = 0;
  std::int64_t refused = 0;   // once each
  std::int64_t repeated = 0;  // answered again, the same
};

class LiveServer {
 public:
  using Answers = std::vector<footfall_lcm::answer_t>;

  // `behavior` and `entrance` must outlive the server, or its next rebind().
  LiveServer(const behaviors::Behavior& behavior, EditEntrance& entrance,
             const LiveSettings& settings);
  ~LiveServer();

  // A request whose key was checked already. What is answered at once is put at the end of
  // `answers` (refusals, repetitions); the rest comes from poll(). Each (client, sequence) is done
  // at most once and answered with the same content however often it arrives; while its first
  // answer is not there yet, a repetition is silent. `mac` is left to the link.
  void request(const footfall_lcm::request_t& request, Answers& answers);
  // Takes the door's answers; an undo or redo that waited for them goes on. Call it often (it is
  // what makes answers fast): with nothing to do it reads one atomic number.
  void poll(Answers& answers);

  // Everything that does not change until the next rebind(), and the present revision. Signals,
  // states, tasks, feet and faults are all there are, by their indices in the behavior.
  void fill_catalogue(footfall_lcm::catalogue_t& catalogue) const;
  // The values in force in the order of the catalogue.
  void fill_values(const LiveState& state, footfall_lcm::values_t& values);
  // Whether something was applied since the last fill_values(), through this door or another.
  bool changed() const noexcept;

  std::int64_t session() const noexcept;
  std::int64_t generation() const noexcept;
  // Changes made so far, reloads included: what a client may expect in a request.
  std::int64_t revision() const noexcept;
  // That of a LiveState or an EditAnswer, counted likewise.
  std::int64_t revision_of(std::uint64_t door_revision) const noexcept;
  const LiveCounters& counters() const noexcept;

  // From now on another behavior, with its door. The old ones must still be there, their tick
  // ended: what it applied is answered so, what still waits is refused with `reason`. The revision
  // goes on (the reload counts as a change), nothing can be undone, the generation is one more.
  void rebind(const behaviors::Behavior& behavior, EditEntrance& entrance,
              const std::string& reason, Answers& answers);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::engine
