// The language as data: complete, and the same as what the loader does.
#include "behaviors/language/language.h"

#include <gtest/gtest.h>

#include <set>

#include "behaviors/compiled/signals.h"
#include "model/robot/keys.h"
#include "tasks/task_types.h"

namespace footfall::behaviors {
namespace {

TEST(Language, EveryTableAndEveryKeySaysWhatItIsFor) {
  for (const core::FileTable& file : {kBehaviorFile, model::kRobotFile}) {
    std::set<std::string_view> ids;
    for (const core::KeyTable* table : core::tables_of(file)) {
      EXPECT_TRUE(ids.insert(table->id).second) << table->id << " twice";
      EXPECT_FALSE(table->doc.empty()) << table->id;
      for (const core::KeySpec& key : table->keys) {
        EXPECT_FALSE(key.doc.empty()) << table->id << "." << key.name;
        EXPECT_NE(key.values[0].kind, core::ValueKind::none) << table->id << "." << key.name;
        for (const core::ValueSpec& value : key.values) {
          for (const core::WordSpec& word : value.words) {
            EXPECT_FALSE(word.doc.empty()) << key.name << ": " << word.word;
          }
        }
      }
    }
  }
}
TEST(Language, NoMapHasAKeyTwice) {
  for (const core::KeyTable* table : core::tables_of(kBehaviorFile)) {
    std::set<std::string> names;
    for (const std::string& name : core::key_names(*table)) {
      EXPECT_TRUE(names.insert(name).second) << table->id << "." << name;
    }
  }
}
TEST(Language, AKeyOfSomeVariantsNamesOnlyWordsOfTheSelector) {
  for (const core::KeyTable* table : core::tables_of(kBehaviorFile)) {
    for (const core::KeySpec& key : table->keys) {
      if (key.variants.empty()) continue;
      std::size_t count = 1, known = 0;
      for (const char c : key.variants) count += c == ' ' ? 1 : 0;
      for (const core::WordSpec& word : table->variants) {
        known += core::belongs_to(key, word.word) ? 1 : 0;
      }
      EXPECT_EQ(known, count) << table->id << "." << key.name << ": " << key.variants;
    }
  }
}
TEST(Language, ATaskHasTheKeysThatItsTypeUses) {
  const auto has = [](const char* key, std::string_view type) {
    return core::belongs_to(*core::find_key(kTaskKeys, key), type);
  };
  for (const char* key : {"axes", "point", "frame", "reference"}) {
    EXPECT_EQ(has(key, "point_position"), true) << key;
    EXPECT_EQ(has(key, "joint_damping"), false) << key;
  }
  EXPECT_TRUE(has("joints", "joint_damping"));
  EXPECT_TRUE(has("joints", "joint_posture"));
  EXPECT_TRUE(has("reference", "joint_posture"));
  EXPECT_FALSE(has("joints", "frame_pose"));
  EXPECT_FALSE(has("point", "com_position"));
  EXPECT_TRUE(has("frame", "centroidal_angular_momentum"));
  EXPECT_TRUE(has("weight", "joint_damping"));
}
// A lone signal is told from a word by its dot; editors know those without one by name
// (apps/reference/scalar_patterns.cc).
TEST(Language, SignalsHaveADotInTheirNameButForAFew) {
  core::SignalTable table;
  register_signals({}, {{"height", {"z"}, {core::kLength}, false}}, {"tension"}, {"foot"}, table);
  const std::set<std::string> known = {"time", "steps", "state", "faults"};
  for (const core::SignalInfo& info : table.infos()) {
    const bool dotted = info.name.find('.') != std::string::npos;
    EXPECT_TRUE(dotted || known.contains(info.name)) << info.name;
  }
}

}  // namespace
}  // namespace footfall::behaviors
