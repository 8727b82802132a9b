// Characters and numbers that look right in a YAML file and are not: one error each, which names
// what to type.
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "core/diagnostics/quantity_hint.h"
#include "core/text/look_alike.h"
#include "core/yaml/value_reader.h"
#include "core/yaml/yaml.h"

namespace footfall::core {
namespace {

std::string problems(std::string_view text) {
  Diagnostics diagnostics;
  load_yaml_text(text, "f.yaml", diagnostics);
  return diagnostics.to_string();
}

std::string in_utf16(std::string_view text, bool little) {
  std::string out;
  for (const char c : text) {
    out += little ? c : '\0';
    out += little ? '\0' : c;
  }
  return out;
}

TEST(YamlTraps, AFileInUtf16IsOneErrorThatNamesTheEncoding) {
  const std::string text = "behavior: 1\nmachine: {}\n";
  const std::string wanted = "f.yaml:1:1: error: UTF-16 text: save the file as UTF-8\n";
  EXPECT_EQ(problems(in_utf16(text, true)), wanted);
  EXPECT_EQ(problems(in_utf16(text, false)), wanted);
  EXPECT_EQ(problems("\xff\xfe" + in_utf16(text, true)), wanted);
  EXPECT_EQ(problems("\xfe\xff" + in_utf16(text, false)), wanted);
  EXPECT_EQ(problems(std::string("\xff\xfe\0\0b\0\0\0", 8)),
            "f.yaml:1:1: error: UTF-32 text: save the file as UTF-8\n");
}

TEST(YamlTraps, BytesOfAnotherEncodingAreOneErrorForAllLines) {
  EXPECT_EQ(problems("a: gr\xf6\xdf\x65\nb: \xe4\nc: \xfc\n"),
            "f.yaml:1:6: error: not UTF-8 text (byte 0xf6) (and in 2 other lines)\n");
}

TEST(YamlTraps, ALoneCarriageReturnEndsALine) {
  Diagnostics diagnostics;
  const YamlNode root = load_yaml_text("a: 1\rb:\r  c: 2\r", "f.yaml", diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  ASSERT_NE(root.find("b"), nullptr);
  EXPECT_EQ(root.find("b")->find("c")->mark.line, 3);
  EXPECT_EQ(problems("a: 1\ra: 2\r"), "f.yaml:2:1: error: duplicate key 'a', first on line 1\n");
  EXPECT_EQ(problems("a: 1\r\nb: 2\r\n"), "");
}

TEST(YamlTraps, CharactersThatLookLikeBlanksAreOneErrorWhereABlankIsNeeded) {
  const std::string type = " looks like a blank and is none: type a blank";
  EXPECT_EQ(problems("a:\n\u00a0\u00a0b: 1\n\u00a0\u00a0c: 1\n\u00a0\u00a0d: 1\n"),
            "f.yaml:2:1: error: U+00A0 (no-break space)" + type + " (and in 2 other lines)\n");
  EXPECT_EQ(problems("a:\u00a01\n"), "f.yaml:1:3: error: U+00A0 (no-break space)" + type + "\n");
  EXPECT_EQ(problems("x: {a:\u20091}\n"),
            "f.yaml:1:7: error: U+2009 (space of another width)" + type + "\n");
  EXPECT_EQ(problems("-\u00a0a\n"), "f.yaml:1:2: error: U+00A0 (no-break space)" + type + "\n");
  EXPECT_EQ(problems("a: 1\n\ufeffb: 2\n"),
            "f.yaml:2:1: error: U+FEFF (byte order mark) looks like a blank and is none: delete "
            "it\n");
}

TEST(YamlTraps, AColonThatOnlyLooksLikeOneIsToldWhereItStands) {
  const std::string why =
      ": error: U+FF1A (full-width form) looks like a ':' and is none: type ':'\n";
  EXPECT_EQ(problems("a: 1\nb\uff1a 2\nc: 3\n"), "f.yaml:2:2" + why);
  EXPECT_EQ(problems("a: 1\nb\uff1a\n  deep\n  c: 3\n"), "f.yaml:2:2" + why);
  EXPECT_EQ(problems("a: 1\n\uff1a b: {\n").find("looks like"), std::string::npos);
  EXPECT_EQ(problems("a: some\n  text\uff1a more\nb: 1\n"), "");
}

TEST(YamlTraps, TheSameCharactersAreFineInTextsAndComments) {
  EXPECT_EQ(problems("\ufeffa: \"Helas, note:\u00a0x\"  # it:\u00a0is \u2212 \u201cso\u201d\n"
                     "b: 10\u00a0m wide, note:\u00a0x\nc: |\n  text\n  \u00a0\u00a0more\nd: 1\n"),
            "");
}

TEST(YamlTraps, AMessageNamesTheCharacterThatOnlyLooksRight) {
  const auto message = [](std::string text) {
    Diagnostics diagnostics;
    diagnostics.error({}, "expected", std::move(text));
    return diagnostics.to_string();
  };
  EXPECT_EQ(message("unknown '\u22123'"),
            "error: unknown '\u22123'; it has U+2212 (minus sign): type '-'\n");
  EXPECT_EQ(message("unknown 'aft\u200ber'"),
            "error: unknown 'aft\u200ber'; it has U+200B (zero-width space): delete it\n");
  EXPECT_EQ(message("unknown '\u0430fter'"),
            "error: unknown '\u0430fter'; it has U+0430 (Cyrillic letter)\n");
  EXPECT_EQ(message("unknown '3 \u00b5s'"), "error: unknown '3 \u00b5s'\n");
  EXPECT_EQ(without_look_alikes("\u00a03\u202fcm\u200b"), "3 cm");
}

TEST(YamlTraps, ADecimalCommaInBracesIsOneError) {
  EXPECT_EQ(problems("a: {value: 3,5 cm, b: 2}\n"),
            "f.yaml:1:12: error: a decimal point, not a comma: '3.5 cm'\n");
  EXPECT_EQ(problems("a: {kp: 270,5}\n"),
            "f.yaml:1:9: error: a decimal point, not a comma: '270.5'\n");
  EXPECT_EQ(problems("a: {kp: -0,5, kd: 1,25}\n"),
            "f.yaml:1:9: error: a decimal point, not a comma: '-0.5'\n"
            "f.yaml:1:19: error: a decimal point, not a comma: '1.25'\n");
  EXPECT_EQ(problems("a: {b: x, c: }\n"), "");
}

TEST(YamlTraps, ACommaWithoutABlankIsDoubtfulAmongOthersWithOne) {
  EXPECT_EQ(problems("a: [100,5, 200]\n"),
            "f.yaml:1:5: warning: '100,5' is two values: 100.5 has a decimal point, not a comma; "
            "if two are meant, a blank belongs after the comma\n");
  EXPECT_EQ(problems("a: [1,2,3]\nb: [1, 2, 3]\nc: [x,y, z]\nd: [1 m,2 m, 3 m]\n"), "");
}

TEST(YamlTraps, AHintNamesTheQuantityThatWasMeant) {
  EXPECT_EQ(quantity_hint("3,5 cm"), ": a decimal point, not a comma: '3.5 cm'");
  EXPECT_EQ(quantity_hint("3 CM"), " (did you mean '3 cm'?)");
  EXPECT_EQ(quantity_hint("3 \u00b0"), " (did you mean '3 deg'?)");
  EXPECT_EQ(quantity_hint("3\u00b0"), " (did you mean '3 deg'?)");
  EXPECT_EQ(quantity_hint("9.81 m/s\u00b2"), " (did you mean '9.81 m/s^2'?)");
  EXPECT_EQ(quantity_hint("8 NM"), " (did you mean '8 Nm'?)");
  EXPECT_EQ(quantity_hint("8 N\u00b7m"), " (did you mean '8 N m'?)");
  EXPECT_EQ(quantity_hint("3 centimeters"), " (did you mean '3 cm'?)");
  EXPECT_EQ(quantity_hint("3 Millimetres"), " (did you mean '3 mm'?)");
  EXPECT_EQ(quantity_hint("20 milliseconds"), " (did you mean '20 ms'?)");
  EXPECT_EQ(quantity_hint("2 secs"), " (did you mean '2 s'?)");
  EXPECT_EQ(quantity_hint("100 hz"), " (did you mean '100 Hz'?)");
  EXPECT_EQ(quantity_hint("220/s^2"), " (did you mean '220 1/s^2'?)");
  EXPECT_EQ(quantity_hint("3\u00a0cm"), " (did you mean '3 cm'?)");
  EXPECT_EQ(quantity_hint("3 CM", kTime), "");
  EXPECT_EQ(quantity_hint("fast"), "");
  EXPECT_EQ(quantity_hint("3 cm"), "");
}

TEST(YamlTraps, ATextThatACommentCutsIsMarked) {
  const auto cut = [](std::string_view text) {
    Diagnostics diagnostics;
    return load_yaml_text(text, "f.yaml", diagnostics).find("a")->cut;
  };
  EXPECT_TRUE(cut("a: step #{n}\n"));
  EXPECT_TRUE(cut("a: foot #2\n"));
  EXPECT_TRUE(cut("a: of # {n}\n"));
  EXPECT_TRUE(cut("a: two\n  lines #3\n"));
  EXPECT_FALSE(cut("a: step  # counts\n"));
  EXPECT_FALSE(cut("a: \"step\" #{n}\n"));
  EXPECT_FALSE(cut("a: step#{n}\n"));
}

TEST(YamlTraps, AnArgumentThatTheShellHasSplitIsTold) {
  bool rest = false;
  EXPECT_EQ(split_argument_hint({"lift_time=150", "ms"}, 1, rest),
            "quote it: \"lift_time=150 ms\"");
  EXPECT_FALSE(rest);
  const std::vector<std::string> list = {"goal=[1", "m,", "2", "m]", "b=1"};
  EXPECT_EQ(split_argument_hint(list, 1, rest), "quote it: \"goal=[1 m, 2 m]\"");
  split_argument_hint(list, 3, rest);
  EXPECT_TRUE(rest);
  EXPECT_EQ(split_argument_hint({"lift_time", "=", "150ms"}, 0, rest),
            "quote it: \"lift_time=150ms\"");
  EXPECT_EQ(split_argument_hint({"a=1", "b"}, 1, rest), "");
  EXPECT_EQ(split_argument_hint({"ms"}, 0, rest), "");
  EXPECT_EQ(split_argument_hint({"name=fast", "more"}, 1, rest), "");
}

}  // namespace
}  // namespace footfall::core
