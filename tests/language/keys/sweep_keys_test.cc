// Each key of sweep files is one that the loader reads.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "lab/scenario/keys.h"
#include "lab/sweep/plan/keys.h"
#include "lab/sweep/plan/loader.h"
#include "tests/language/keys/key_uses.h"

namespace footfall::tests {
namespace {

const std::string kSweepPath = std::string(FOOTFALL_SOURCE_DIR) + "/tests/language/keys/sweep.yaml";

TEST(EveryKey, OfASweepIsInAFileThatLoads) {
  core::Diagnostics diagnostics;
  lab::load_sweep(kSweepPath, {{FOOTFALL_SOURCE_DIR}}, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  const core::YamlNode root = core::load_yaml_file(kSweepPath, diagnostics);
  EXPECT_EQ(unused_keys(lab::kSweepFile, key_uses(lab::kSweepFile, root)),
            (std::vector<std::string>{"sweep.base", "sweep.scenario"}));
}

TEST(EveryKey, OfASweepIsReadSoThatAWrongValueIsRefused) {
  core::Diagnostics diagnostics;
  const core::YamlNode root = core::load_yaml_file(kSweepPath, diagnostics);
  std::ostringstream content;
  content << std::ifstream(kSweepPath).rdbuf();
  for (const KeyUse& use : key_uses(lab::kSweepFile, root)) {
    if (!use.value->is_scalar()) continue;
    core::Diagnostics found;
    const core::YamlNode wrong =
        core::load_yaml_text(broken(content.str(), *use.value), "broken.yaml", found);
    if (use.key != "sweep.sweep")
      lab::read_sweep(wrong, "broken.yaml", {{FOOTFALL_SOURCE_DIR}}, found);
    if (use.key == "sweep.sweep") core::check_kind(wrong, "sweep", 1, found);
    EXPECT_TRUE(found.has_errors()) << use.key << " is not read";
  }
}

TEST(SweepKeys, EveryTableAndEveryKeySaysWhatItIsFor) {
  for (const core::KeyTable* table : core::tables_of(lab::kSweepFile)) {
    EXPECT_FALSE(table->doc.empty()) << table->id;
    for (const core::KeySpec& key : table->keys) EXPECT_FALSE(key.doc.empty()) << key.name;
  }
}

TEST(SweepKeys, FaultsAreThoseOfScenariosAndNone) {
  std::vector<std::string> words = core::word_names(lab::kSweepFaults);
  ASSERT_EQ(words.front(), "none");
  words.erase(words.begin());
  EXPECT_EQ(words, core::word_names(lab::kInjectedFaults));
}

}  // namespace
}  // namespace footfall::tests
