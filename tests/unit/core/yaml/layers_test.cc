// A mistake in a file over a base is told where it was typed.
#include "core/yaml/layers.h"

#include <gtest/gtest.h>

#include <string>

namespace footfall::core {
namespace {

// Stands for a loader: every `use: NAME` of the tree needs a key NAME in `names`.
void load(const YamlNode& tree, Diagnostics& diagnostics) {
  const YamlNode* names = tree.find("names");
  for (const YamlNode& use : tree.find("uses")->items) {
    if (names == nullptr || names->find(use.scalar) == nullptr) {
      diagnostics.error(use.mark, "unknown-name", "unknown '" + use.scalar + "'");
    }
  }
}

std::string problems(const std::string& base, const std::string& own) {
  Diagnostics diagnostics;
  YamlLayers layers;
  for (const std::string& text : {base, own}) {
    const std::string name = layers.files.empty() ? "base" : "own";
    layers.files.push_back(load_yaml_text(text, name, diagnostics));
  }
  YamlNode tree = layers.files[0];
  YamlNode top = layers.files[1];
  merge_over(tree, std::move(top), nullptr, diagnostics);
  Diagnostics found = diagnostics;
  load(tree, found);
  return blame_edits(layers, diagnostics, found, load).to_string();
}

constexpr const char* kBase = "uses: [a, b, a]\nnames: {a: 1, b: 2}\n";

TEST(Layers, AnEditWithoutWhichTheErrorsAreGoneIsTheirCause) {
  EXPECT_EQ(problems(kBase, "names: {a: off}\n"),
            "own:1:12: error: 'names.a' is removed: unknown 'a' (needed at base:1:8 and 1 more)\n");
}

TEST(Layers, TwoMistakesAreToldAtTheirTwoPlaces) {
  EXPECT_EQ(problems(kBase, "names: {a: off, c: 3, b: off}\n"),
            "own:1:12: error: 'names.a' is removed: unknown 'a' (needed at base:1:8 and 1 more)\n"
            "own:1:26: error: 'names.b' is removed: unknown 'b' (needed at base:1:11)\n");
}

TEST(Layers, ErrorsOfTheFileItselfAndOfABaseThatWasWrongBeforeStay) {
  EXPECT_EQ(problems(kBase, "uses: [c]\n"), "own:1:8: error: unknown 'c'\n");
  EXPECT_EQ(problems("uses: [a, d]\nnames: {a: 1}\n", "names: {b: 1}\n"),
            "base:1:11: error: unknown 'd'\n");
}

std::string lost(const std::string& old, const std::string& now) {
  Diagnostics diagnostics;
  YamlNode base = load_yaml_text(old, "base", diagnostics);
  YamlHistory history;
  merge_over(base, load_yaml_text(now, "own", diagnostics), &history, diagnostics);
  warn_lost_items(history, diagnostics);
  return diagnostics.to_string();
}

TEST(Layers, AListOfMapsThatReplacesAnotherIsWarnedAbout) {
  EXPECT_EQ(lost("s: {do: [{mark: step}]}\n", "s: {do: [{log: x}]}\n"),
            "own:1:9: warning: replaces the base's list of 1; `do+:` appends, beside `do: off` "
            "it replaces\n");
  EXPECT_EQ(lost("do: [{p: f, every: 1, at: 2}]\n", "do: [{p: f, at: 3}]\n"),
            "own:1:5: warning: replaces the base's list of 1, without its `every`; `do+:` "
            "appends, beside `do: off` it replaces\n");
}

TEST(Layers, NothingIsSaidWhereNothingIsLost) {
  EXPECT_EQ(lost("do: [{a: 1}]\n", "do: [{b: 1}, {a: 1}]\n"), "");
  EXPECT_EQ(lost("do: [{a: 1}]\n", "do+: [{b: 1}]\n"), "");
  EXPECT_EQ(lost("do: [{a: 1}]\n", "do: off\n"), "");
  EXPECT_EQ(lost("do: [{a: 1}]\n", "do: []\n"), "");
  EXPECT_EQ(lost("do: [{a: 1}]\n", "do: off\ndo+: [{b: 1}]\n"), "");
  EXPECT_EQ(lost("kp: [1, 2]\n", "kp: [3, 4]\n"), "");
}

}  // namespace
}  // namespace footfall::core
