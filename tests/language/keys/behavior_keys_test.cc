// Each key of the language is one that the loader reads: a file that uses all of them loads, and
// with any of its values broken it does not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "behaviors/language/estimators.h"
#include "behaviors/language/language.h"
#include "behaviors/loader.h"
#include "tests/language/keys/key_uses.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

using behaviors::kBehaviorFile;

std::string read(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(std::string(FOOTFALL_SOURCE_DIR) + path).rdbuf();
  return text.str();
}

const std::string kEveryKey = read("/tests/language/keys/behavior.yaml");

// What loading the text reports, as if it stood in the file's folder (there is a script beside it).
std::string said_of(const std::string& text) {
  core::Diagnostics diagnostics;
  behaviors::load_behavior_text(text,
                                std::string(FOOTFALL_SOURCE_DIR) + "/tests/language/keys/b.yaml",
                                options_for_tests(), diagnostics);
  return diagnostics.to_string();
}

TEST(EveryKey, OfTheLanguageIsInAFileThatLoads) {
  EXPECT_EQ(said_of(kEveryKey).find("error:"), std::string::npos) << said_of(kEveryKey);
  core::Diagnostics diagnostics;
  const core::YamlNode root = core::load_yaml_text(kEveryKey, "b.yaml", diagnostics);
  // A base is another file (tests/unit/core/yaml).
  auto unused = unused_keys(kBehaviorFile, key_uses(kBehaviorFile, root));
  std::erase_if(unused, [](const std::string& key) { return key.starts_with("estimator."); });
  EXPECT_EQ(unused, std::vector<std::string>{"behavior.base"});
}
TEST(EveryKey, OfTheLanguageIsReadSoThatAWrongValueIsRefused) {
  core::Diagnostics diagnostics;
  const core::YamlNode root = core::load_yaml_text(kEveryKey, "b.yaml", diagnostics);
  int count = 0;
  for (const KeyUse& use : key_uses(kBehaviorFile, root)) {
    if (!use.value->is_scalar() || may_be_anything(use)) continue;
    const std::string said = said_of(broken(kEveryKey, *use.value));
    EXPECT_NE(said.find("error:"), std::string::npos)
        << use.key << " at line " << use.value->mark.line << " is not read";
    ++count;
  }
  EXPECT_GT(count, 90);
}

// Keys of one type exclude those of another.
TEST(EveryKey, OfEachEstimatorIsReadSoThatAWrongValueIsRefused) {
  for (const behaviors::EstimatorInfo& type : behaviors::estimator_types()) {
    std::string text = fmt::format("behavior: 1\nrobot: hume\nestimator: {{type: {}", type.name);
    if (type.needs_contacts) text += ", contact: both";
    for (const auto& parameter : type.parameters) {
      text += fmt::format(", {}: {}", parameter.name, parameter.value);
    }
    text += "}\nmachine: {}\n";
    EXPECT_EQ(said_of(text).find("error:"), std::string::npos) << said_of(text);
    core::Diagnostics diagnostics;
    const core::YamlNode root = core::load_yaml_text(text, "b.yaml", diagnostics);
    for (const core::YamlEntry& entry : root.find("estimator")->entries) {
      EXPECT_NE(said_of(broken(text, entry.value)).find("error:"), std::string::npos)
          << type.name << ", " << entry.key;
    }
  }
}

}  // namespace
}  // namespace footfall::tests
