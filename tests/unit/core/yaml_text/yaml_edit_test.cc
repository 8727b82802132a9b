#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "core/units/quantity_text.h"
#include "core/units/units.h"
#include "core/yaml_text/edit.h"

namespace footfall::core {
namespace {

// The scalar at the end of a path of keys and indices, as its text writes it; "none".
std::string written(const std::string& text, const std::vector<std::string>& path) {
  Diagnostics diagnostics;
  const YamlNode root = load_yaml_text(text, "t.yaml", diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.to_string();
  const YamlNode* node = &root;
  for (const std::string& key : path) {
    node = node->is_sequence() ? &node->items.at(std::stoul(key)) : node->find(key);
    if (node == nullptr) return "no such key";
  }
  const auto found = find_scalar(text, node->mark);
  return found ? text.substr(found->begin, found->end - found->begin) : "none";
}

TEST(FindScalar, IsTheTextAsWrittenWithItsQuotes) {
  EXPECT_EQ(written("a: 145 ms\nb: 2\n", {"a"}), "145 ms");
  EXPECT_EQ(written("a:   145 ms   # a comment\n", {"a"}), "145 ms");
  EXPECT_EQ(written("a: \"145 ms\"\n", {"a"}), "\"145 ms\"");
  EXPECT_EQ(written("a: {b: '1 m', c: [1, 2.5 s ]}", {"a", "b"}), "'1 m'");
  EXPECT_EQ(written("a: {b: '1 m', c: [1, 2.5 s ]}", {"a", "c", "1"}), "2.5 s");
  EXPECT_EQ(written("a:\n- 1\n- 2  # two\n", {"a", "1"}), "2");
  EXPECT_EQ(written("a:\n    7\nb: 8", {"a"}), "7");
}

TEST(FindScalar, CountsAsTheReaderDoesBehindWideCharactersLineEndsAndByteOrderMarks) {
  EXPECT_EQ(written("µ: {ä: 3 µm}\r\nb: 4 m\r\n", {"µ", "ä"}), "3 µm");
  EXPECT_EQ(written("µ: {ä: 3 µm}\r\nb: 4 m\r\n", {"b"}), "4 m");
  EXPECT_EQ(written("\xEF\xBB\xBF{a: 5, b: 6}", {"b"}), "6");
  EXPECT_EQ(written("\xEF\xBB\xBF"
                    "a: 5\nb: 6",
                    {"a"}),
            "5");
}

TEST(FindScalar, OfAnAliasIsWhatItsAnchorNames) {
  EXPECT_EQ(written("a: &x 16 ms\nb: *x\n", {"b"}), "16 ms");
  EXPECT_EQ(written("a: &x 16 ms\nb: *x\n", {"a"}), "16 ms");
  EXPECT_EQ(written("a: &x 1\nb: &x 2\nc: *x\n", {"c"}), "2");
}

TEST(FindScalar, IsNothingForAListAMapOrATextOverSeveralLines) {
  EXPECT_EQ(written("a: [1]\n", {"a"}), "none");
  EXPECT_EQ(written("a: 16\n  ms\nb: 1\n", {"a"}), "none");
  EXPECT_EQ(written("a: \"16\n  ms\"\n", {"a"}), "none");
  EXPECT_EQ(written("a: |\n  16 ms\n", {"a"}), "none");
  EXPECT_FALSE(find_scalar("a: 1\n", {0, 7, 1}));
  EXPECT_FALSE(find_scalar("a: 1\n", {0, 1, 2}));
  EXPECT_FALSE(find_scalar("a: 1\n", {}));
}

// The text with a value put under a path; "none" where that is refused.
std::string with(const std::string& text, const std::vector<std::string>& path,
                 const std::string& value) {
  Diagnostics diagnostics;
  const YamlNode root = load_yaml_text(text, "t.yaml", diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.to_string();
  const auto edit = add_value(text, root, path, value);
  return edit ? apply_edits(text, {*edit}).value_or("overlap") : "none";
}

TEST(AddValue, GoesBehindTheLastEntryOfTheInnermostMapThatIsThere) {
  EXPECT_EQ(with("a: 1\n", {"b"}, "2"), "a: 1\nb: 2\n");
  EXPECT_EQ(with("a: 1\n", {"b", "c"}, "2"), "a: 1\nb: {c: 2}\n");
  EXPECT_EQ(with("a: 1\n", {"b", "c", "d"}, "2"), "a: 1\nb:\n  c: {d: 2}\n");
  EXPECT_EQ(with("a: {x: 1}\nb: 3\n", {"a", "y"}, "2"), "a: {x: 1, y: 2}\nb: 3\n");
  EXPECT_EQ(with("a: {x: 1}\nb: 3\n", {"a", "y", "z"}, "2"), "a: {x: 1, y: {z: 2}}\nb: 3\n");
  EXPECT_EQ(with("a:\n    x: 1\nb: 3\n", {"a", "y"}, "2"), "a:\n    x: 1\n    y: 2\nb: 3\n");
  EXPECT_EQ(with("a: {}\n", {"a", "y"}, "2"), "a: {y: 2}\n");
  EXPECT_EQ(with("{a: 1}", {"b"}, "2"), "{a: 1, b: 2}");
  EXPECT_EQ(with("a: {x: 1,}\n", {"a", "y"}, "2"), "a: {x: 1, y: 2}\n");
}

TEST(AddValue, LeavesCommentsEmptyLinesAndNestedBlocksWhereTheyAre) {
  EXPECT_EQ(with("a:\n  x: 1  # one\n\n# of b\nb: 3\n", {"a", "y"}, "2"),
            "a:\n  x: 1  # one\n  y: 2\n\n# of b\nb: 3\n");
  EXPECT_EQ(with("a:\n  x:\n    - 1\n    - {u: [1,\n        2]}  # two\nb: 3\n", {"a", "y"}, "2"),
            "a:\n  x:\n    - 1\n    - {u: [1,\n        2]}  # two\n  y: 2\nb: 3\n");
  EXPECT_EQ(with("a:\n  x:\n  - 1\nb: 3\n", {"a", "y"}, "2"), "a:\n  x:\n  - 1\n  y: 2\nb: 3\n");
  EXPECT_EQ(with("a: {x: 1,  # one\n    y: 2  # two\n    }\n", {"a", "z"}, "3"),
            "a: {x: 1,  # one\n    y: 2, z: 3  # two\n    }\n");
}

TEST(AddValue, KeepsTheLineEndsAndAMissingLastOne) {
  EXPECT_EQ(with("a: 1", {"b"}, "2"), "a: 1\nb: 2");
  EXPECT_EQ(with("a:\r\n  x: 1\r\nb: 3\r\n", {"a", "y"}, "2"),
            "a:\r\n  x: 1\r\n  y: 2\r\nb: 3\r\n");
  EXPECT_EQ(with("a: 1  # last", {"b"}, "2"), "a: 1  # last\nb: 2");
}

TEST(AddValue, IsRefusedWhereTheKeyIsThereOrNoMapIs) {
  EXPECT_EQ(with("a: 1\n", {"a"}, "2"), "none");
  EXPECT_EQ(with("a: 1\n", {"a", "b"}, "2"), "none");
  EXPECT_EQ(with("a: &x {u: 1}\nb: *x\n", {"b", "v"}, "2"), "none");
  EXPECT_EQ(with("a:\n", {"a", "b"}, "2"), "none");
}

TEST(ApplyEdits, MakesAllOfThemOrNone) {
  EXPECT_EQ(apply_edits("abcdef", {{4, 5, "X"}, {0, 1, ""}, {2, 2, "--"}}), "b--cdXf");
  EXPECT_EQ(apply_edits("abc", {{1, 2, "X"}, {1, 2, "X"}}), "aXc");
  EXPECT_EQ(apply_edits("abc", {{0, 2, "X"}, {1, 3, "Y"}}), std::nullopt);
  EXPECT_EQ(apply_edits("abc", {{1, 2, "X"}, {1, 2, "Y"}}), std::nullopt);
  EXPECT_EQ(apply_edits("abc", {{2, 4, "X"}}), std::nullopt);
}

TEST(QuantityText, KeepsTheUnitAndItsBlanks) {
  EXPECT_EQ(quantity_text(0.16, "145 ms"), "160 ms");
  EXPECT_EQ(quantity_text(0.16, "145ms"), "160ms");
  EXPECT_EQ(quantity_text(0.1505, "145 ms"), "150.5 ms");
  EXPECT_EQ(quantity_text(-0.25, "-0.2 m/s"), "-0.25 m/s");
  EXPECT_EQ(quantity_text(0.07, "+6 cm"), "7 cm");
  EXPECT_EQ(quantity_text(0.3, "20 %"), "30 %");
  EXPECT_EQ(quantity_text(280.0, "270"), "280");
  EXPECT_EQ(quantity_text(0.5, "0"), "0.5");
  EXPECT_EQ(quantity_text(220.0, "200 1/s^2"), "220 1/s^2");
  EXPECT_EQ(quantity_text(3e-6, "2 \u00b5m"), "3 \u00b5m");
  EXPECT_EQ(quantity_text(120.0, "1 min"), "2 min");
}

// 0.1617 and 161.7/1000 are neighbours, so the digits are many; `16 cm` in metres is 0.16 exactly.
TEST(QuantityText, IsTheShortestThatReadsBackInThatUnit) {
  EXPECT_EQ(quantity_text(161.7 / 1000, "145 ms"), "161.7 ms");
  ASSERT_NE(161.7 / 1000, 0.1617);
  EXPECT_EQ(quantity_text(0.1617, "145 ms"), "161.70000000000002 ms");
  EXPECT_EQ(quantity_text(0.1, "1"), "0.1");
}

// 5 deg is 5*pi/180 as the reader computes it. One unit in the last place above it is no multiple:
// then in rad. 1/s has no shorter name.
TEST(QuantityText, FallsBackToSiWhereTheUnitCannotSayIt) {
  EXPECT_EQ(quantity_text(6 * std::numbers::pi / 180, "5 deg"), "6 deg");
  int fallbacks = 0;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.01, 1.0);
  for (int k = 0; k < 200; ++k) {
    const double value = uniform(random);
    const std::string text = quantity_text(value, "5 deg");
    EXPECT_EQ(std::bit_cast<std::uint64_t>(parse_quantity(text)->value),
              std::bit_cast<std::uint64_t>(value));
    if (text.ends_with(" rad")) ++fallbacks;
    EXPECT_TRUE(text.ends_with(" rad") || text.ends_with(" deg")) << text;
  }
  EXPECT_GT(fallbacks, 0);
  EXPECT_LT(fallbacks, 200);
}

TEST(QuantityText, ReadsBackToTheSameBitsInEveryUnit) {
  std::mt19937_64 random(2);
  for (const char* like : {"1 ms", "2us", "1 min", "1 cm", "3 km", "1 kN", "1 mrad", "5 deg", "7 %",
                           "1 kHz", "1 Nm/rad", "2 kg m^2", "1 deg/s", "3 1/s^2", "4", "-1 h"}) {
    const auto old = parse_quantity(like);
    for (int k = 0; k < 200; ++k) {
      double value = std::bit_cast<double>(random());
      if (k % 2 == 0) value = std::ldexp(static_cast<double>(random() % 100000), -10);
      if (!std::isfinite(value)) continue;
      const std::string text = quantity_text(value, like);
      const auto read = parse_quantity(text);
      ASSERT_TRUE(read) << text;
      EXPECT_EQ(std::bit_cast<std::uint64_t>(read->value), std::bit_cast<std::uint64_t>(value))
          << text << " like " << like;
      EXPECT_TRUE(read->bare || read->dimension == old->dimension) << text << " like " << like;
    }
  }
  for (const double value : {0.0, -0.0, 5e-324, 1.7976931348623157e308}) {
    for (const char* like : {"1", "1 ms", "1 km"}) {
      const auto read = parse_quantity(quantity_text(value, like));
      ASSERT_TRUE(read);
      EXPECT_EQ(std::bit_cast<std::uint64_t>(read->value), std::bit_cast<std::uint64_t>(value));
    }
  }
}

}  // namespace
}  // namespace footfall::core
