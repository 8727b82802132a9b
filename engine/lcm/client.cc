// The client's side of live tuning; see client.h.
#include "engine/lcm/client.h"

#include <sodium.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <footfall_lcm/hello_t.hpp>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/process/machine_error.h"
#include "core/text/printable.h"
#include "engine/lcm/bus.h"
#include "engine/live/codec.h"

namespace footfall::engine {
namespace {

using namespace footfall_lcm;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMost = 4096;          // limit of stored answers and of stored telemetry
constexpr std::size_t kLargest = 4'000'000;  // bytes, limit of a message
constexpr double kHelloApart = 0.3;          // s between hello messages
constexpr double kSilent = 1.5;              // s of silence after which another session is accepted

double seconds_since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

std::string user_at_host() {
  std::array<char, 64> host{};
  ::gethostname(host.data(), host.size() - 1);
  const char* const user = std::getenv("USER");
  const std::string name = user != nullptr && *user != '\0' ? user : std::to_string(::getuid());
  return core::on_one_line(name + "@" + host.data());
}

// Whether the indices and sizes in the catalogue are consistent: they are used as indices.
bool fits(const catalogue_t& catalogue) {
  return std::ranges::all_of(catalogue.parameters, [&](const parameter_t& p) {
    return p.first >= 0 && p.size >= 1 && p.first <= catalogue.value_count - p.size;
  });
}

bool fits(const values_t& values, const catalogue_t& catalogue) {
  return values.count == catalogue.value_count;
}

bool fits(const telemetry_t& telemetry, const catalogue_t& catalogue) {
  const auto below = [](std::int32_t index, std::int32_t count) {
    return index >= 0 && index < count;
  };
  return telemetry.foot_count == catalogue.foot_count &&
         telemetry.fault_count == catalogue.fault_count &&
         telemetry.signal_count == catalogue.signal_count &&
         std::ranges::all_of(telemetry.active,
                             [&](auto state) { return below(state, catalogue.state_count); }) &&
         std::ranges::all_of(telemetry.tasks, [&](const task_t& task) {
           return below(task.name, catalogue.task_count);
         });
}

int index_of(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

}  // namespace

struct LiveClient::Impl {
  explicit Impl(const LiveClientSettings& how) : settings(how), bus(url_of(how), kLargest) {
    check_live_prefix(how.prefix);
    if (settings.who.empty()) settings.who = user_at_host();
    if (sodium_init() < 0) throw core::MachineError("this machine gives no random numbers");
    randombytes_buf(&number, sizeof number);
    number = std::max<std::int64_t>(1, number & INT64_MAX);
    telemetry.tick = -1;
    listen<catalogue_t>("CATALOGUE", &Impl::take_catalogue);
    listen<values_t>("VALUES", &Impl::take_values);
    listen<answer_t>("ANSWER", &Impl::take_answer);
    listen<telemetry_t>("TELEMETRY", &Impl::take_telemetry);
  }

  static std::string url_of(const LiveClientSettings& how) {
    return how.url.empty() ? default_url() : how.url;
  }
  std::string channel(const char* name) const { return settings.prefix + "_" + name; }
  const LiveKey* key() const { return settings.key ? &*settings.key : nullptr; }
  bool connected() const { return catalogue.session != 0 && values_here; }

  template <class Message>
  void listen(const char* name, void (Impl::*take)(const Message&)) {
    bus.subscribe(channel(name), [this, take](std::span<const std::uint8_t> packet) {
      Message message;
      const PacketProblem problem = decode(packet, key(), message);
      if (problem == PacketProblem::none) {
        ++arrived;
        (this->*take)(message);
      } else {
        ++rejected;
        if (problem == PacketProblem::not_authentic) look_at_stranger(packet);
      }
    });
  }

  // Remembers an engine with another key, only for why_not().
  void look_at_stranger(std::span<const std::uint8_t> packet) {
    catalogue_t other;
    if (decode(packet, nullptr, other) == PacketProblem::none) {
      stranger = other.keyed ? Stranger::other_key : Stranger::open;
    }
  }

  // --- Receiving. ---
  void take_catalogue(const catalogue_t& message) {
    if (settings.key.has_value() != static_cast<bool>(message.keyed)) {
      stranger = message.keyed ? Stranger::wants_key : Stranger::open;
      ++rejected;
      return;
    }
    const bool other = message.session != catalogue.session;
    // A second engine or an old packet must not replace the current engine.
    const bool late = !other && message.generation < catalogue.generation;
    if (message.session == 0 || !fits(message) || late ||
        (other && connected() && seconds_since(heard_at) < kSilent)) {
      ++rejected;
      return;
    }
    if (other || message.generation != catalogue.generation) {
      values_here = false;
      telemetry = {};
      telemetry.tick = -1;
    }
    if (other) give_up_waiting();
    catalogue = message;
    heard_at = Clock::now();
  }

  void take_values(const values_t& message) {
    if (!of_now(message) || !fits(message, catalogue) ||
        (values_here && message.tick < values.tick)) {
      ++rejected;
      return;
    }
    values = message;
    values_here = true;
  }

  void take_telemetry(const telemetry_t& message) {
    if (!of_now(message) || !fits(message, catalogue)) {
      ++rejected;
      return;
    }
    telemetry = message;
    keep(all_telemetry, message);
  }

  void take_answer(const answer_t& message) {
    if (message.session != catalogue.session) {
      ++rejected;
      hello_wanted = true;
      return;
    }
    heard_at = Clock::now();
    if (message.client == number) {
      unanswered.erase(message.sequence);
      if (asked == message.sequence) answered = message;
    }
    const std::pair<std::int64_t, std::int64_t> name = {message.client, message.sequence};
    if (!known.insert(name).second) return;
    known_order.push_back(name);
    if (known_order.size() > kMost) {
      known.erase(known_order.front());
      known_order.pop_front();
    }
    keep(answers, message);
  }

  // Whether a message belongs to the session and generation of the catalogue; if not, the catalogue
  // is requested.
  template <class Message>
  bool of_now(const Message& message) {
    const bool now = catalogue.session != 0 && message.session == catalogue.session &&
                     message.generation == catalogue.generation;
    if (now) {
      heard_at = Clock::now();
    } else {
      hello_wanted = true;
    }
    return now;
  }

  template <class Message>
  static void keep(std::vector<Message>& list, const Message& message) {
    if (list.size() >= kMost) list.erase(list.begin(), list.begin() + kMost / 2);
    list.push_back(message);
  }

  // The engine of pending requests is gone.
  void give_up_waiting() {
    for (const auto& [sequence, sent] : unanswered) {
      answer_t answer{};
      answer.session = catalogue.session;
      answer.client = number;
      answer.sequence = sequence;
      answer.who = settings.who;
      answer.tick = -1;
      answer.reasons = {"the engine was started anew before it answered"};
      answer.reason_count = 1;
      if (asked == sequence) answered = answer;
      keep(answers, answer);
    }
    unanswered.clear();
  }

  // --- Sending. ---
  void send_due() {
    if ((hello_wanted || !connected()) && seconds_since(hello_at) >= kHelloApart) {
      hello_wanted = false;
      hello_at = Clock::now();
      bus.publish(channel("HELLO"), encode(hello_t{number}, nullptr));
    }
    for (auto& [sequence, sent] : unanswered) {
      if (seconds_since(sent.at) < settings.retry) continue;
      sent.at = Clock::now();
      bus.publish(channel("REQUEST"), sent.packet);
    }
  }

  int poll(double seconds) {
    const auto begin = Clock::now();
    const std::int64_t before = arrived;
    do {
      send_due();
      const double left = std::max(0.0, seconds - seconds_since(begin));
      const double step = std::min(left, unanswered.empty() ? kHelloApart : settings.retry);
      bus.poll(static_cast<int>(std::ceil(step * 1e3)));
    } while (arrived == before && seconds_since(begin) < seconds);
    return static_cast<int>(arrived - before);
  }

  struct Sent {
    PacketBytes packet;
    Clock::time_point at;
  };
  enum class Stranger { none, other_key, open, wants_key };

  LiveClientSettings settings;
  LcmBus bus;
  std::int64_t number = 0, next_sequence = 1;
  catalogue_t catalogue{};
  values_t values{};
  telemetry_t telemetry{};
  bool values_here = false, hello_wanted = true;
  std::map<std::int64_t, Sent> unanswered;  // requests by sequence
  std::vector<answer_t> answers;
  std::vector<telemetry_t> all_telemetry;
  std::set<std::pair<std::int64_t, std::int64_t>> known;  // answers, by client and sequence
  std::deque<std::pair<std::int64_t, std::int64_t>> known_order;
  std::int64_t asked = 0;  // sequence that ask() waits for
  std::optional<answer_t> answered;
  std::int64_t arrived = 0, rejected = 0;
  Stranger stranger = Stranger::none;
  Clock::time_point heard_at{}, hello_at{};
};

LiveClient::LiveClient(const LiveClientSettings& settings)
    : impl_(std::make_unique<Impl>(settings)) {}
LiveClient::~LiveClient() = default;

bool LiveClient::connect(double timeout) {
  const auto begin = Clock::now();
  impl_->hello_wanted = true;
  while (!impl_->connected() && seconds_since(begin) < timeout) {
    impl_->poll(std::min(0.1, timeout));
  }
  return impl_->connected();
}

bool LiveClient::connected() const { return impl_->connected(); }

std::string LiveClient::why_not() const {
  switch (impl_->stranger) {
    case Impl::Stranger::other_key:
      return "an engine answers, but its key is another one: give the same file to both "
             "(`--lcm-key FILE` there, `--key FILE` here), or run both as the same user";
    case Impl::Stranger::open:
      return "the engine that answers runs with --lcm-open, without a key; that must be said here, "
             "too";
    case Impl::Stranger::wants_key:
      return "the engine that answers wants a key";
    case Impl::Stranger::none:
      break;
  }
  return "no engine answers on " + Impl::url_of(impl_->settings) + ", channels " +
         impl_->settings.prefix + "_*: `footfall run BEHAVIOR --lcm --realtime` starts one";
}

double LiveClient::silence() const { return seconds_since(impl_->heard_at); }
int LiveClient::poll(double seconds) { return impl_->poll(seconds); }
int LiveClient::file_descriptor() const { return impl_->bus.file_descriptor(); }
const catalogue_t& LiveClient::catalogue() const { return impl_->catalogue; }
const values_t& LiveClient::values() const { return impl_->values; }
const telemetry_t& LiveClient::telemetry() const { return impl_->telemetry; }

int LiveClient::find_parameter(std::string_view name) const {
  const auto& all = impl_->catalogue.parameters;
  const auto found = std::ranges::find(all, name, &parameter_t::name);
  return found == all.end() ? -1 : static_cast<int>(found - all.begin());
}

int LiveClient::find_signal(std::string_view name) const {
  return index_of(impl_->catalogue.signals, name);
}

std::int64_t LiveClient::send(request_t request) {
  request.session = impl_->catalogue.session;
  request.client = impl_->number;
  request.who = impl_->settings.who;
  if (request.sequence == 0) request.sequence = impl_->next_sequence;
  impl_->next_sequence = std::max(impl_->next_sequence, request.sequence + 1);
  const std::int64_t sequence = request.sequence;
  Impl::Sent& sent = impl_->unanswered[sequence];
  sent = {encode(std::move(request), impl_->key()), Clock::now()};
  impl_->bus.publish(impl_->channel("REQUEST"), sent.packet);
  return sequence;
}

std::optional<answer_t> LiveClient::ask(const request_t& request, double timeout) {
  const auto begin = Clock::now();
  impl_->answered.reset();
  impl_->asked = send(request);
  while (!impl_->answered && seconds_since(begin) < timeout) {
    impl_->poll(std::max(0.0, timeout - seconds_since(begin)));
  }
  impl_->unanswered.erase(std::exchange(impl_->asked, 0));
  return std::exchange(impl_->answered, std::nullopt);
}

std::size_t LiveClient::waiting() const { return impl_->unanswered.size(); }
std::vector<answer_t> LiveClient::take_answers() { return std::exchange(impl_->answers, {}); }
std::vector<telemetry_t> LiveClient::take_telemetry() {
  return std::exchange(impl_->all_telemetry, {});
}
std::int64_t LiveClient::client() const { return impl_->number; }
const std::string& LiveClient::who() const { return impl_->settings.who; }
std::int64_t LiveClient::rejected() const { return impl_->rejected; }

}  // namespace footfall::engine
