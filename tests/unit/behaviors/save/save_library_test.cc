// Files of the library and of the examples (a fourth of them, in the full set all), all live values
// changed at random; and files in every layout, whole and broken.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <regex>
#include <set>

#include "tests/unit/behaviors/save/save_test_support.h"

namespace footfall::tests {
namespace {

namespace fs = std::filesystem;
using behaviors::Behavior;
using behaviors::NamedValue;

int rounds(int few) {
  const char* many = std::getenv("FOOTFALL_SAVE_ROUNDS");
  return many == nullptr ? few : std::atoi(many);
}

using Random = std::mt19937_64;

double uniform(Random& random, double from, double to) {
  return std::clamp(std::uniform_real_distribution(from, to)(random), from, to);
}

// Within the range; now and then a number as people write them, now and then all axes alike.
NamedValue random_value(const behaviors::ParameterInfo& info, Random& random) {
  NamedValue value{info.name, {}};
  const bool alike = random() % 3 == 0;
  for (int k = 0; k < info.size; ++k) {
    double number = uniform(random, info.min, info.max);
    if (random() % 2 == 0) number = std::clamp(std::round(number * 1e3) / 1e3, info.min, info.max);
    value.values.push_back(alike && k > 0 ? value.values.front() : number);
  }
  return value;
}

std::vector<std::uint64_t> bits(const std::vector<double>& values) {
  std::vector<std::uint64_t> out;
  for (const double value : values) out.push_back(std::bit_cast<std::uint64_t>(value));
  return out;
}

// What a behavior's values must be, bit for bit.
std::vector<std::uint64_t> expected_bits(const Behavior& before,
                                         const std::vector<NamedValue>& values) {
  std::vector<double> expected = before.values;
  for (const NamedValue& value : values) {
    const auto& info =
        before.parameters.at(static_cast<std::size_t>(before.find_parameter(value.name)));
    std::ranges::copy(value.values, expected.begin() + info.slot);
  }
  return bits(expected);
}

std::unique_ptr<Behavior> load_file(const std::string& path) {
  core::Diagnostics diagnostics;
  return behaviors::load_behavior(path, options_for_tests(), diagnostics);
}

// Whether a text is another one with nothing but the plan's places changed.
bool only_places_differ(const core::FileChange& change, const behaviors::SavePlan& plan) {
  std::vector<std::string> lines(1);
  for (const char c : change.before) {
    lines.back() += c;
    if (c == '\n') lines.emplace_back();
  }
  std::set<std::pair<int, int>> done;  // names may share a place; from the right to the left
  for (auto place = plan.places.rbegin(); place != plan.places.rend(); ++place) {
    if (place->file != change.path || place->line == 0) continue;
    if (!done.insert({place->line, place->column}).second) continue;
    std::string& line = lines.at(static_cast<std::size_t>(place->line) - 1);
    const auto at = line.find(place->old_text, static_cast<std::size_t>(place->column) - 1);
    if (at != static_cast<std::size_t>(place->column) - 1) return false;
    line.replace(at, place->old_text.size(), place->new_text);
  }
  std::string text;
  for (const std::string& line : lines) text += line;
  return text == change.after;
}

class SaveLibrary : public SaveTest {
 protected:
  void copy_shipped() const {
    for (const char* folder : {"behaviors/library", "examples"}) {
      fs::create_directories(folder_ / folder);
      fs::copy(fs::path(FOOTFALL_SOURCE_DIR) / folder, folder_ / folder,
               fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    }
  }
  std::vector<std::string> shipped() const {
    std::vector<std::string> names;
    for (const char* folder : {"behaviors/library", "examples"}) {
      for (const auto& entry : fs::directory_iterator(folder_ / folder)) {
        const std::string name = std::string(folder) + "/" + entry.path().filename().string();
        if (entry.path().extension() == ".yaml" && load_file(file(name))) names.push_back(name);
      }
    }
    std::ranges::sort(names);
    if (std::getenv("FOOTFALL_SAVE_ROUNDS") != nullptr) return names;
    std::vector<std::string> some;  // all of them: the full set
    for (std::size_t k = 0; k < names.size(); k += 4) some.push_back(names[k]);
    return some;
  }
};

TEST_F(SaveLibrary, AllLiveValuesOfEveryFileReadBackBitForBitAndNothingElseChanges) {
  copy_shipped();
  Random random(7);
  int changed = 0;
  for (const std::string& name : shipped()) {
    for (int round = 0; round < rounds(2); ++round) {
      copy_shipped();
      const auto before = load_file(file(name));
      std::vector<NamedValue> values;
      for (const auto& info : before->parameters) {
        if (info.live) values.push_back(random_value(info, random));
      }
      const auto made = plan(name, values);
      ASSERT_FALSE(made.refused()) << name << ": " << made.refusals.front();
      // What a base has is written as an override: new lines.
      const bool in_place =
          std::ranges::none_of(made.places, [](const auto& place) { return place.line == 0; });
      for (const auto& change : made.files) {
        EXPECT_TRUE(!in_place || only_places_differ(change, made)) << name;
      }
      ASSERT_TRUE(behaviors::write_saved(made).empty());
      const auto after = load_file(file(name));
      ASSERT_NE(after, nullptr) << name;
      EXPECT_EQ(bits(after->values), expected_bits(*before, values)) << name;
      EXPECT_TRUE(plan(name, values).files.empty()) << name;  // it is all there now
      changed += static_cast<int>(values.size());
    }
  }
  EXPECT_GT(changed, 50);
}

TEST_F(SaveLibrary, AllLiveValuesOfEveryFileFindPlaceInAnOverlay) {
  copy_shipped();
  Random random(8);
  for (const std::string& name : shipped()) {
    const auto before = load_file(file(name));
    const std::string overlay = fs::path(name).parent_path().string() + "/over.yaml";
    fs::remove(file(overlay));
    std::vector<NamedValue> all;
    for (const auto& info : before->parameters) {
      if (info.live) all.push_back(random_value(info, random));
    }
    // In two steps: the second one edits what the first has made.
    const auto half = static_cast<std::ptrdiff_t>(all.size() / 2);
    const std::vector<NamedValue> some(all.begin(), all.begin() + half);
    for (const auto& values : {some, all}) {
      const auto made = plan(name, values, overlay);
      ASSERT_FALSE(made.refused()) << name << ": " << made.refusals.front();
      ASSERT_TRUE(behaviors::write_saved(made).empty());
      if (values.empty()) continue;
      const auto after = load_file(file(overlay));
      ASSERT_NE(after, nullptr) << name;
      EXPECT_EQ(bits(after->values), expected_bits(*before, values)) << name;
    }
    EXPECT_EQ(bits(load_file(file(name))->values), bits(before->values)) << name;
  }
}

// A statechart whose parameters stand in every layout that YAML has.
std::string random_layout(Random& random) {
  const auto pick = [&random](std::initializer_list<const char*> words) {
    return std::string(words.begin()[random() % words.size()]);
  };
  std::string text = pick({"", "\xEF\xBB\xBF", "# µ head\n", "---\n"}) + "behavior: 1\n";
  text += "parameters:" + pick({"\n", "  # here\n", "\n\n", " # ü: {\n"});
  const std::size_t indent = 1 + random() % 4;
  std::string anchor;
  for (int k = 0; k < 5; ++k) {
    const std::string number =
        pick({"1", "-2.5", "+3 ms", "4e-3 s", "5ms", ".5 m", "7 %", "30 deg", "0", "1 Nm/rad"});
    const std::string quote = pick({"", "", "\"", "'"});
    std::string value = quote + number + quote;
    if (k == 1 && random() % 3 == 0) anchor = "&n ", value = anchor + value;
    if (k == 3 && !anchor.empty()) value = "*n ";
    if (random() % 4 == 0 && k != 1 && k != 3)
      value = "[" + value + pick({", ", " ,", ",\n         "}) + value + "]";
    const std::string name = "p" + std::to_string(k);
    const std::string pad(indent, ' ');
    switch (random() % 4) {
      case 0:
        text += pad + name + pick({": ", ":   ", " : "}) + value;
        break;
      case 1:
        text += pad + name + ": {value: " + value + pick({"}", " , doc: \"a: b # c\"}", "  }"});
        break;
      case 2:
        text += pad + "\"" + name + "\": {doc: 'it''s',\n      value: " + value + "\n   }";
        break;
      default:
        text += pad + name + ":\n" + pad + "  doc: |\n" + pad + "    value: 9\n" + pad +
                "  value: " + value;
    }
    text += pick({"\n", "  # why\n", "   \n", "\n\n"});
  }
  text += "machine: {states: {a: {after: 1 s, to: a}}}" + pick({"", "\n", "\n\n# end"});
  if (random() % 3 != 0) return text;
  std::string crlf;
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return crlf;
}

// Flips, drops, doubles or moves bytes.
void mutate(std::string& text, Random& random) {
  for (auto n = 1 + random() % 3; n > 0 && !text.empty(); --n) {
    const std::size_t at = random() % text.size();
    const std::string_view odd = " \n:,{}[]#\"'&*|>-?!%\t0e.";
    switch (random() % 4) {
      case 0:
        text[at] = odd[random() % odd.size()];
        break;
      case 1:
        text.erase(at, 1 + random() % 3);
        break;
      case 2:
        text.insert(at, text.substr(random() % text.size(), random() % 12));
        break;
      default:
        text.insert(at, 1, odd[random() % odd.size()]);
    }
  }
}

// A text is saved into with random values; whatever was written loads to these values.
class SaveLayouts : public SaveLibrary {
 protected:
  bool round(const std::string& text, Random& random, bool overlay) const {
    put("b.yaml", text);
    fs::remove(file("over.yaml"));
    const auto before = load_file(file("b.yaml"));
    if (before == nullptr || before->parameters.empty()) return false;
    std::vector<NamedValue> values;
    for (const auto& info : before->parameters) {
      if (random() % 3 == 0) continue;
      NamedValue value{info.name, {}};
      for (int k = 0; k < info.size; ++k) value.values.push_back(uniform(random, -9.0, 9.0));
      values.push_back(value);
    }
    const auto made = plan("b.yaml", values, overlay ? "over.yaml" : "");
    if (made.refused() || made.files.empty()) return false;
    EXPECT_TRUE(behaviors::write_saved(made).empty());
    const auto after = load_file(file(overlay ? "over.yaml" : "b.yaml"));
    EXPECT_NE(after, nullptr) << text;
    if (after == nullptr) return false;
    EXPECT_EQ(bits(after->values), expected_bits(*before, values)) << text;
    EXPECT_TRUE(!overlay || get("b.yaml") == text);
    return true;
  }
};

TEST_F(SaveLayouts, EveryLayoutKeepsItsBytes) {
  Random random(9);
  int saved = 0;
  const int count = 10 * rounds(20);
  for (int k = 0; k < count; ++k) {
    const std::string text = random_layout(random);
    ASSERT_NO_FATAL_FAILURE(saved += round(text, random, k % 4 == 0) ? 1 : 0);
    if (k % 4 == 0) continue;
    // Numbers and their units aside, nothing is another byte.
    static const std::regex quantity(
        "[-+]?[0-9.]+(e[-+]?[0-9]+)?( ?(ms|s|deg|rad|%|Nm/rad|m))?(?![a-z])");
    const auto blank = [](const std::string& all) {
      return std::regex_replace(all, quantity, "#");
    };
    EXPECT_EQ(blank(get("b.yaml")), blank(text));
  }
  EXPECT_GT(saved, count * 6 / 10);  // the rest: an alias whose two names got two values
}

TEST_F(SaveLayouts, ABrokenLayoutNeverLeadsToAWrongFile) {
  Random random(10);
  int saved = 0;
  for (int k = 0; k < 20 * rounds(20); ++k) {
    std::string text = random_layout(random);
    mutate(text, random);
    saved += round(text, random, k % 4 == 0) ? 1 : 0;
  }
  EXPECT_GT(saved, 0);
}

}  // namespace
}  // namespace footfall::tests
