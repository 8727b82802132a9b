// The YAML door: exact places, and each of YAML's traps an error instead of a surprise.
#include "core/yaml/yaml.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace footfall::core {
namespace {

// The problems of a text, all of them.
std::string problems(std::string_view text) {
  Diagnostics diagnostics;
  const YamlNode root = load_yaml_text(text, "f.yaml", diagnostics);
  EXPECT_TRUE(root.is_null() || !diagnostics.has_errors());
  return diagnostics.to_string();
}

YamlNode good(std::string_view text) {
  Diagnostics diagnostics;
  YamlNode root = load_yaml_text(text, "f.yaml", diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  return root;
}

TEST(YamlTest, KeepsOrderKindsQuotesAndPlaces) {
  const YamlNode root = good(R"(zeta: 1
alpha: {b: "5", c: [x, yes]}
empty:
)");
  ASSERT_TRUE(root.is_map());
  ASSERT_EQ(root.entries.size(), 3u);
  EXPECT_EQ(root.entries[0].key, "zeta");
  EXPECT_EQ(root.entries[1].key, "alpha");
  EXPECT_EQ(root.entries[1].key_mark.line, 2);
  EXPECT_EQ(root.entries[1].key_mark.column, 1);
  const YamlNode* b = root.find("alpha")->find("b");
  EXPECT_TRUE(b->quoted);
  EXPECT_EQ(b->mark.column, 12);
  const YamlNode* c = root.find("alpha")->find("c");
  EXPECT_EQ(c->items[1].scalar, "yes");  // text, not a boolean
  EXPECT_FALSE(c->items[1].quoted);
  EXPECT_TRUE(root.find("empty")->is_null());
  EXPECT_EQ(root.find("empty")->mark.line, 3);
  EXPECT_EQ(root.find("nowhere"), nullptr);
}

TEST(YamlTest, DuplicateKeysAreErrorsAtTheSecond) {
  EXPECT_EQ(problems("a: 1\nb: {c: 1, c: 2}\na: 3\n"),
            "f.yaml:2:11: error: duplicate key 'c', first on line 2\n"
            "f.yaml:3:1: error: duplicate key 'a', first on line 1\n");
}

TEST(YamlTest, TabsInIndentationAreErrorsWhereTheyStand) {
  EXPECT_EQ(problems("a:\n\tb: 1\n  \tc: 1\n-\td\n"),
            "f.yaml:2:1: error: a tab in the indentation: use blanks\n"
            "f.yaml:3:3: error: a tab in the indentation: use blanks\n"
            "f.yaml:4:2: error: a tab in the indentation: use blanks\n");
  EXPECT_EQ(problems("a: 1\t# a comment\n\t# another\n\t\nb: 2\n"), "");
}

TEST(YamlTest, MergeKeysAreRefused) {
  EXPECT_EQ(problems("a: &x {b: 1}\nc:\n  <<: *x\n"),
            "f.yaml:3:3: error: '<<' is not supported: use a template, or 'base:' for whole "
            "files\n");
}

TEST(YamlTest, ASecondDocumentIsAnError) {
  EXPECT_EQ(problems("a: 1\n---\nb: 2\n"),
            "f.yaml:2:1: error: a second YAML document ('---'): a file holds one\n");
  EXPECT_EQ(problems("---\na: 1\n...\n"), "");
}

TEST(YamlTest, BytesThatAreNoTextAreErrors) {
  EXPECT_EQ(problems("a: 1\nb: \xff\xfe\n"), "f.yaml:2:4: error: not UTF-8 text (byte 0xff)\n");
  EXPECT_EQ(problems(std::string_view("a: x\0y\n", 7)),
            "f.yaml:1:5: error: a control character (0x00)\n");
  EXPECT_EQ(problems("a: \"x\\0\"\n"), "f.yaml:1:4: error: a control character (0x00)\n");
  EXPECT_EQ(problems("a: \xc0\xaf\n"), "f.yaml:1:4: error: not UTF-8 text (byte 0xc0)\n");
  EXPECT_EQ(problems("a: \xed\xa0\x80\n"), "f.yaml:1:4: error: not UTF-8 text (byte 0xed)\n");
  EXPECT_EQ(problems("\xef\xbb\xbf# with a mark\na: \u00b5m \U0001f9bf\n"), "");
}

TEST(YamlTest, AnAliasIsACopyAtItsOwnPlace) {
  const YamlNode root = good("a: &x {b: [1, 2]}\nc: *x\n");
  const YamlNode* c = root.find("c");
  EXPECT_EQ(c->mark.line, 2);
  EXPECT_EQ(c->find("b")->items[1].scalar, "2");
  EXPECT_EQ(c->find("b")->mark.line, 1);  // what is inside stands where it was written
}

TEST(YamlTest, ASelfReferenceIsAnErrorAndNoHang) {
  EXPECT_EQ(problems("a: &x [1, *x]\n"),
            "f.yaml:1:11: error: an alias inside the very node that it stands for\n");
  EXPECT_EQ(problems("a: &x {b: {c: *x}}\n"),
            "f.yaml:1:15: error: an alias inside the very node that it stands for\n");
}

TEST(YamlTest, AnAliasBombEndsAtTheBudget) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 20; ++i) {
    const std::string one = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int k = 0; k < 9; ++k) bomb += one + " , ";
    bomb += one + " ]\n";
  }
  EXPECT_NE(problems(bomb).find("error: more than 200000 values"), std::string::npos);
  // Few values, much text.
  std::string wide = "a: &x \"" + std::string(1 << 20, 'x') + "\"\nb: [";
  for (int i = 0; i < 500; ++i) wide += "*x , ";
  wide += "*x ]\n";
  EXPECT_NE(problems(wide).find("error: more than"), std::string::npos);
}

TEST(YamlTest, NestingIsLimitedAlsoThroughAliases) {
  const auto nested = [](int levels) {
    return "a: " + std::string(static_cast<std::size_t>(levels), '[') +
           std::string(static_cast<std::size_t>(levels), ']') + "\n";
  };
  EXPECT_EQ(problems(nested(99)), "");
  EXPECT_EQ(problems(nested(100)), "f.yaml:1:103: error: nested deeper than 100 levels\n");
  EXPECT_EQ(problems(nested(100'000)), "f.yaml:1:103: error: nested deeper than 100 levels\n");
  std::string through_aliases = "a0: &a0 [1]\n";
  for (int i = 1; i < 120; ++i) {
    const std::string n = std::to_string(i);
    through_aliases += "a" + n + ": &a" + n + " [*a" + std::to_string(i - 1) + " ]\n";
  }
  EXPECT_NE(problems(through_aliases).find("nested deeper than 100 levels"), std::string::npos);
}

TEST(YamlTest, AMissingBlankAfterTheColonIsPointedOut) {
  EXPECT_EQ(problems("a: {b:1, c: 2}\n"),
            "f.yaml:1:5: error: 'b:1' has no value: a blank belongs after the ':'\n");
}

TEST(YamlTest, KeysAreTextAndTagsAreRefused) {
  EXPECT_EQ(problems("{[1, 2]: x}\n"), "f.yaml:1:2: error: expected a key, got a list or map\n");
  EXPECT_EQ(problems(": x\n"), "f.yaml:1:1: error: expected a key, got nothing\n");
  EXPECT_EQ(problems("a: !!python/object x\n"),
            "f.yaml:1:4: error: a YAML tag '!!python/object' has no meaning here: leave it out\n");
}

TEST(YamlTest, SyntaxErrorsHaveTheirPlace) {
  EXPECT_EQ(problems("a: *nobody\n").rfind("f.yaml:1:4: error: YAML: ", 0), 0u);
  EXPECT_EQ(problems("a: [1, 2\nb: 3\n").rfind("f.yaml:", 0), 0u);
  EXPECT_EQ(problems("b: 0\na: [1, 2"),
            "f.yaml:2:4: error: YAML: a '[' that is never closed, or a ',' missing before this\n");
  EXPECT_EQ(problems("- a\nb: 1\n"),
            "f.yaml:2:1: error: expected the end of the file: is the indentation right?\n");
  EXPECT_EQ(problems(""), "f.yaml: error: the file is empty\n");
  EXPECT_EQ(problems("# nothing\n"), "f.yaml: error: the file is empty\n");
  EXPECT_EQ(problems("---\n"), "f.yaml: error: the file is empty\n");
}

TEST(YamlTest, AQuoteThatIsNeverClosedIsAnErrorWhereItOpens) {
  EXPECT_EQ(problems("a: 1\nb: \"x\n"), "f.yaml:2:4: error: a quote that is never closed\n");
  EXPECT_EQ(problems("\"a\": 'it\nb: 2\nc: 3"),
            "f.yaml:1:6: error: a quote that is never closed\n");
  EXPECT_EQ(problems("a: \"x\n\n  y\"\n"), "");
}

TEST(YamlTest, AHugeTextIsRefused) {
  EXPECT_EQ(problems("a: " + std::string((8u << 20) + 1, 'x')),
            "f.yaml: error: larger than 4 MB\n");
}

// Files in a folder of their own, removed at the end.
class YamlFileTest : public testing::Test {
 protected:
  YamlFileTest()
      : folder_(std::filesystem::path(testing::TempDir()) /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(folder_);
  }
  ~YamlFileTest() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, std::string_view text) {
    const std::string path = path_of(name);
    std::ofstream(path) << text;
    return path;
  }
  std::string path_of(const std::string& name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
  Diagnostics diagnostics_;
};

TEST_F(YamlFileTest, AFileThatCannotBeReadIsOneError) {
  const std::string path = path_of("none.yaml");
  EXPECT_TRUE(load_yaml_file(path, diagnostics_).is_null());
  EXPECT_EQ(diagnostics_.to_string(), path + ": error: cannot read: No such file or directory\n");
  Diagnostics folder;
  load_yaml_file(folder_.string(), folder);
  EXPECT_EQ(folder.to_string(), folder_.string() + ": error: cannot read: Is a directory\n");
}

TEST_F(YamlFileTest, AFileStandsOnItsBase) {
  write("base.yaml", R"(robot: 1
name: first
joints: {a: {torque: 1, position: 2}, b: 3, c: 4}
list: [x, y]
replaced: [1, 2, 3]
)");
  const std::string path = write("own.yaml", R"(robot: 1
base: base.yaml
added: 9
joints: {d: 5, a: {torque: 7}, b: off, swing: off}
list+: [z]
replaced: [4]
)");
  const YamlNode root = load_yaml_with_base(path, diagnostics_);
  ASSERT_EQ(diagnostics_.to_string(), "");
  std::string keys;
  for (const YamlEntry& entry : root.entries) keys += entry.key + " ";
  EXPECT_EQ(keys, "robot name joints list replaced added ");
  const YamlNode* joints = root.find("joints");
  std::string names;
  for (const YamlEntry& entry : joints->entries) names += entry.key + " ";
  // `off` of what the base does not have is the language's own `off`, for the loader behind.
  EXPECT_EQ(names, "a c d swing ");
  EXPECT_EQ(joints->find("a")->find("torque")->scalar, "7");
  EXPECT_EQ(diagnostics_.file(joints->find("a")->find("torque")->mark.file), path);
  EXPECT_EQ(diagnostics_.file(joints->find("c")->mark.file), path_of("base.yaml"));
  EXPECT_EQ(root.find("list")->items.size(), 3u);
  EXPECT_EQ(root.find("replaced")->items.size(), 1u);
}

TEST_F(YamlFileTest, BasesStackUp) {
  write("a.yaml", "world: 1\nx: 1\ny: 1\nz: 1\n");
  write("b.yaml", "world: 1\nbase: a.yaml\ny: 2\nz: 2\n");
  const std::string path = write("c.yaml", "base: b.yaml\nz: 3\n");
  const YamlNode root = load_yaml_with_base(path, diagnostics_);
  ASSERT_EQ(diagnostics_.to_string(), "");
  EXPECT_EQ(root.entries.front().key, "world");
  EXPECT_EQ(root.find("x")->scalar + root.find("y")->scalar + root.find("z")->scalar, "123");
}

TEST_F(YamlFileTest, ABaseIsFoundByNameInALibraryAndBesideFirst) {
  std::filesystem::create_directories(folder_ / "sim/worlds");
  write("sim/worlds/walk.yaml", "behavior: 1\nx: library\n");
  const std::vector<std::string> library = {path_of("empty/sim/worlds"), path_of("sim/worlds")};
  const std::string path = write("mine.yaml", "base: walk\n");
  EXPECT_EQ(load_yaml_with_base(path, diagnostics_, nullptr, library).find("x")->scalar, "library");
  write("walk", "behavior: 1\nx: beside\n");
  EXPECT_EQ(load_yaml_with_base(path, diagnostics_, nullptr, library).find("x")->scalar, "beside");
  EXPECT_EQ(diagnostics_.to_string(), "");

  const std::string wrong = write("wrong.yaml", "base: wlak\n");
  load_yaml_with_base(wrong, diagnostics_, nullptr, library);
  EXPECT_EQ(diagnostics_.to_string(), wrong + ":1:7: error: no file '" + path_of("wlak") +
                                          "', and no 'wlak.yaml' in a sim/worlds here, above, "
                                          "or in the search path (did you mean 'walk'?)\n");
}

TEST_F(YamlFileTest, CyclesAndMissingBasesAreErrors) {
  write("a.yaml", "world: 1\nbase: b.yaml\n");
  const std::string b = write("b.yaml", "world: 1\nbase: a.yaml\n");
  EXPECT_TRUE(load_yaml_with_base(b, diagnostics_).is_null());
  EXPECT_EQ(diagnostics_.to_string(),
            path_of("a.yaml") + ":2:7: error: '" + b + "' is its own base in the end\n");

  Diagnostics missing;
  const std::string c = write("c.yaml", "world: 1\nbase: none.yaml\n");
  load_yaml_with_base(c, missing);
  EXPECT_EQ(missing.to_string(), c + ":2:7: error: no file '" + path_of("none.yaml") + "'\n");
}

TEST_F(YamlFileTest, ABaseOfAnotherKindAndABadAppendAreErrors) {
  const std::string base = write("robot.yaml", "robot: 1\nlist: [x]\n");
  const std::string path = write("world.yaml", "world: 1\nbase: robot.yaml\n");
  load_yaml_with_base(path, diagnostics_);
  EXPECT_EQ(diagnostics_.to_string(),
            path + ":2:7: error: '" + base + "' is a file of another kind than 'world'\n");

  Diagnostics append;
  const std::string own = write("own.yaml", "robot: 1\nbase: robot.yaml\nlits+: [y]\nlist+: y\n");
  load_yaml_with_base(own, append);
  EXPECT_EQ(append.to_string(), own + ":3:1: error: the base has no list 'lits'\n" + own +
                                    ":4:8: error: expected a list to append to 'list'\n");
}

}  // namespace
}  // namespace footfall::core
