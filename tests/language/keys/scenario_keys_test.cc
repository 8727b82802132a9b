// Each key of scenario files is one that the loader reads.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "lab/scenario/keys.h"
#include "lab/scenario/loader.h"
#include "tests/language/keys/key_uses.h"

namespace footfall::tests {
namespace {

const std::string kFolder = std::string(FOOTFALL_SOURCE_DIR) + "/tests/language/keys/";
const std::string kScenarioPath = kFolder + "scenario.yaml";

TEST(EveryKey, OfAScenarioIsInAFileThatLoads) {
  core::Diagnostics diagnostics;
  lab::load_scenario(kScenarioPath, {{FOOTFALL_SOURCE_DIR}}, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  const core::YamlNode root = core::load_yaml_file(kScenarioPath, diagnostics);
  EXPECT_EQ(unused_keys(lab::kScenarioFile, key_uses(lab::kScenarioFile, root)),
            std::vector<std::string>{"scenario.base"});
}
TEST(EveryKey, OfAScenarioIsReadSoThatAWrongValueIsRefused) {
  core::Diagnostics diagnostics;
  const core::YamlNode root = core::load_yaml_file(kScenarioPath, diagnostics);
  std::ostringstream text;
  text << std::ifstream(kScenarioPath).rdbuf();
  const std::string content = text.str();
  const std::string behavior = "scenario_behavior.yaml";
  for (const KeyUse& use : key_uses(lab::kScenarioFile, root)) {
    if (!use.value->is_scalar()) continue;
    std::string wrong = broken(content, *use.value);
    const std::size_t at = wrong.find(behavior);  // is beside the original
    if (at != std::string::npos)
      wrong.replace(at, behavior.size(), std::filesystem::absolute(kFolder + behavior).string());
    const std::string path = testing::TempDir() + "/broken_scenario.yaml";
    std::ofstream(path) << wrong;
    core::Diagnostics found;
    lab::load_scenario(path, {{FOOTFALL_SOURCE_DIR}}, found);
    EXPECT_TRUE(found.has_errors()) << use.key << " is not read";
  }
}
TEST(ScenarioKeys, EveryTableAndEveryKeySaysWhatItIsFor) {
  for (const core::KeyTable* table : core::tables_of(lab::kScenarioFile)) {
    EXPECT_FALSE(table->doc.empty()) << table->id;
    for (const core::KeySpec& key : table->keys) EXPECT_FALSE(key.doc.empty()) << key.name;
  }
}

}  // namespace
}  // namespace footfall::tests
