// The client's side of live tuning; see client.h.
#include "engine/lcm/client.h"

#include <sodium.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <footfall_lcm/hello_t.hpp>
#include <map>
#include <set>
#include <utility>

#include "core/process/machine_error.h"
#include "engine/lcm/bus.h"
#include "engine/lcm/known_engines.h"
#include "engine/live/client_name.h"
#include "engine/live/codec.h"

namespace footfall::engine {
namespace {

using namespace footfall_lcm;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMost = 4096;          // limit of stored answers and of stored telemetry
constexpr std::size_t kLargest = 4'000'000;  // bytes, limit of a message
constexpr double kHelloApart = 0.3;          // s between hello messages
constexpr double kSilent = 1.5;              // s of silence after which another session is accepted
constexpr double kLook = 0.35;               // s to wait for the catalogues of other engines

double seconds_since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

int index_of(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

}  // namespace

struct LiveClient::Impl {
  explicit Impl(const LiveClientSettings& how) : settings(how), bus(url_of(how), kLargest) {
    check_live_prefix(how.prefix);
    settings.who = client_name(settings.who);
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
        other_version |=
            problem == PacketProblem::wrong_type || problem == PacketProblem::other_protocol;
      }
    });
  }

  // Remembers an engine with another key, only for why_not().
  void look_at_stranger(std::span<const std::uint8_t> packet) {
    catalogue_t other;
    if (decode(packet, nullptr, other) == PacketProblem::none) {
      stranger = other.keyed ? Stranger::other_key : Stranger::open;
      known.note(other, false);
    }
  }

  bool is_wanted(std::int64_t session) const {
    return settings.session == 0 || settings.session == session ||
           settings.session == session_number(session);
  }
  bool is_silent() const { return seconds_since(heard_at) >= kSilent; }

  // --- Receiving. ---
  void take_catalogue(const catalogue_t& message) {
    if (settings.key.has_value() != static_cast<bool>(message.keyed)) {
      stranger = message.keyed ? Stranger::wants_key : Stranger::open;
      known.note(message, false);
      ++rejected;
      return;
    }
    known.note(message, true);
    if (!is_wanted(message.session)) return;
    const bool other = message.session != catalogue.session;
    // A second engine or an old packet must not replace the current engine.
    const bool late = !other && message.generation < catalogue.generation;
    if (message.session == 0 || !fits(message) || late ||
        (other && catalogue.session != 0 && !is_silent())) {
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
    keep(all_values, message);
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
      known.note(message.session);
      return;
    }
    heard_at = Clock::now();
    if (message.client == number) {
      unanswered.erase(message.sequence);
      if (asked == message.sequence) answered = message;
    }
    const std::pair<std::int64_t, std::int64_t> name = {message.client, message.sequence};
    if (!seen.insert(name).second) return;
    known_order.push_back(name);
    if (known_order.size() > kMost) {
      seen.erase(known_order.front());
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
    const bool own = message.session == catalogue.session;
    if (!own) known.note(message.session);
    if (now) {
      heard_at = Clock::now();
    } else if (own || catalogue.session == 0 || is_silent()) {
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
    const bool lost = !unanswered.empty() && is_silent();
    if ((hello_wanted || !connected() || lost) && seconds_since(hello_at) >= kHelloApart) {
      hello_wanted = false;
      hello_at = Clock::now();
      hello_t hello{};
      hello.client = number;
      hello.session = connected() && !is_silent() && !looking ? catalogue.session : 0;
      bus.publish(channel("HELLO"), encode(hello, nullptr));
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
  std::vector<values_t> all_values;
  std::vector<telemetry_t> all_telemetry;
  std::set<std::pair<std::int64_t, std::int64_t>> seen;  // answers, by client and sequence
  std::deque<std::pair<std::int64_t, std::int64_t>> known_order;
  std::int64_t asked = 0;  // sequence that ask() waits for
  std::optional<answer_t> answered;
  std::int64_t arrived = 0, rejected = 0;
  KnownEngines known;
  bool other_version = false, looking = false;
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
  if (impl_->connected() && impl_->settings.session == 0) {
    look(std::max(0.0, kLook - seconds_since(begin)));
  }
  return impl_->connected();
}

std::vector<EngineIdentity> LiveClient::look(double seconds) {
  const auto begin = Clock::now();
  impl_->looking = impl_->hello_wanted = true;
  // Who was heard, but has not said yet who it is, gets some more time.
  const auto waits = [&](double passed) {
    return passed < seconds || (!impl_->known.all_named() && passed < seconds + kSilent);
  };
  for (double passed = 0.0; waits(passed); passed = seconds_since(begin)) {
    impl_->hello_wanted |= !impl_->known.all_named();
    impl_->poll(std::max(0.01, std::min(seconds - passed, 0.1)));
  }
  impl_->looking = false;
  return engines();
}

std::vector<EngineIdentity> LiveClient::engines() const { return impl_->known.list(); }

bool LiveClient::other_version() const { return impl_->other_version; }

bool LiveClient::connected() const { return impl_->connected(); }

std::string LiveClient::why_not() const {
  const LiveClientSettings& settings = impl_->settings;
  if (settings.session != 0) {
    const auto engines = impl_->known.list();
    const bool there = std::ranges::any_of(
        engines, [&](const auto& engine) { return impl_->is_wanted(engine.session); });
    if (!there && !engines.empty()) {
      return "no engine of session " + std::to_string(settings.session) + " answers on " +
             Impl::url_of(settings) + ": `footfall tune list-engines` lists those that do";
    }
  }
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
  if (impl_->other_version) {
    return "an engine of another version is on " + Impl::url_of(settings) + ", channels " +
           settings.prefix + "_*, and is not understood (this is protocol " +
           std::to_string(hello_t::PROTOCOL) + "): use the program of the run";
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
std::vector<values_t> LiveClient::take_values() { return std::exchange(impl_->all_values, {}); }
std::vector<telemetry_t> LiveClient::take_telemetry() {
  return std::exchange(impl_->all_telemetry, {});
}
std::int64_t LiveClient::client() const { return impl_->number; }
const std::string& LiveClient::who() const { return impl_->settings.who; }
std::int64_t LiveClient::rejected() const { return impl_->rejected; }

}  // namespace footfall::engine
