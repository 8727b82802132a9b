// Where values come from, and trees written as text.
#include "core/yaml/explain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/yaml_text/format.h"
#include "core/yaml_text/write.h"

namespace footfall::core {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class ExplainTest : public testing::Test {
 protected:
  ExplainTest() : folder_(fs::temp_directory_path() / ("explain" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    write("a.yaml", "world: 1\nm: {x: 1, y: {z: 5 ms}, gone: 7}\nlist: [p]\nimu.stale: 3\n");
    write("b.yaml", "base: a.yaml\nm: {x: 2, gone: off}\nlist+: [q]\n");
    write("c.yaml", "base: b.yaml\nm:\n  x: 3\n");
    root_ = load_yaml_with_base((folder_ / "c.yaml").string(), diagnostics_, &history_);
    EXPECT_FALSE(diagnostics_.has_errors()) << diagnostics_.to_string();
  }
  ~ExplainTest() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  // `a.yaml:2:8`.
  std::string place(Mark mark) const {
    return fs::path(diagnostics_.file(mark.file)).filename().string() + ":" +
           std::to_string(mark.line) + ":" + std::to_string(mark.column);
  }

  fs::path folder_;
  Diagnostics diagnostics_;
  YamlHistory history_;
  YamlNode root_;
};

TEST_F(ExplainTest, AValueNamesItsPlaceAndWhatItReplacedInEveryFile) {
  const Explanation x = explain(root_, history_, nullptr, "m.x");
  ASSERT_EQ(x.values.size(), 1U);
  EXPECT_EQ(x.values[0].value.scalar, "3");
  EXPECT_EQ(place(x.values[0].value.mark), "c.yaml:3:6");
  ASSERT_EQ(x.values[0].changes.size(), 2U);
  EXPECT_EQ(x.values[0].changes[0].old.scalar, "2");
  EXPECT_EQ(place(x.values[0].changes[0].old.mark), "b.yaml:2:8");
  EXPECT_EQ(place(x.values[0].changes[0].mark), "c.yaml:3:6");
  EXPECT_EQ(x.values[0].changes[1].old.scalar, "1");
  EXPECT_EQ(place(x.values[0].changes[1].old.mark), "a.yaml:2:8");
}

TEST_F(ExplainTest, AMapGivesEveryValueInItAndWhatWasRemoved) {
  const Explanation m = explain(root_, history_, nullptr, "m");
  ASSERT_EQ(m.values.size(), 3U);
  EXPECT_EQ(m.values[0].path, "m.x");
  EXPECT_EQ(m.values[1].path, "m.y.z");
  EXPECT_TRUE(m.values[1].changes.empty());
  EXPECT_EQ(m.values[2].path, "m.gone");
  EXPECT_FALSE(m.values[2].there);
  EXPECT_EQ(m.values[2].changes[0].old.scalar, "7");
  const Explanation gone = explain(root_, history_, nullptr, "m.gone");
  EXPECT_EQ(gone.problem, "");
  ASSERT_EQ(gone.values.size(), 1U);
  EXPECT_EQ(place(gone.values[0].changes[0].mark), "b.yaml:2:17");
}

TEST_F(ExplainTest, AnAppendedListAndAKeyWithADot) {
  const Explanation list = explain(root_, history_, nullptr, "list");
  ASSERT_EQ(list.values.size(), 1U);
  EXPECT_EQ(to_flow_yaml(list.values[0].value), "[p, q]");
  EXPECT_EQ(list.values[0].changes.at(0).kind, YamlChange::Kind::appended);
  EXPECT_EQ(to_flow_yaml(list.values[0].changes.at(0).old), "[p]");
  EXPECT_EQ(explain(root_, history_, nullptr, "imu.stale").values.at(0).value.scalar, "3");
}

TEST_F(ExplainTest, AnUnknownKeyIsGuessed) {
  EXPECT_THAT(explain(root_, history_, nullptr, "m.yy.z").problem, HasSubstr("did you mean 'y'"));
}

TEST_F(ExplainTest, ATableKnowsWhatIsNotWritten) {
  static constexpr KeySpec kInner[] = {key("z", any_quantity(), "how long").otherwise("7 ms"),
                                       key("w", boolean(), "whether")};
  static constexpr KeyTable kInnerTable{.id = "y", .doc = "", .keys = kInner};
  static constexpr KeySpec kExplainRows[] = {key("x", any_quantity(), "a number"),
                                             key("y", map_of(kInnerTable), "more")};
  static constexpr KeyTable kMap{.id = "m", .doc = "", .keys = kExplainRows};
  static constexpr KeySpec kRoot[] = {key("m", map_of(kMap), "a map")};
  static constexpr KeyTable kExplainTable{.id = "root", .doc = "", .keys = kRoot};
  const Explanation there = explain(root_, history_, &kExplainTable, "m.y.z");
  ASSERT_NE(there.key, nullptr);
  EXPECT_EQ(there.key->doc, "how long");
  const Explanation absent = explain(root_, history_, &kExplainTable, "m.y.w");
  EXPECT_TRUE(absent.values.empty());
  EXPECT_EQ(absent.problem, "");
  EXPECT_EQ(absent.key->doc, "whether");
  EXPECT_THAT(explain(root_, history_, &kExplainTable, "m.y.ww").problem, HasSubstr("'w'"));
}

TEST_F(ExplainTest, AnEditIsADifference) {
  YamlNode edited = root_;
  Diagnostics diagnostics = diagnostics_;
  edited.entries[1].value.entries[0].value = load_yaml_text("9", "--set m.x", diagnostics);
  add_differences(root_, edited, history_);
  const Explanation x = explain(edited, history_, nullptr, "m.x");
  EXPECT_EQ(x.values.at(0).value.scalar, "9");
  ASSERT_EQ(x.values[0].changes.size(), 3U);
  EXPECT_EQ(x.values[0].changes[0].old.scalar, "3");
}

TEST(YamlWrite, ReadsBackAsTheSameTree) {
  const std::string texts[] = {
      "a: 1\nb: [x, {y: 2 ms}]\nc: {}\nd: []\ne:\nf: \"true\"\ng: 'it''s'\nh: plain text\n",
      "a: \"l1\\nl2 \\\\ \\\"q\\\"\"\nb: '# no comment'\nc: \"a: b\"\nd: '- x'\n\"k: 1\": v\ne: "
      "\"\"\n",
      "long: {aaaaaaaaaaaaaaaaaaaa: bbbbbbbbbbbbbbbbbbbbbbbbbbbbb, cccccccccccccccccccccccccc: "
      "[ddddddddddd, "
      "eeeeeeeeeeeeeeeeeeee], ffffffffffffffff: {g: [[1, 2], [3]]}}\n",
  };
  for (const std::string& text : texts) {
    Diagnostics diagnostics;
    const YamlNode before = load_yaml_text(text, "t", diagnostics);
    const std::string written = to_yaml(before);
    const YamlNode after = load_yaml_text(written, "w", diagnostics);
    EXPECT_EQ(diagnostics.to_string(), "") << written;
    EXPECT_TRUE(same_values(before, after)) << written;
    EXPECT_EQ(format_yaml(written), written);
  }
}

TEST(YamlWrite, EveryShippedFileReadsBack) {
  for (const char* folder : {"behaviors/library", "examples", "robots/hume", "sim/worlds"}) {
    for (const auto& entry : fs::directory_iterator(fs::path(FOOTFALL_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".yaml") continue;
      Diagnostics diagnostics;
      const YamlNode before = load_yaml_with_base(entry.path().string(), diagnostics);
      const YamlNode after = load_yaml_text(to_yaml(before), "w", diagnostics);
      EXPECT_EQ(diagnostics.to_string(), "") << entry.path();
      EXPECT_TRUE(same_values(before, after)) << entry.path() << to_yaml(before);
    }
  }
}

}  // namespace
}  // namespace footfall::core
