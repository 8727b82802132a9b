// Undo and redo against a naive model, and the memory of what clients asked for.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

#include "engine/live/answered_requests.h"
#include "tests/unit/engine/live/live_rig.h"

namespace footfall::tests {
namespace {

using engine::LiveClients;
using footfall_lcm::answer_t;
using footfall_lcm::request_t;
using LiveHistory = LiveServer;

// The model: a list of value lists and a place in it.
TEST_F(LiveHistory, AnySequenceOfEditsUndosAndRedosIsThatOfANaiveStack) {
  std::mt19937_64 random(11);
  std::vector<std::vector<double>> states = {{0.145, 0.0, 0.0}};
  std::size_t place = 0;
  std::vector<std::pair<request_t, bool>> asked;  // and whether the model says it can be done
  std::vector<answer_t> all;
  for (int k = 0; k < 3000; ++k) {
    const auto dice = random() % 10;
    request_t request = ask(dice < 3   ? request_t::UNDO
                            : dice < 5 ? request_t::REDO
                                       : request_t::EDIT);
    bool possible = true;
    if (request.what == request_t::UNDO) {
      possible = place > 0;
      place -= possible ? 1 : 0;
    } else if (request.what == request_t::REDO) {
      possible = place + 1 < states.size();
      place += possible ? 1 : 0;
    } else {
      std::vector<double> next = states[place];
      next[0] = std::uniform_real_distribution<double>(0.08, 0.4)(random);
      const std::size_t y = random() % 2;
      next[1 + y] = std::uniform_real_distribution<double>(-5.0, 5.0)(random);
      possible = random() % 4 != 0;  // else one of the two is out of range
      --sequence;
      request = edit({{"lift_time", {next[0]}},
                      {y == 0 ? "goal.x" : "goal.y", {possible ? next[1 + y] : 6.0}}});
      if (possible) {
        states.resize(place + 1);
        states.push_back(next);
        ++place;
      }
    }
    request.over = random() % 3 == 0 ? 5e-3 : 0.0;
    asked.emplace_back(request, possible);
    server.request(request, all);
    if (random() % 3 == 0) bench.tick();
    server.poll(all);
    if (random() % 20 != 0 && k < 2999) continue;
    for (int t = 0; t < 80; ++t) {  // until all is answered
      bench.tick();
      server.poll(all);
    }
    ASSERT_EQ(values().target, states[place]) << k;
    ASSERT_EQ(values().now, states[place]) << k;
    ASSERT_EQ(values().undo_count, static_cast<int>(place));
    ASSERT_EQ(values().redo_count, static_cast<int>(states.size() - 1 - place));
  }
  // Each was answered exactly once, refused where the model could not.
  std::set<std::int64_t> sequences;
  for (const answer_t& a : all) {
    const auto& [request, possible] = asked[static_cast<std::size_t>(a.sequence - 1)];
    EXPECT_EQ(a.accepted != 0, possible) << a.sequence;
    sequences.insert(a.sequence);
  }
  EXPECT_EQ(all.size(), asked.size());
  EXPECT_EQ(sequences.size(), asked.size());
}

TEST(LiveClients, MemoryIsBoundedAndWhatWasForgottenIsTooOld) {
  using Verdict = LiveClients::Verdict;
  LiveClients clients(2, 3);
  const auto done = [&](std::int64_t client, std::int64_t sequence) {
    EXPECT_EQ(clients.look(client, sequence), Verdict::fresh);
    EXPECT_EQ(clients.look(client, sequence), Verdict::pending);
    answer_t answer{};
    answer.client = client;
    answer.sequence = sequence;
    clients.keep(answer);
  };
  done(-5, 1);
  done(-5, 2);
  done(7, 1);
  EXPECT_EQ(clients.look(-5, 1), Verdict::answered);
  EXPECT_EQ(clients.answer().sequence, 1);
  done(7, 2);
  EXPECT_EQ(clients.look(-5, 1), Verdict::too_old);
  EXPECT_EQ(clients.look(-5, 2), Verdict::answered);
  EXPECT_EQ(clients.look(8, 1), Verdict::too_many);
  done(7, std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(clients.look(7, 3), Verdict::too_old);
}

}  // namespace
}  // namespace footfall::tests
