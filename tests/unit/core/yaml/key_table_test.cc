// Key tables: which keys and words they give to a loader.
#include "core/yaml/key_table.h"

#include <gtest/gtest.h>

namespace footfall::core {
namespace {

constexpr WordSpec kShapes[] = {{"hold", "stays"}, {"cosine", "goes"}};
constexpr KeySpec kLeafRows[] = {key("size", quantity(kLength), "how long")};
constexpr KeyTable kLeaf = {.id = "leaf", .doc = "A leaf.", .keys = kLeafRows};
constexpr KeySpec kRows[] = {
    key("shape", choice(kShapes), "which").required(),
    key("over", quantity(kTime), "how long").only("cosine"),
    key("leaves", by_name(map_of(kLeaf)), "some"),
};
constexpr KeyTable kTable = {
    .id = "branch", .doc = "A branch.", .keys = kRows, .more = &kLeaf, .selector = "shape"};

YamlNode parse(std::string_view text, Diagnostics& diagnostics) {
  return load_yaml_text(text, "test.yaml", diagnostics);
}

TEST(KeyTable, NamesAreThoseOfTheTableAndOfTheOneItContinues) {
  EXPECT_EQ(key_names(kTable), (std::vector<std::string>{"shape", "over", "leaves", "size"}));
}
TEST(KeyTable, AKeyOfOneVariantIsNotAKeyOfAnother) {
  EXPECT_EQ(key_names(kTable, "hold"), (std::vector<std::string>{"shape", "leaves", "size"}));
  EXPECT_TRUE(belongs_to(*find_key(kTable, "over"), "cosine"));
  EXPECT_FALSE(belongs_to(*find_key(kTable, "over"), "cos"));
}
TEST(KeyTable, AnUnknownKeyIsRefusedAtItsPlaceWithTheNearestOfTheTable) {
  Diagnostics diagnostics;
  check_keys(parse("{shape: hold, leavse: {}}", diagnostics), kTable, diagnostics);
  EXPECT_EQ(diagnostics.to_string(),
            "test.yaml:1:15: error: unknown key 'leavse' (did you mean 'leaves'?)\n");
}
TEST(KeyTable, AChoiceIsTheIndexOfItsWord) {
  Diagnostics diagnostics;
  EXPECT_EQ(read_choice(parse("cosine", diagnostics), kShapes, diagnostics), 1);
  EXPECT_FALSE(read_choice(parse("sine", diagnostics), kShapes, diagnostics).has_value());
  EXPECT_EQ(doc_of(kShapes, "cosine"), "goes");
}
TEST(KeyTable, EachTableOfAFileIsFoundOnce) {
  const FileTable file = {.kind = "tree", .newest = 1, .root = &kTable};
  EXPECT_EQ(tables_of(file), (std::vector<const KeyTable*>{&kTable, &kLeaf}));
}

}  // namespace
}  // namespace footfall::core
