// Typed values out of YAML: right ones are read, wrong ones are errors at their place that say
// what was expected.
#include "core/yaml/value_reader.h"

#include <gtest/gtest.h>

namespace footfall::core {
namespace {

// One YAML text and the problems that reading from it gave.
class Document {
 public:
  explicit Document(std::string_view text) : root_(load_yaml_text(text, "f.yaml", diagnostics_)) {
    EXPECT_EQ(diagnostics_.to_string(), "");
  }
  const YamlNode& at(std::string_view key) const { return *root_.find(key); }
  const YamlNode& root() const { return root_; }
  Diagnostics& diagnostics() { return diagnostics_; }
  std::string problems() const { return diagnostics_.to_string(); }

 private:
  Diagnostics diagnostics_;
  YamlNode root_;
};

TEST(ValueReaderTest, AQuantityHasTheDimensionThatItsKeyKnows) {
  Document document("time: 16 ms\nbare: 0.5\nwrong: 100 N\nbad: 16 mss\nlist: [1]\nnone:\n");
  Diagnostics& d = document.diagnostics();
  EXPECT_EQ(read_quantity(document.at("time"), kTime, d), 0.016);
  EXPECT_EQ(read_quantity(document.at("bare"), kTime, d), 0.5);
  EXPECT_EQ(document.problems(), "");
  EXPECT_FALSE(read_quantity(document.at("wrong"), kTime, d).has_value());
  EXPECT_FALSE(read_quantity(document.at("wrong"), kNone, d, "an angle").has_value());
  EXPECT_FALSE(read_quantity(document.at("bad"), kTime, d).has_value());
  EXPECT_FALSE(read_quantity(document.at("list"), kTime, d).has_value());
  EXPECT_FALSE(read_quantity(document.at("none"), kTime, d).has_value());
  EXPECT_EQ(document.problems(),
            "f.yaml:3:8: error: expected a time, got '100 N'\n"
            "f.yaml:3:8: error: expected an angle, got '100 N'\n"
            "f.yaml:4:6: error: expected a time, got '16 mss' (did you mean '16 ms'?)\n"
            "f.yaml:5:7: error: expected a time, got a list\n"
            "f.yaml:6:1: error: expected a time, got nothing\n");
}

TEST(ValueReaderTest, AKeyThatIsNotThereLeavesTheDefault) {
  Document document("a: 2 s\nb: 2 m\n");
  double value = 7.0;
  EXPECT_FALSE(read_quantity(document.root(), "c", kTime, value, document.diagnostics()));
  EXPECT_FALSE(read_quantity(document.root(), "b", kTime, value, document.diagnostics()));
  EXPECT_EQ(value, 7.0);
  EXPECT_TRUE(read_quantity(document.root(), "a", kTime, value, document.diagnostics()));
  EXPECT_EQ(value, 2.0);
}

TEST(ValueReaderTest, BoundsAreToldWithTheirUnit) {
  Document document("a: 5 s\n");
  Diagnostics& d = document.diagnostics();
  EXPECT_EQ(read_bounded(document.at("a"), kTime, 0.0, 5.0, d), 5.0);
  EXPECT_FALSE(read_bounded(document.at("a"), kTime, 0.0, 1.0, d).has_value());
  EXPECT_EQ(document.problems(), "f.yaml:1:4: error: expected a time, 0 to 1 s, got '5 s'\n");
}

TEST(ValueReaderTest, UnknownKeysAreAllReportedWithTheNearest) {
  Document document("priorty: 1\naxes: [x]\nfoo: 2\n");
  check_keys(document.root(), {"priority", "axes", "point"}, document.diagnostics());
  EXPECT_EQ(document.problems(),
            "f.yaml:1:1: error: unknown key 'priorty' (did you mean 'priority'?)\n"
            "f.yaml:3:1: error: unknown key 'foo', expected priority, axes or point\n");
}

TEST(ValueReaderTest, AMissingKeyIsReportedAtTheMap) {
  Document document("a: {b: 1}\n");
  EXPECT_NE(require_key(document.at("a"), "b", document.diagnostics()), nullptr);
  EXPECT_EQ(require_key(document.at("a"), "c", document.diagnostics()), nullptr);
  EXPECT_EQ(document.problems(), "f.yaml:1:4: error: the key 'c' is missing\n");
}

std::string kind_problem(std::string_view text) {
  Document document(text);
  EXPECT_FALSE(check_kind(document.root(), "robot", 1, document.diagnostics()));
  return document.problems();
}

TEST(ValueReaderTest, AnotherKindOrANewerVersionIsOneLine) {
  Document right("robot: 1\n");
  EXPECT_TRUE(check_kind(right.root(), "robot", 1, right.diagnostics()));
  EXPECT_EQ(kind_problem("world: 1\nfoo: 2\n"),
            "f.yaml:1:1: error: not a robot file: expected 'robot: 1' as the first key, got "
            "'world'\n");
  EXPECT_EQ(kind_problem("name: x\nrobot: 1\n"),
            "f.yaml:1:1: error: not a robot file: expected 'robot: 1' as the first key, got "
            "'name'\n");
  EXPECT_EQ(kind_problem("just text\n"),
            "f.yaml:1:1: error: not a robot file: expected 'robot: 1' as the first key, got "
            "'just text'\n");
  EXPECT_EQ(kind_problem("robot: 2\n"),
            "f.yaml:1:8: error: this program reads 'robot: 1', not version '2'\n");
  EXPECT_EQ(kind_problem("robot: hume\n"),
            "f.yaml:1:8: error: this program reads 'robot: 1', not version 'hume'\n");
}

TEST(ValueReaderTest, OnlyTrueAndFalseAreBooleans) {
  Document document("a: true\nb: false\nc: yes\nd: \"true\"\ne: True\n");
  Diagnostics& d = document.diagnostics();
  EXPECT_EQ(read_bool(document.at("a"), d), true);
  EXPECT_EQ(read_bool(document.at("b"), d), false);
  for (const char* key : {"c", "d", "e"}) EXPECT_FALSE(read_bool(document.at(key), d).has_value());
  EXPECT_EQ(document.problems(),
            "f.yaml:3:4: error: expected true or false, got 'yes'\n"
            "f.yaml:4:4: error: expected true or false, got 'true'\n"
            "f.yaml:5:4: error: expected true or false, got 'True'\n");
}

TEST(ValueReaderTest, NamesAreIdentifiersAndNotYamlsOldBooleans) {
  for (const char* text : {"on", "off", "yes", "no", "true", "false", "", "2nd", "a b", "a.b"}) {
    EXPECT_FALSE(is_name(text)) << text;
  }
  for (const char* text : {"right_foot", "_x", "On", "a2"}) EXPECT_TRUE(is_name(text)) << text;
  Document document("a: off\nb: right foot\nno: 1\n");
  EXPECT_FALSE(read_name(document.at("a"), document.diagnostics()).has_value());
  EXPECT_FALSE(read_name(document.at("b"), document.diagnostics()).has_value());
  EXPECT_FALSE(check_name(document.root().entries[2], document.diagnostics(), "a state's name"));
  EXPECT_EQ(document.problems(),
            "f.yaml:1:4: error: expected a name ('off' cannot be a name), got 'off'\n"
            "f.yaml:2:4: error: expected a name (letters, digits and '_', no digit first), got "
            "'right foot'\n"
            "f.yaml:3:1: error: expected a state's name ('no' cannot be a name), got 'no'\n");
}

TEST(ValueReaderTest, AChoiceNamesTheAlternatives) {
  Document document("a: surface\nb: piont\n");
  Diagnostics& d = document.diagnostics();
  const std::vector<std::string> types = {"point", "surface", "fixed"};
  EXPECT_EQ(read_choice(document.at("a"), types, d), 1);
  EXPECT_FALSE(read_choice(document.at("b"), types, d, "a contact type").has_value());
  EXPECT_EQ(document.problems(),
            "f.yaml:2:4: error: expected a contact type: point, surface or fixed, got 'piont' "
            "(did you mean 'point'?)\n");
}

TEST(ValueReaderTest, RangesHaveTwoValuesInOrder) {
  Document document("a: [-50 deg, 1]\nb: [2 s, 1 s]\nc: [1 s]\nd: 3 s\ne: [1 s, 2 m]\n");
  Diagnostics& d = document.diagnostics();
  const auto range = read_range(document.at("a"), kNone, d, "an angle");
  ASSERT_TRUE(range.has_value());
  EXPECT_DOUBLE_EQ((*range)[0], -0.87266462599716477);
  for (const char* key : {"b", "c", "d", "e"}) {
    EXPECT_FALSE(read_range(document.at(key), kTime, d).has_value());
  }
  EXPECT_EQ(document.problems(),
            "f.yaml:2:4: error: expected [minimum, maximum], got '2 s' before '1 s'\n"
            "f.yaml:3:4: error: expected a pair [a time, a time], got 1 values\n"
            "f.yaml:4:4: error: expected a pair [a time, a time], got '3 s'\n"
            "f.yaml:5:10: error: expected a time, got '2 m'\n");
}

TEST(ValueReaderTest, VectorsAreSequencesOrMapsByAxisOrOneNumber) {
  Document document(
      "a: [1, 2 cm, 3]\nb: {z: 1 m, x: 2 m}\nc: 5 cm\nd: [1, 2]\ne: {w: 1}\nf: [1, 2 N, 3]\n");
  Diagnostics& d = document.diagnostics();
  using Vector = std::array<double, 3>;
  EXPECT_EQ(read_vector3(document.at("a"), kLength, d), (Vector{1, 0.02, 3}));
  EXPECT_EQ(read_vector3(document.at("b"), kLength, d), (Vector{2, 0, 1}));
  EXPECT_EQ(read_vector3(document.at("c"), kLength, d), (Vector{0.05, 0.05, 0.05}));
  const auto partial = read_vector(document.at("b"), kLength, {"x", "y", "z"}, d, 9.0);
  EXPECT_EQ(partial, (std::vector<double>{2, 9, 1}));
  for (const char* key : {"d", "e", "f"}) {
    EXPECT_FALSE(read_vector3(document.at(key), kLength, d).has_value());
  }
  EXPECT_EQ(document.problems(),
            "f.yaml:4:4: error: expected 3 values (x, y, z), got 2\n"
            "f.yaml:5:5: error: unknown key 'w', expected x, y or z\n"
            "f.yaml:6:8: error: expected a length, got '2 N'\n");
}

TEST(ValueReaderTest, ARateIsExactInMillihertz) {
  Document document("a: 1500 Hz\nb: 1.5 kHz\nc: 333.333 Hz\nd: 0.0001 Hz\ne: 1.00005 Hz\nf: 5 s\n");
  Diagnostics& d = document.diagnostics();
  EXPECT_EQ(read_millihertz(document.at("a"), d), 1'500'000);
  EXPECT_EQ(read_millihertz(document.at("b"), d), 1'500'000);
  EXPECT_EQ(read_millihertz(document.at("c"), d), 333'333);
  EXPECT_EQ(document.problems(), "");
  for (const char* key : {"d", "e", "f"}) {
    EXPECT_FALSE(read_millihertz(document.at(key), d).has_value());
  }
  EXPECT_EQ(document.problems(),
            "f.yaml:4:4: error: expected a rate in Hz, 0.001 to 1e+06 1/s, got '0.0001 Hz'\n"
            "f.yaml:5:4: error: expected a rate in whole millihertz, got '1.00005 Hz'\n"
            "f.yaml:6:4: error: expected a rate in Hz, got '5 s'\n");
}

TEST(ValueReaderTest, IntegersHaveNoUnitAndNoPoint) {
  Document document("a: 3\nb: 3.0\nc: 010\nd: 9\n");
  Diagnostics& d = document.diagnostics();
  EXPECT_EQ(read_integer(document.at("a"), 1, 5, d), 3);
  EXPECT_EQ(read_integer(document.at("c"), 1, 10, d), 10);  // decimal, never octal
  EXPECT_FALSE(read_integer(document.at("b"), 1, 5, d).has_value());
  EXPECT_FALSE(read_integer(document.at("d"), 1, 5, d).has_value());
  EXPECT_EQ(document.problems(),
            "f.yaml:2:4: error: expected a whole number from 1 to 5, got '3.0'\n"
            "f.yaml:4:4: error: expected a whole number from 1 to 5, got '9'\n");
}

TEST(ValueReaderTest, ReferencesExpressionsAndOffAreTold) {
  Document document("a: $goal.x\nb: \"= 2*$x\"\nc: off\nd: \"off\"\ne: $a + 1\n");
  EXPECT_TRUE(is_reference(document.at("a")));
  EXPECT_FALSE(is_reference(document.at("e")));
  EXPECT_TRUE(is_expression(document.at("b")));
  EXPECT_TRUE(is_off(document.at("c")));
  EXPECT_FALSE(is_off(document.at("d")));
}

TEST(ValueReaderTest, LongTextIsCutInMessages) {
  Document document("a: " + std::string(39, 'x') + "\u00b5\u00b5 and so on\n");
  EXPECT_EQ(describe(document.at("a")), "'" + std::string(39, 'x') + "...'");
}

}  // namespace
}  // namespace footfall::core
