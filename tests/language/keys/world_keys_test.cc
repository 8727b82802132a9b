// Each key of world files is one that the loader reads.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "sim/world/description.h"
#include "sim/world/keys.h"
#include "tests/language/keys/key_uses.h"

namespace footfall::tests {
namespace {

const std::string kWorldPath = std::string(FOOTFALL_SOURCE_DIR) + "/tests/language/keys/world.yaml";

TEST(EveryKey, OfAWorldIsInAFileThatLoads) {
  core::Diagnostics diagnostics;
  sim::load_world(kWorldPath, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  const core::YamlNode root = core::load_yaml_file(kWorldPath, diagnostics);
  EXPECT_EQ(unused_keys(sim::kWorldFile, key_uses(sim::kWorldFile, root)),
            std::vector<std::string>{"world.base"});
}
TEST(EveryKey, OfAWorldIsReadSoThatAWrongValueIsRefused) {
  core::Diagnostics diagnostics;
  const core::YamlNode root = core::load_yaml_file(kWorldPath, diagnostics);
  std::ostringstream text;
  text << std::ifstream(kWorldPath).rdbuf();
  for (const KeyUse& use : key_uses(sim::kWorldFile, root)) {
    if (!use.value->is_scalar()) continue;
    const std::string path = testing::TempDir() + "/broken_world.yaml";
    std::ofstream(path) << broken(text.str(), *use.value);
    core::Diagnostics found;
    sim::load_world(path, found);
    EXPECT_TRUE(found.has_errors()) << use.key << " is not read";
  }
}
TEST(WorldKeys, EveryTableAndEveryKeySaysWhatItIsFor) {
  for (const core::KeyTable* table : core::tables_of(sim::kWorldFile)) {
    EXPECT_FALSE(table->doc.empty()) << table->id;
    for (const core::KeySpec& key : table->keys) EXPECT_FALSE(key.doc.empty()) << key.name;
  }
}

}  // namespace
}  // namespace footfall::tests
