// Live edits of `estimator:`: what only its start takes, and what chooses it, are not live.
#include <gtest/gtest.h>

#include <footfall_lcm/catalogue_t.hpp>
#include <footfall_lcm/request_t.hpp>
#include <string>
#include <vector>

#include "engine/edits/door.h"
#include "engine/live/catalogue.h"
#include "engine/live/request.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

struct EstimatorEdits : testing::Test {
  // All reasons against new values of these parameters by an operator.
  std::string reasons(const std::vector<std::string>& names, engine::EditSource source) {
    footfall_lcm::request_t request{};
    for (const std::string& name : names) {
      footfall_lcm::change_t& change = request.changes.emplace_back();
      change.name = name;
      change.component = -1;
      change.values = {0.02};
    }
    std::vector<std::string> found;
    engine::EditBatch batch =
        engine::read_edit(*behavior, engine::LiveNames(*behavior), request, found);
    batch.source = source;
    for (const std::string& reason : engine::reasons_against(*behavior, batch, 0)) {
      found.push_back(reason);
    }
    std::string text;
    for (const std::string& reason : found) text += reason + "\n";
    return text;
  }

  std::unique_ptr<behaviors::Behavior> behavior =
      load("behavior: 1\nrobot: hume\nestimator: {type: contact_kalman}\nmachine: {}\n");
};

// After the start nothing reads it: an edit would be told as done and do nothing, whoever asks.
TEST_F(EstimatorEdits, WhatOnlyTheStartTakesIsRefusedFromEverySource) {
  for (const auto source : {engine::EditSource::live, engine::EditSource::set}) {
    EXPECT_EQ(reasons({"estimator.start_attitude"}, source),
              "estimator.start_attitude: not live, because only the start takes it: '--set' of a "
              "run gives it before\n");
    EXPECT_EQ(reasons({"estimator.foot_noise"}, source), "");
  }
}

TEST_F(EstimatorEdits, WhatChoosesTheEstimatorIsNotUnknown) {
  EXPECT_EQ(reasons({"estimator.type", "estimator.tpye"}, engine::EditSource::live).substr(0, 120),
            "estimator.type: not live, because an estimator is chosen before a run starts: in the "
            "file, or with '--set'\nno parameter ");
}

TEST_F(EstimatorEdits, TheCatalogueTellsBothWithTheirReasons) {
  footfall_lcm::catalogue_t catalogue;
  engine::fill_names(*behavior, engine::LiveNames(*behavior), catalogue);
  const auto fixed = [&](const std::string& name) {
    return std::ranges::count(catalogue.fixed, name);
  };
  for (const char* name : {"estimator.start_attitude", "estimator.start_velocity", "estimator.type",
                           "estimator.contact"}) {
    EXPECT_EQ(fixed(name), 1) << name;
  }
  EXPECT_EQ(fixed("estimator.foot_noise"), 0);
  EXPECT_EQ(catalogue.fixed.size(), catalogue.fixed_reasons.size());
  EXPECT_EQ(catalogue.fixed_count, static_cast<int>(catalogue.fixed.size()));
}

}  // namespace
}  // namespace footfall::tests
