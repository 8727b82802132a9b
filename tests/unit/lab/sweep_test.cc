// Sweeps before and after their runs: plans, draws, statistics, the file of results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>

#include "lab/sweep/plan/loader.h"
#include "lab/sweep/plan/sample.h"
#include "lab/sweep/results/factors.h"
#include "lab/sweep/results/report.h"
#include "lab/sweep/results/runner.h"
#include "lab/sweep/results/store.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

struct Read {
  SweepDescription sweep;
  std::string errors;
};

// `behavior` names a file that is there: whether it is a behavior is not asked here.
Read read(const std::string& rest) {
  core::Diagnostics diagnostics;
  const std::string text = "sweep: 1\nbehavior: README.md\n" + rest;
  const core::YamlNode root = core::load_yaml_text(text, "s.yaml", diagnostics);
  Read out;
  out.sweep = read_sweep(root, "s.yaml", {{FOOTFALL_SOURCE_DIR}}, diagnostics);
  out.errors = diagnostics.to_string();
  if (out.sweep.seeds.empty()) out.sweep.seeds = {1};
  return out;
}

std::vector<std::string> texts(const SweepAxis& axis) {
  std::vector<std::string> list;
  for (const SweepValue& value : axis.values) list.push_back(value.text);
  return list;
}

TEST(SweepPlan, IsEveryCombinationOnceAndSeedsVaryFastest) {
  const Read r = read(
      "vary: {a: [1, 2, 3], b: [x, y]}\nzip: {c: [1, 2], d: [5, 6]}\n"
      "worlds: [flat, slippery]\nfaults: [none, mocap.dropout]\nseeds: 7..9\n");
  ASSERT_EQ(r.errors, "");
  EXPECT_EQ(run_count(r.sweep), 3u * 2u * 2u * 2u * 2u * 3u);
  std::set<std::string> keys;
  for (std::size_t id = 0; id < run_count(r.sweep); ++id) {
    const SweepRun run = run_of(r.sweep, id);
    EXPECT_EQ(run.seed, 7 + id % 3);
    EXPECT_EQ(run.values[2], run.values[3]) << "zipped";
    keys.insert(key_of(r.sweep, run));
  }
  EXPECT_EQ(keys.size(), run_count(r.sweep));
}

TEST(SweepPlan, AGridHasBothEndsAndKeepsTheUnitItIsWrittenWith) {
  const Read r = read(
      "vary: {t: {from: 130 ms, to: 160 ms, count: 4}, "
      "u: {from: 1, to: 1000, count: 4, log: true}, v: {from: 130 ms, to: 0.15 s, count: 2}}");
  ASSERT_EQ(r.errors, "");
  EXPECT_THAT(texts(r.sweep.axes[0]), ElementsAre("130 ms", "140 ms", "150 ms", "160 ms"));
  EXPECT_EQ(r.sweep.axes[0].unit, "ms");
  EXPECT_THAT(texts(r.sweep.axes[1]), ElementsAre("1", "10", "100", "1000"));
  EXPECT_THAT(texts(r.sweep.axes[2]), ElementsAre("0.13 s", "0.15 s"));
}

TEST(SweepPlan, TheCommandLineAndTheFileGiveTheSamePlan) {
  SweepArguments a;
  a.what = "README.md";
  a.vary = {"t=130ms..160ms:4", "kp=[200, [1, 2, 3]]", "one=5"};
  a.sample = {"m=uniform(1 kg, 2 kg)"};
  a.count = "3";
  a.seeds = "100..104";
  a.faults = "none,mocap.dropout@5s:2s";
  a.worlds = "flat,slippery";
  a.duration = "20s";
  core::Diagnostics diagnostics;
  const core::YamlNode tree = sweep_tree(a, false, diagnostics);
  const SweepDescription sweep = read_sweep(tree, "README.md", {}, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  const Read file = read(
      "vary: {t: {from: 130ms, to: 160ms, count: 4}, kp: [200, [1, 2, 3]], one: [5]}\n"
      "sample: {count: 3, of: {m: {uniform: [1 kg, 2 kg]}}}\nseeds: 100..104\n"
      "faults: [none, {fault: mocap.dropout, at: 5s, for: 2s}]\n"
      "worlds: [flat, slippery]\nfor: 20s\n");
  ASSERT_EQ(file.errors, "");
  EXPECT_EQ(plan_digest(sweep), plan_digest(file.sweep));
}

TEST(SweepPlan, AnythingThatChangesARunChangesTheDigestAndWordsForPeopleDoNot) {
  const std::string base = "vary: {a: [1, 2]}\nseeds: 1..3\nfor: 5 s\n";
  const std::string digest = plan_digest(read(base).sweep);
  EXPECT_EQ(plan_digest(read(base + "doc: \"why\"\nfigures: [steps]\n").sweep), digest);
  for (const char* other :
       {"vary: {a: [1, 3]}\nseeds: 1..3\nfor: 5 s\n", "vary: {a: [1, 2]}\nseeds: 1..4\nfor: 5 s\n",
        "vary: {a: [1, 2]}\nseeds: 1..3\nfor: 6 s\n",
        "vary: {a: [1, 2]}\nseeds: 1..3\nfor: 5 s\nworlds: slippery\n"}) {
    EXPECT_NE(plan_digest(read(other).sweep), digest) << other;
  }
}

TEST(SweepPlan, AFaultThatIsNotKnownIsNoSecondNone) {
  const std::string errors = read("faults: [none, imu.freez, {at: 1 s}]").errors;
  EXPECT_THAT(errors, HasSubstr("did you mean 'imu.freeze'"));
  EXPECT_THAT(errors, testing::Not(HasSubstr("twice")));
}

TEST(SweepPlan, MistakesAreReportedAtTheirPlace) {
  const auto says = [](const char* text, const char* words) {
    EXPECT_THAT(read(text).errors, HasSubstr(words)) << text;
  };
  says("vary: {a: []}", "s.yaml:3:11: error: no values");
  says("vary: {a: [1, 1]}", "s.yaml:3:15: error: the value 1 twice");
  says("faults: [none, none]", "s.yaml:3:16: error: 'none' twice");
  says("vary: {a: {from: 1 s, to: 2 N, count: 2}}", "expected a time, got '2 N'");
  says("vary: {a: {from: 1, to: 2, count: 1}}", "s.yaml:3:35: error:");
  says("zip: {a: [1, 2], b: [1]}", "s.yaml:3:21: error: 1 values beside 2 of 'a'");
  says("zip: {a: [1, 1], b: [2, 2]}",
       "s.yaml:3:14: error: row 2 of the zipped lists is row 1 once more");
  says("vary: {a: [1]}\nzip: {a: [2]}", "s.yaml:4:7: error: 'a' is given values twice");
  says("sample: {count: 2, of: {a: {normal: [1, 0]}}}", "standard deviation must be above 0");
  says("sample: {count: 2, of: {a: {uniform: [1, 2], within: [1, 2]}}}", "belongs to 'normal'");
  says("faults: [mocap.droput]", "did you mean 'mocap.dropout'");
  says("seeds: 9..1", "s.yaml:3:8: error: expected a seed, or a range");
  says("scenario: README.md", "only one is allowed");
  says("vary: {a: {from: 1, to: 2, count: 100000}}\nseeds: 1..1000", "more than 1000000 runs");
  says("varry: {a: [1]}", "did you mean 'vary'");
}

TEST(SweepSample, DrawsAreTheSameAgainAndDoNotDependOnOtherParametersOrOnTheirNumber) {
  const auto few = unit_draws("kd", 1, 10, SampleMethod::random);
  auto many = unit_draws("kd", 1, 1000, SampleMethod::random);
  many.resize(10);
  EXPECT_EQ(few, many);
  EXPECT_NE(few, unit_draws("kp", 1, 10, SampleMethod::random));
  EXPECT_NE(few, unit_draws("kd", 2, 10, SampleMethod::random));
}

TEST(SweepSample, ALatinHypercubeHasOneDrawInEachPart) {
  constexpr std::size_t kCount = 50;
  std::set<std::size_t> parts;
  for (const double u : unit_draws("x", 3, kCount, SampleMethod::latin_hypercube)) {
    EXPECT_GT(u, 0.0);
    EXPECT_LT(u, 1.0);
    parts.insert(static_cast<std::size_t>(u * kCount));
  }
  EXPECT_EQ(parts.size(), kCount);
}

TEST(SweepSample, QuantilesAreThoseOfTheTables) {
  EXPECT_DOUBLE_EQ(quantile({Distribution::uniform, 2.0, 4.0}, 0.25), 2.5);
  EXPECT_NEAR(quantile({Distribution::log_uniform, 1.0, 100.0}, 0.5), 10.0, 1e-12);
  // z(0.975) of every table of the normal distribution.
  EXPECT_NEAR(quantile({Distribution::normal, 10.0, 2.0}, 0.975), 10.0 + 2.0 * 1.959963985, 1e-8);
  EXPECT_NEAR(quantile({Distribution::normal, 10.0, 2.0}, 0.5), 10.0, 1e-12);
  const DistributionSpec cut{Distribution::normal, 0.0, 1.0, -1.0, 0.5};
  for (const double u : unit_draws("x", 1, 200, SampleMethod::random)) {
    EXPECT_GE(quantile(cut, u), -1.0);
    EXPECT_LE(quantile(cut, u), 0.5);
  }
}

TEST(SweepSample, DrawsOfADistributionHaveItsMean) {
  double sum = 0.0;
  constexpr std::size_t kCount = 4000;
  for (const double u : unit_draws("m", 5, kCount, SampleMethod::random)) {
    sum += quantile({Distribution::normal, 3.0, 1.0}, u);
  }
  // Four standard errors.
  EXPECT_NEAR(sum / kCount, 3.0, 4.0 / std::sqrt(static_cast<double>(kCount)));
}

TEST(SweepStatistics, TheWilsonIntervalIsTheOneOfTheTextbook) {
  // 8 of 10: solving (p - 0.8)^2 = z^2 p (1 - p) / 10 by hand gives 0.490 and 0.943.
  const auto [low, high] = Share{8, 10}.interval();
  EXPECT_NEAR(low, 0.4901625, 1e-6);
  EXPECT_NEAR(high, 0.9433178, 1e-6);
  EXPECT_DOUBLE_EQ((Share{0, 10}.interval()[0]), 0.0);
  EXPECT_LT((Share{10, 10}.interval()[0]), 1.0);
}

TEST(SweepStatistics, RankCorrelationSeesOrderAlone) {
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {1, 10, 100, 1000}), 1.0);
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {9, 7, 3, 1}), -1.0);
  // Ranks 1 2 3 4 5 against 2 1 4 3 5: 1 - 6 * 4 / (5 * 24).
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4, 5}, {20, 10, 40, 30, 50}), 0.8);
  EXPECT_TRUE(std::isnan(rank_correlation({1, 2, 3}, {5, 5, 5})));
}

TEST(SweepSession, ShardsHaveEveryRunOnce) {
  std::multiset<std::size_t> all;
  for (int shard = 1; shard <= 4; ++shard) {
    for (const std::size_t id : shard_ids(10, shard, 4)) all.insert(id);
  }
  std::vector<std::size_t> every(10);
  std::iota(every.begin(), every.end(), std::size_t{0});
  EXPECT_THAT(all, testing::ElementsAreArray(every));
}

TEST(SweepSession, WhatAChildSaysBecomesFiguresByTheirPath) {
  ProcessResult child;
  child.end = ProcessEnd::exited;
  child.exit_code = 1;
  child.out =
      "chatter\n{\"end\": \"fall\", \"seed\": 3, \"fell\": true, \"error\": {\"pitch\": "
      "{\"max\": 0.25}}, \"log\": null, \"v\": [1, 2]}\n";
  const SweepResult result = read_sweep_result(child);
  EXPECT_EQ(result.status, SweepStatus::failed);
  EXPECT_EQ(result.end, "fall");
  const std::map<std::string, double> figures(result.figures.begin(), result.figures.end());
  EXPECT_EQ(figures, (std::map<std::string, double>{
                         {"error.pitch.max", 0.25}, {"fell", 1.0}, {"v.0", 1.0}, {"v.1", 2.0}}));
  child.out = "{\"end\": ";
  EXPECT_EQ(read_sweep_result(child).status, SweepStatus::bad_output);
  child.end = ProcessEnd::signalled;
  child.signal = 11;
  EXPECT_EQ(read_sweep_result(child).status, SweepStatus::crashed);
  child.end = ProcessEnd::cancelled;
  EXPECT_EQ(read_sweep_result(child).status, SweepStatus::pending);
}

class SweepStoreTest : public testing::Test {
 protected:
  SweepStoreTest() {
    folder_ = fs::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~SweepStoreTest() override { fs::remove_all(folder_); }

  std::string path(int shard = 1, int shards = 1) const {
    return store_path(folder_.string(), shard, shards);
  }
  static SweepIdentity identity(const SweepDescription& sweep, int shard = 1, int shards = 1) {
    return {plan_digest(sweep),    "inputs",         "program", "1",   "here",
            describe_sweep(sweep), run_count(sweep), shard,     shards};
  }
  static void begin(SweepStore& store, const SweepDescription& sweep, bool extend = false,
                    int shard = 1, int shards = 1) {
    store.begin(sweep, identity(sweep, shard, shards), shard_ids(run_count(sweep), shard, shards),
                extend);
  }
  static SweepResult result(double figure, SweepStatus status = SweepStatus::passed) {
    SweepResult r;
    r.status = status;
    r.figures = {{"error.pitch.max", figure}};
    return r;
  }

  fs::path folder_;
  SweepDescription sweep_ = read("vary: {a: [1, 2], b: [3, 4]}\nseeds: 1..2\n").sweep;
};

TEST_F(SweepStoreTest, WhatIsDoneStaysDoneAndTheRestIsPending) {
  {
    SweepStore store(path());
    begin(store, sweep_);
    EXPECT_EQ(store.pending().size(), 8u);
    store.record(3, "footfall run x", result(0.5));
    EXPECT_THROW(store.record(3, "again", result(0.6)), SweepStoreError);
  }
  SweepStore store(path());
  begin(store, sweep_);
  EXPECT_THAT(store.pending(), ElementsAre(0, 1, 2, 4, 5, 6, 7));
  const SweepTable table = store.read();
  EXPECT_EQ(table.rows[3].figures.at("error.pitch.max"), 0.5);
  EXPECT_EQ(table.rows[3].command, "footfall run x");
  EXPECT_EQ(table.rows[3].values.at("b"), "4");
}

TEST_F(SweepStoreTest, AChangedPlanIsRefusedUnlessItIsExtended) {
  SweepStore store(path());
  begin(store, sweep_);
  store.record(0, "", result(0.5));  // a 1, b 3, seed 1
  const SweepDescription more = read("vary: {a: [0, 1], b: [3, 4]}\nseeds: 1..2\n").sweep;
  EXPECT_THROW(begin(store, more), SweepStoreError);
  begin(store, more, true);
  EXPECT_EQ(store.pending().size(), 7u);
  EXPECT_EQ(store.read().rows[4].figures.at("error.pitch.max"), 0.5);  // a 1, b 3, seed 1
  SweepIdentity other = identity(more);
  other.inputs = "changed";
  EXPECT_THROW(store.begin(more, other, {}, true), SweepStoreError);
}

TEST_F(SweepStoreTest, ASecondWriterAndAForeignFileAreRefused) {
  SweepStore store(path());
  EXPECT_THROW(SweepStore second(path()), SweepStoreError);
  begin(store, sweep_);
  EXPECT_EQ(SweepStore(path(), SweepStore::Access::read).read().rows.size(), 8u) << "a reader may";
  const std::string text = path(1, 2);
  std::ofstream(text) << std::string(5000, 'x');
  EXPECT_THROW(SweepStore foreign(text), SweepStoreError);
}

TEST_F(SweepStoreTest, ShardsJoinToTheWholeHoweverOften) {
  for (int shard = 1; shard <= 3; ++shard) {
    SweepStore store(path(shard, 3));
    begin(store, sweep_, false, shard, 3);
    for (const std::size_t id : store.pending()) {
      if (id != 7) store.record(id, "", result(static_cast<double>(id)));
    }
  }
  for (int times = 0; times < 2; ++times) {
    const SweepStore whole(merge_shards(folder_.string()));
    const SweepTable table = whole.read();
    ASSERT_EQ(table.rows.size(), 8u);
    for (std::size_t id = 0; id < 7; ++id) {
      EXPECT_EQ(table.rows[id].figures.at("error.pitch.max"), static_cast<double>(id));
      EXPECT_EQ(table.rows[id].values.size(), 2u);
    }
    EXPECT_EQ(table.rows[7].result.status, SweepStatus::pending);
  }
  {
    SweepStore shard(path(2, 3));  // 7 = 1 + 2 * 3
    shard.record(7, "", result(7.0));
  }
  EXPECT_EQ(SweepStore(merge_shards(folder_.string())).pending().size(), 0u);
}

TEST_F(SweepStoreTest, TheViewOfResultsAndTheTableHaveAColumnForEachParameterAndFigure) {
  SweepStore store(path());
  begin(store, sweep_);
  store.record(0, "", result(0.5));
  store.make_view();
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path().c_str(), &db), SQLITE_OK);
  std::string got;
  const auto take = [](void* to, int count, char** values, char**) {
    for (int k = 0; k < count; ++k) *static_cast<std::string*>(to) += std::string(values[k]) + " ";
    return 0;
  };
  sqlite3_exec(db, "SELECT a, b, seed, \"error.pitch.max\" FROM results WHERE id = 0", take, &got,
               nullptr);
  sqlite3_close(db);
  EXPECT_EQ(got, "1 3 1 0.5 ");
  const std::string csv = sweep_csv(store.read());
  EXPECT_THAT(csv, HasSubstr("id,world,fault,seed,status,end,wall_s,a,b,error.pitch.max\n"));
  EXPECT_THAT(csv, HasSubstr("0,,none,1,passed,,0.000,1,3,0.5\n"));
}

TEST_F(SweepStoreTest, TheReportCountsPassedOfTriedAndLeavesOutWhatBroke) {
  SweepStore store(path());
  begin(store, sweep_);
  for (std::size_t id = 0; id < 4; ++id) store.record(id, "run it", result(0.1));  // a 1
  for (std::size_t id = 4; id < 7; ++id) {
    store.record(id, "run it", result(0.2, id == 4 ? SweepStatus::passed : SweepStatus::failed));
  }
  store.record(7, "run it", result(0.0, SweepStatus::crashed));
  const SweepTable table = store.read();
  const auto factors = sweep_factors(table);
  ASSERT_EQ(factors.size(), 2u);
  const Share a2 = share_of(table, [&](std::size_t r) { return factors[0].level[r] == 1; });
  EXPECT_EQ(a2.good, 1u);
  EXPECT_EQ(a2.of, 3u);
  const std::string html = sweep_report_html(table);
  EXPECT_THAT(html, HasSubstr("a 2, b 4: 0 of 1 passed"));
  EXPECT_THAT(html, HasSubstr("a 1, b 3: 2 of 2 passed, 100 %"));
  EXPECT_THAT(html, HasSubstr("5 of 7; 95 % interval"));
  EXPECT_THAT(html, testing::Not(HasSubstr("The seed changes nothing")));  // 6 and 7 differ
  EXPECT_THAT(html, HasSubstr("run it"));
  EXPECT_EQ(html.find("{{"), std::string::npos);
}

}  // namespace
}  // namespace footfall::lab
