// Each key of robot files is one that the loader reads.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "model/robot/description.h"
#include "model/robot/keys.h"
#include "tests/language/keys/key_uses.h"

namespace footfall::tests {
namespace {

const std::string kRobotPath = std::string(FOOTFALL_SOURCE_DIR) + "/tests/language/keys/robot.yaml";

TEST(EveryKey, OfARobotIsInAFileThatLoads) {
  core::Diagnostics diagnostics;
  model::load_robot(kRobotPath, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  const core::YamlNode root = core::load_yaml_file(kRobotPath, diagnostics);
  EXPECT_EQ(unused_keys(model::kRobotFile, key_uses(model::kRobotFile, root)),
            std::vector<std::string>{"robot.base"});
}
TEST(EveryKey, OfARobotIsReadSoThatAWrongValueIsRefused) {
  core::Diagnostics diagnostics;
  const core::YamlNode root = core::load_yaml_file(kRobotPath, diagnostics);
  std::ostringstream text;
  text << std::ifstream(kRobotPath).rdbuf();
  const std::string folder = testing::TempDir() + "/tests/language/keys";
  std::filesystem::create_directories(folder);
  std::filesystem::copy(
      std::string(FOOTFALL_SOURCE_DIR) + "/robots", testing::TempDir() + "/robots",
      std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
  for (const KeyUse& use : key_uses(model::kRobotFile, root)) {
    if (!use.value->is_scalar() || use.key == "robot.doc") continue;
    const std::string path = folder + "/broken.yaml";
    std::ofstream(path) << broken(text.str(), *use.value);
    core::Diagnostics found;
    model::load_robot(path, found);
    EXPECT_TRUE(found.has_errors()) << use.key << " is not read";
  }
}

}  // namespace
}  // namespace footfall::tests
