// The canonical layout: what it looks like, and that it changes neither meaning nor itself.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "core/yaml_text/format.h"
#include "core/yaml_text/tokens.h"

namespace footfall::core {
namespace {

namespace fs = std::filesystem;
using Kind = YamlToken::Kind;

std::string formatted(const std::string& text) {
  return format_yaml(text).value_or("(not formatted)");
}

YamlNode tree(const std::string& text, const std::string& name = "t.yaml") {
  Diagnostics diagnostics;
  YamlNode root = load_yaml_text(text, name, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.to_string() << text;
  return root;
}

TEST(YamlFormat, IndentsByTwoAndSpacesOnce) {
  EXPECT_EQ(
      formatted(
          "a:\n    b :   {x:  1,y: [ 1,2 , 3 ]}\n    c:\n    - d:    1\n      e: 2\n    - f\n"),
      "a:\n  b: {x: 1, y: [1, 2, 3]}\n  c:\n    - d: 1\n      e: 2\n    - f\n");
}

TEST(YamlFormat, KeepsHandMadeLinesOfBracketsBelowTheFirstItem) {
  EXPECT_EQ(formatted("k: {a: 1,\n b: [1,\n   2],\n      c: 3}\nl: [\n a,\n b\n ]\n"),
            "k: {a: 1,\n    b: [1,\n        2],\n    c: 3}\nl: [\n  a,\n  b\n  ]\n");
}

TEST(YamlFormat, BreaksALineThatIsTooLongAtTheOutermostCommas) {
  std::string items;
  for (int k = 0; k < 19; ++k)
    items += (k == 0 ? "" : ", ") + std::string("[long_name, ") + std::to_string(k) + "]";
  const std::string text = formatted("list: [" + items + "]\n");
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    EXPECT_LE(line.size(), 120U);
    if (count > 0) {
      EXPECT_TRUE(line.starts_with("       [long_name")) << line;
    }
  }
  EXPECT_EQ(count, 3);  // 7 items in 119 bytes, then 6 and 6
  EXPECT_EQ(formatted(text), text);
  EXPECT_TRUE(same_values(tree("list: [" + items + "]\n"), tree(text)));
}

TEST(YamlFormat, KeepsCommentsWithWhatTheyBelongTo) {
  EXPECT_EQ(formatted("#top\n\n\n\na:   # of a\n    # first of a\n    b: 1 # of b\n    # last of "
                      "a\n# before c\nc: 2\n#end\n"),
            "# top\n\na:  # of a\n  # first of a\n  b: 1  # of b\n  # last of a\n# before c\nc: "
            "2\n# end\n");
}

TEST(YamlFormat, PutsUnitsBehindABlankAndDropsQuotesOfWords) {
  EXPECT_EQ(formatted("a: 16ms\nb: [5 %,5%, -2.5e-3kg m^2]\nc: 'word'\nd: 'two words'\ne: \"off\"\n"
                      "f: \"it's\"\ng: \"= 16ms\"\ndoc: 5ms\nname: 3m\n"),
            "a: 16 ms\nb: [5 %, 5 %, -2.5e-3 kg m^2]\nc: word\nd: \"two words\"\ne: \"off\"\n"
            "f: \"it's\"\ng: \"= 16ms\"\ndoc: 5ms\nname: 3m\n");
}

TEST(YamlFormat, LeavesTheTextOfScalarsOverSeveralLinesAlone) {
  const std::string text =
      "a: |\n    one\n      two  \n\n    three\nb: >-\n   folded\n   text\nc: plain\n     goes "
      "on\n\n     here\n"
      "d: \"quoted \\\n       goes on\n\n   here\"\n";
  const std::string result = formatted(text);
  EXPECT_EQ(
      result,
      "a: |\n  one\n    two  \n\n  three\nb: >-\n  folded\n  text\nc: plain\n  goes on\n\n  here\n"
      "d: \"quoted \\\n  goes on\n\n  here\"\n");
  EXPECT_TRUE(same_values(tree(text), tree(result)));
}

TEST(YamlFormat, RefusesWhatItDoesNotLayOut) {
  EXPECT_FALSE(format_yaml("? a\n: b\n"));
  EXPECT_FALSE(format_yaml("a: \"open\n"));
  EXPECT_FALSE(format_yaml("a: [1, 2\n"));
}

TEST(YamlFormat, SameValuesSeesEveryDifferenceThatCounts) {
  EXPECT_TRUE(same_values(tree("a: 16ms\n"), tree("a: 16 ms\n")));
  EXPECT_FALSE(same_values(tree("a: 16 ms\n"), tree("a: 16 s\n")));
  EXPECT_FALSE(same_values(tree("a: off\n"), tree("a: \"off\"\n")));
  EXPECT_FALSE(same_values(tree("{a: 1, b: 2}\n"), tree("{b: 2, a: 1}\n")));
  EXPECT_FALSE(same_values(tree("[a, b]\n"), tree("[a, b, c]\n")));
  EXPECT_FALSE(same_values(tree("a: [b]\n"), tree("a: b\n")));
}

std::vector<fs::path> shipped_files() {
  std::vector<fs::path> files;
  for (const char* folder : {"behaviors", "examples", "robots", "sim"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(FOOTFALL_SOURCE_DIR) / folder)) {
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
    }
  }
  return files;
}

std::string contents(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(YamlFormat, ShippedFilesAreCanonical) {
  for (const fs::path& path : shipped_files()) {
    const std::string text = contents(path);
    const std::string result = formatted(text);
    EXPECT_TRUE(same_values(tree(text), tree(result))) << path;
    EXPECT_EQ(formatted(result), result) << path;
    EXPECT_EQ(result, text) << path;
  }
}

// The same tokens with other blanks: wider indentation, blanks before and behind each token where
// YAML lets them be, empty lines, blanks at the ends.
std::string spread(const std::vector<YamlToken>& tokens, std::mt19937& random) {
  const auto some = [&](int least, int most) {
    return std::string(
        static_cast<std::size_t>(std::uniform_int_distribution<int>(least, most)(random)), ' ');
  };
  const std::size_t scale = std::uniform_int_distribution<std::size_t>(1, 3)(random);
  std::string out;
  std::size_t depth = 0, written = 0;
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    const YamlToken& token = tokens[k];
    if (token.begins_line) {
      if (k > 0) out += "\n";
      // One empty line at a place stays one; none is made where there was none.
      if (token.empty_lines > 0) out += "\n";
      // Further lines in brackets may stand anywhere that is indented.
      out += depth > 0 && token.kind != Kind::comment ? some(45, 60)
                                                      : std::string(token.column * scale, ' ');
      written = token.column;
    } else if (token.kind == Kind::comment) {
      out += some(1, 6);
    } else if (token.kind == Kind::colon) {
      out += some(0, 1);
    } else if (token.kind == Kind::comma || token.kind == Kind::close ||
               tokens[k - 1].kind == Kind::open) {
      out += some(0, 3);
    } else if (tokens[k - 1].kind == Kind::dash) {
      out += std::string((token.column - written) * scale - 1, ' ');
      written = token.column;
    } else {
      out += some(1, 4);
    }
    out += token.text;
    if (token.kind == Kind::open) ++depth;
    if (token.kind == Kind::close) --depth;
  }
  return out + some(0, 3) + "\n" + some(0, 2);
}

TEST(YamlFormat, BlanksDoNotMatter) {
  std::mt19937 random(7);
  for (const fs::path& path : shipped_files()) {
    const std::string text = contents(path);
    const auto tokens = yaml_tokens(text);
    ASSERT_TRUE(tokens) << path;
    for (int k = 0; k < 20; ++k) {
      const std::string other = spread(*tokens, random);
      ASSERT_TRUE(same_values(tree(text), tree(other))) << other;
      ASSERT_EQ(formatted(other), text) << other;
    }
  }
}

}  // namespace
}  // namespace footfall::core
