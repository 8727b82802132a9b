// Two people change one parameter at the same time, each reading it, adding to it and expecting the
// revision that was read; who is told of a conflict reads again. Judges that no change was lost and
// how soon each hears of the other. Prints one JSON object.
//   --url URL --prefix NAME --key FILE --count N --parameter NAME
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/runs/live/options.h"

namespace footfall::tests {
namespace {

using namespace footfall_lcm;
using Clock = std::chrono::steady_clock;
using Name = std::pair<std::int64_t, std::int64_t>;  // client and sequence of a request

struct Change {
  double from = 0.0, to = 0.0;
};

// What one operator did and saw.
struct Seen {
  std::map<std::int64_t, Change> changes;  // by revision
  std::int64_t conflicts = 0, unanswered = 0;
  std::map<Name, Clock::time_point> sent, heard;  // accepted changes
};

class Operator {
 public:
  Operator(const Options& options, const std::string& who)
      : client_([&] {
          auto settings = options.client();
          settings.who = who;
          return settings;
        }()),
        parameter_name_(options.text("--parameter")) {
    connect_or_exit(client_);
    const int parameter = client_.find_parameter(parameter_name_);
    if (parameter < 0) throw std::runtime_error("no parameter '" + parameter_name_ + "'");
    info_ = client_.catalogue().parameters[static_cast<std::size_t>(parameter)];
  }

  // Makes so many changes, then listens until all `working` have made theirs, and for a moment
  // more.
  Seen work(std::int64_t count, double sign, std::atomic<int>& working) {
    for (std::int64_t done = 0; done < count;) done += change(sign) ? 1 : 0;
    --working;
    while (working > 0) hear(0.01);
    const auto end = Clock::now() + std::chrono::milliseconds(600);
    while (Clock::now() < end) hear(0.01);
    return seen_;
  }

  double value() const { return client_.values().target[static_cast<std::size_t>(info_.first)]; }

 private:
  bool change(double sign) {
    hear(0.0);
    request_t request{};
    request.revision = client_.values().revision;
    const double from = value();
    const double step =
        1e-3 * std::abs(client_.catalogue().values[static_cast<std::size_t>(info_.first)]);
    const Change change = {from, from + sign * step};
    change_t edit;
    edit.name = parameter_name_;
    edit.component = info_.size > 1 ? 0 : -1;
    edit.values = {change.to};
    request.changes.push_back(edit);
    const auto sent = Clock::now();
    const auto answer = client_.ask(request, 5.0);
    if (!answer) {
      ++seen_.unanswered;
      return true;
    }
    if (answer->accepted) {
      seen_.changes[answer->revision] = change;
      seen_.sent[{answer->client, answer->sequence}] = sent;
    } else {
      ++seen_.conflicts;
    }
    const std::int64_t known = std::max(request.revision + 1, answer->revision);
    const auto begin = Clock::now();
    while (client_.values().revision < known && Clock::now() - begin < std::chrono::seconds(5)) {
      hear(0.05);
    }
    return answer->accepted != 0;
  }

  void hear(double seconds) {
    client_.poll(seconds);
    for (const answer_t& answer : client_.take_answers()) {
      if (answer.accepted) seen_.heard.try_emplace({answer.client, answer.sequence}, Clock::now());
    }
  }

  engine::LiveClient client_;
  std::string parameter_name_;
  parameter_t info_;
  Seen seen_;
};

// Of what `one` did, how long until `other` had heard of it; unheard ones are counted.
void compare(const Seen& one, const Seen& other, std::vector<double>& delays,
             std::int64_t& unheard) {
  for (const auto& [name, sent] : one.sent) {
    const auto heard = other.heard.find(name);
    if (heard == other.heard.end()) {
      ++unheard;
    } else {
      delays.push_back(std::chrono::duration<double>(heard->second - sent).count());
    }
  }
}

nlohmann::json run(const Options& options) {
  const auto count = static_cast<std::int64_t>(options.number("--count", 100));
  Operator ann(options, "ann"), bob(options, "bob");
  Seen of_ann, of_bob;
  std::atomic<int> working{2};
  std::thread other([&] { of_bob = bob.work(count, -0.5, working); });
  of_ann = ann.work(count, 1.0, working);
  other.join();

  std::map<std::int64_t, Change> all = of_ann.changes;
  all.insert(of_bob.changes.begin(), of_bob.changes.end());
  std::int64_t lost = static_cast<std::int64_t>(of_ann.changes.size() + of_bob.changes.size()) -
                      static_cast<std::int64_t>(all.size());  // two of one revision
  const Change* before = nullptr;
  for (const auto& [revision, change] : all) {
    lost += before != nullptr && before->to != change.from ? 1 : 0;
    before = &change;
  }
  lost += before != nullptr && (ann.value() != before->to || bob.value() != before->to) ? 1 : 0;
  std::vector<double> delays;
  std::int64_t unheard = 0;
  compare(of_ann, of_bob, delays, unheard);
  compare(of_bob, of_ann, delays, unheard);
  std::ranges::sort(delays);
  return {{"changes", all.size()},
          {"conflicts", of_ann.conflicts + of_bob.conflicts},
          {"unanswered", of_ann.unanswered + of_bob.unanswered},
          {"lost", lost},
          {"unheard", unheard},
          {"heard_ms",
           {{"p50", delays.empty() ? 0.0 : delays[delays.size() / 2] * 1e3},
            {"max", delays.empty() ? 0.0 : delays.back() * 1e3}}}};
}

}  // namespace
}  // namespace footfall::tests

int main(int argc, char** argv) {
  const footfall::tests::Options options(argc, argv);
  try {
    std::printf("%s\n", footfall::tests::run(options).dump().c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
