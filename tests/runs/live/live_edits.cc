// Sends edits at a rate, a third of them invalid, some of them twice or more, and judges what comes
// back: each answered, a repeated one the same, no invalid one accepted, and the values in force
// always those of the accepted ones, whole. Prints one JSON object.
//   --url URL --prefix NAME --key FILE --count N --rate R --seed S
#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/lcm/bus.h"
#include "engine/live/codec.h"
#include "tests/runs/live/options.h"
#include "tests/runs/live/random_edits.h"

namespace footfall::tests {
namespace {

using namespace footfall_lcm;
using Clock = std::chrono::steady_clock;

constexpr double kRetry = 0.1;           // s without an answer
constexpr double kPatience = 60.0;       // s for the last answers
constexpr std::int64_t kRepeatOf = 200;  // newest requests of which some are sent again

double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }

struct Sent {
  engine::PacketBytes packet;
  std::vector<change_t> changes;
  bool valid = false;
  std::int64_t times = 0;  // it was sent
  Clock::time_point first, last;
  std::int64_t answers = 0;
  engine::PacketBytes answer;  // the first one
  answer_t read;
};

class Load {
 public:
  explicit Load(const Options& options)
      : options_(options), settings_(options.client()), watch_(settings_), bus_(settings_.url) {
    connect_or_exit(watch_);
    edits_ = std::make_unique<RandomEdits>(watch_.catalogue(),
                                           static_cast<std::uint64_t>(options.number("--seed", 1)));
    start_ = watch_.values().target;
    first_revision_ = watch_.values().revision;
    bus_.subscribe(settings_.prefix + "_ANSWER",
                   [this](std::span<const std::uint8_t> packet) { hear(packet); });
    client_ = watch_.client() ^ 1;
  }

  nlohmann::json run() {
    const auto count = static_cast<std::int64_t>(options_.number("--count", 1000));
    const double rate = options_.number("--rate", 500.0);
    // Revision 0 must be past before one expects it.
    const auto begin = Clock::now();
    for (std::int64_t k = 0; k < count; ++k) {
      while (seconds(Clock::now() - begin) < static_cast<double>(k) / rate) listen();
      send_new(k);
      if (edits_->below(20) == 0) send_again();
    }
    const auto end = Clock::now();
    while (!waiting_.empty() && seconds(Clock::now() - end) < kPatience) listen();
    for (int k = 0; k < 400 && !told_all(); ++k) listen();
    return judge(seconds(end - begin));
  }

 private:
  void send_new(std::int64_t k) {
    const bool valid = k == 0 || edits_->below(3) != 0;
    request_t request =
        valid ? edits_->valid() : edits_->invalid(edits_->below(RandomEdits::kWays));
    request.session = watch_.catalogue().session;
    request.client = client_;
    request.sequence = k + 1;
    request.who = settings_.who.empty() ? "load" : settings_.who;
    Sent& sent = sent_[request.sequence];
    sent.valid = valid;
    sent.changes = request.changes;
    sent.packet = engine::encode(request, &*settings_.key);
    sent.first = Clock::now();
    waiting_.insert(request.sequence);
    publish(sent);
  }

  void send_again() {
    const auto newest = static_cast<std::int64_t>(sent_.size());
    const std::int64_t back = edits_->below(static_cast<int>(std::min(newest, kRepeatOf)));
    publish(sent_.at(newest - back));
  }

  void publish(Sent& sent) {
    sent.last = Clock::now();
    ++sent.times;
    bus_.publish(settings_.prefix + "_REQUEST", sent.packet);
  }

  void listen() {
    bus_.poll(1);
    watch_.poll(0.0);
    remember_values();
    const auto now = Clock::now();
    for (const std::int64_t sequence : waiting_) {
      Sent& sent = sent_.at(sequence);
      if (seconds(now - sent.last) >= kRetry) publish(sent);
    }
  }

  void hear(std::span<const std::uint8_t> packet) {
    answer_t answer;
    if (engine::decode(packet, &*settings_.key, answer) != engine::PacketProblem::none ||
        answer.client != client_) {
      return;
    }
    const auto found = sent_.find(answer.sequence);
    if (found == sent_.end()) {
      ++unasked_;
      return;
    }
    Sent& sent = found->second;
    if (++sent.answers > 1) {
      differing_ += std::ranges::equal(packet, sent.answer) ? 0 : 1;
      return;
    }
    sent.answer.assign(packet.begin(), packet.end());
    sent.read = answer;
    latencies_.push_back(seconds(Clock::now() - sent.first));
    waiting_.erase(answer.sequence);
  }

  void remember_values() {
    const values_t& values = watch_.values();
    if (values.revision == last_values_.revision && values.target == last_values_.target) return;
    last_values_ = values;
    told_[values.revision] = values.target;
  }

  bool told_all() {
    std::int64_t newest = first_revision_;
    for (const auto& [sequence, sent] : sent_) {
      if (sent.read.accepted) newest = std::max(newest, sent.read.revision);
    }
    return !told_.empty() && told_.rbegin()->first >= newest;
  }

  // The targets after each accepted edit, in the order of their revisions, against those that the
  // engine told: a torn, lost or invalid edit would differ.
  std::int64_t wrong_values(std::int64_t& compared) const {
    std::map<std::int64_t, const Sent*> accepted;
    for (const auto& [sequence, sent] : sent_) {
      if (sent.read.accepted) accepted[sent.read.revision] = &sent;
    }
    std::vector<double> target = start_;
    std::int64_t wrong = 0;
    auto next = accepted.begin();
    for (const auto& [revision, told] : told_) {
      if (revision < first_revision_) continue;
      for (; next != accepted.end() && next->first <= revision; ++next)
        apply(*next->second, target);
      ++compared;
      wrong += target == told ? 0 : 1;
    }
    return wrong;
  }

  void apply(const Sent& sent, std::vector<double>& target) const {
    for (const change_t& change : sent.changes) {
      const int parameter = watch_.find_parameter(change.name);
      if (parameter < 0) continue;
      const auto first = watch_.catalogue().parameters[static_cast<std::size_t>(parameter)].first +
                         std::max(0, change.component);
      std::ranges::copy(change.values, target.begin() + first);
    }
  }

  nlohmann::json judge(double time) {
    std::int64_t unanswered = 0, invalid = 0, invalid_accepted = 0, valid_refused = 0, extra = 0,
                 accepted = 0, repeated = 0;
    std::map<std::string, int> refusals;
    for (const auto& [sequence, sent] : sent_) {
      unanswered += sent.answers == 0 ? 1 : 0;
      invalid += sent.valid ? 0 : 1;
      invalid_accepted += !sent.valid && sent.read.accepted ? 1 : 0;
      accepted += sent.read.accepted ? 1 : 0;
      extra += sent.answers > sent.times ? 1 : 0;
      repeated += sent.times > 1 ? 1 : 0;
      if (sent.valid && sent.answers > 0 && !sent.read.accepted) {
        ++valid_refused;
        if (refusals.size() < 20) ++refusals[sent.read.reasons.empty() ? "" : sent.read.reasons[0]];
      }
    }
    std::ranges::sort(latencies_);
    const auto percentile = [&](double part) {
      if (latencies_.empty()) return 0.0;
      const auto last = static_cast<double>(latencies_.size() - 1);
      return latencies_[static_cast<std::size_t>(part * last)] * 1e3;
    };
    std::int64_t compared = 0;
    const std::int64_t wrong = wrong_values(compared);
    return {{"sent", sent_.size()},
            {"seconds", time},
            {"invalid", invalid},
            {"accepted", accepted},
            {"repeated", repeated},
            {"unanswered", unanswered},
            {"answered_more_often_than_sent", extra},
            {"unasked", unasked_},
            {"repeated_differently", differing_},
            {"invalid_accepted", invalid_accepted},
            {"valid_refused", valid_refused},
            {"refusals_of_valid", refusals},
            {"values_compared", compared},
            {"values_wrong", wrong},
            {"answer_ms",
             {{"p50", percentile(0.5)}, {"p99", percentile(0.99)}, {"max", percentile(1.0)}}}};
  }

  const Options& options_;
  engine::LiveClientSettings settings_;
  engine::LiveClient watch_;
  engine::LcmBus bus_;
  std::unique_ptr<RandomEdits> edits_;
  std::int64_t client_ = 0, first_revision_ = 0;
  std::vector<double> start_;
  std::map<std::int64_t, Sent> sent_;
  std::set<std::int64_t> waiting_;
  std::vector<double> latencies_;
  values_t last_values_{};
  std::map<std::int64_t, std::vector<double>> told_;  // targets by revision
  std::int64_t unasked_ = 0, differing_ = 0;
};

}  // namespace
}  // namespace footfall::tests

int main(int argc, char** argv) {
  const footfall::tests::Options options(argc, argv);
  try {
    const nlohmann::json result = footfall::tests::Load(options).run();
    std::printf("%s\n", result.dump().c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
