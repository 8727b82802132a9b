// Each mistake of the case files gets its diagnostic at its place, with a text that says what to
// do, and nothing else is reported: no consequence, no second pass. See cases.h.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <tuple>

#include "behaviors/check/actuators/drives.h"
#include "behaviors/check/physics/check.h"
#include "behaviors/loader.h"
#include "core/diagnostics/ids.h"
#include "lab/scenario/loader.h"
#include "lab/scenario/variation.h"
#include "model/robot/description.h"
#include "sim/world/description.h"
#include "tests/language/mistakes/cases.h"
#include "tests/language/mistakes/source_ids.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

namespace fs = std::filesystem;

const std::string kFolder = std::string(FOOTFALL_SOURCE_DIR) + "/tests/language/mistakes";

// A folder for one case, in which robots/, examples/ and behaviors/ are those of the source tree.
class CaseFolder {
 public:
  CaseFolder() : path_(fs::temp_directory_path() / fmt::format("footfall_mistakes_{}", getpid())) {
    fs::create_directories(path_);
    for (const char* name : {"robots", "examples", "behaviors"}) {
      fs::create_directory_symlink(fs::absolute(fs::path(FOOTFALL_SOURCE_DIR) / name),
                                   path_ / name);
    }
  }
  ~CaseFolder() { fs::remove_all(path_); }
  CaseFolder(const CaseFolder&) = delete;
  CaseFolder& operator=(const CaseFolder&) = delete;
  std::string write(const TextFile& file) const {
    std::ofstream(path_ / file.name) << file.text;
    return (path_ / file.name).string();
  }

 private:
  fs::path path_;
};

std::vector<MistakeCase> all_cases() {
  const std::vector<TextFile> bases = read_bases(kFolder);
  std::vector<MistakeCase> cases;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() != ".yaml" || entry.path().stem() == "bases") continue;
    const std::vector<MistakeCase> more = read_cases(entry.path().string(), bases);
    cases.insert(cases.end(), more.begin(), more.end());
  }
  return cases;
}

// A scenario and, if it has no errors, its draws in its world, as `footfall check` does.
void load_scenario(const std::string& path, core::Diagnostics& diagnostics) {
  const auto scenario = lab::load_scenario(path, {{FOOTFALL_SOURCE_DIR}}, diagnostics);
  if (diagnostics.has_errors()) return;
  core::Diagnostics of_world;
  auto world =
      sim::load_world(sim::find_world_file(scenario.world, {FOOTFALL_SOURCE_DIR}), of_world);
  world.variation = lab::variation_over(scenario, world.variation);
  lab::warn_late_push(scenario, world.variation, diagnostics);
  lab::warn_alike_seeds(scenario, world.variation, diagnostics);
  core::Diagnostics of_behavior;  // positions refer to the behavior's files
  for (const std::string& file : scenario.behavior_files) of_behavior.add_file(file);
  behaviors::check_first_support(*scenario.behavior, world.constraints.empty() ? world.name : "",
                                 of_behavior);
  for (core::Diagnostic item : of_behavior.all()) {
    item.mark.file = diagnostics.add_file(of_behavior.file(item.mark.file));
    diagnostics.add(item);
  }
}

void load(const std::string& path, const std::string& text,
          const std::vector<std::pair<std::string, std::string>>& set,
          core::Diagnostics& diagnostics) {
  if (text.starts_with("robot: 1\n")) {
    const auto robot = model::load_robot(path, diagnostics);
    if (!diagnostics.has_errors()) behaviors::check_drives(robot, diagnostics);
  } else if (text.starts_with("world: 1\n")) {
    const auto world = sim::load_world(path, diagnostics);
    if (diagnostics.has_errors()) return;
    sim::check_supported(world, diagnostics);
    model::RobotDescription robot = load_hume();
    sim::check_actuators(world.actuators, robot, world.physics.steps_per_tick, diagnostics);
    robot.sensors.imu_site.clear();  // the only robot of these cases that lacks one
    sim::check_sensors(world.sensors, robot, diagnostics);
  } else if (text.starts_with("scenario: 1\n")) {
    load_scenario(path, diagnostics);
  } else {
    behaviors::LoadOptions options;
    options.search = {FOOTFALL_SOURCE_DIR};
    options.set = set;
    behaviors::load_behavior(path, options, diagnostics);
  }
}

template <typename Item, typename Place>
void sort_by_place(std::vector<Item>& items, Place place) {
  std::sort(items.begin(), items.end(),
            [&](const Item& a, const Item& b) { return place(a) < place(b); });
}

std::string describe(const std::vector<core::Diagnostic>& found) {
  std::string out;
  for (const core::Diagnostic& item : found) {
    out += fmt::format("\n    {}:{} {}: {}", item.mark.line, item.mark.column, item.id, item.text);
  }
  return out.empty() ? "\n    nothing" : out;
}

std::string describe(const std::vector<ExpectedDiagnostic>& expected) {
  std::string out;
  for (const ExpectedDiagnostic& item : expected) {
    out += fmt::format("\n    {}:{} {}: ...{}...", item.line, item.column, item.id, item.part);
  }
  return out;
}

void expect_exactly(const MistakeCase& mistake, const CaseFolder& folder) {
  core::Diagnostics diagnostics;
  for (const TextFile& file : mistake.files) folder.write(file);
  load(folder.write(mistake.files.front()), mistake.files.front().text, mistake.set, diagnostics);
  std::vector<core::Diagnostic> found = diagnostics.all();
  sort_by_place(found, [](const auto& item) { return std::tie(item.mark.line, item.mark.column); });
  std::vector<ExpectedDiagnostic> expected = mistake.expected;
  sort_by_place(expected, [](const auto& item) { return std::tie(item.line, item.column); });
  const auto fits = [&](const ExpectedDiagnostic& wanted, const core::Diagnostic& item) {
    return item.mark.line == wanted.line && item.mark.column == wanted.column &&
           item.id == wanted.id && item.text.find(wanted.part) != std::string::npos &&
           (wanted.file.empty() ||
            fs::path(diagnostics.file(item.mark.file)).filename() == wanted.file);
  };
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), found.begin(), found.end(), fits))
      << mistake.name << "\n  expected" << describe(expected) << "\n  found" << describe(found);
  for (const core::Diagnostic& item : found) {
    const core::DiagnosticInfo* info = core::find_diagnostic_id(item.id);
    ASSERT_NE(info, nullptr) << item.id;
    EXPECT_EQ(info->severity, item.severity) << item.id;
  }
}

TEST(Mistakes, EachMistakeGetsOneDiagnosticAtItsPlaceThatSaysWhatToDo) {
  const CaseFolder folder;
  std::size_t single = 0, several = 0;
  for (const MistakeCase& mistake : all_cases()) {
    const bool five = mistake.name.starts_with("five.yaml: ");
    EXPECT_EQ(mistake.expected.size(), five ? 5U : 1U) << mistake.name;
    ++(five ? several : single);
    expect_exactly(mistake, folder);
  }
  EXPECT_GE(single, 300U);
  EXPECT_GE(several, 20U);
}

TEST(Mistakes, TheTextsThatCasesChangeHaveNone) {
  const CaseFolder folder;
  for (const TextFile& base : read_bases(kFolder)) {
    core::Diagnostics diagnostics;
    load(folder.write({base.name + ".yaml", base.text}), base.text, {}, diagnostics);
    EXPECT_EQ(diagnostics.to_string(), "") << base.name;
  }
}

TEST(Mistakes, EveryIdInTheSourcesIsRegistered) {
  for (const auto& [id, file] : ids_in_sources(FOOTFALL_SOURCE_DIR)) {
    EXPECT_NE(core::find_diagnostic_id(id), nullptr)
        << "'" << id << "' in " << file << " is missing in core/diagnostics/ids.cc";
  }
}

TEST(Mistakes, EveryRegisteredIdIsUsedAndHasACase) {
  std::set<std::string> used, shown;
  for (const auto& [id, file] : ids_in_sources(FOOTFALL_SOURCE_DIR)) used.insert(id);
  for (const MistakeCase& mistake : all_cases()) {
    if (mistake.expected.size() == 1) shown.insert(mistake.expected.front().id);
  }
  core::Diagnostics nothing_there;  // the one mistake that no case can show
  behaviors::load_behavior("no/such/file.yaml", {}, nothing_there);
  for (const core::Diagnostic& item : nothing_there.all()) shown.insert(item.id);
  for (const core::DiagnosticInfo& info : core::diagnostic_ids()) {
    const std::string id(info.id);
    EXPECT_TRUE(used.contains(id)) << "nothing reports '" << id << "'";
    EXPECT_TRUE(shown.contains(id)) << "no case in tests/language/mistakes expects '" << id << "'";
  }
}

}  // namespace
}  // namespace footfall::tests
