// Files with one mistake each (one/), and with five (five/). Each says in its first lines what is
// to be found, and where; the places were counted by hand:
//     # expect: LINE:COLUMN id       0:0: the file as a whole
//     # says: part of the message, that tells what to do
//     # set: NAME=VALUE              optional, as after `footfall check --set`
// Nothing else may be reported: no consequence, no second pass.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <tuple>

#include "behaviors/loader.h"
#include "core/diagnostics/ids.h"
#include "lab/scenario/loader.h"
#include "model/robot/description.h"
#include "sim/world/description.h"
#include "tests/language/mistakes/source_ids.h"

namespace footfall::tests {
namespace {

namespace fs = std::filesystem;

struct Expected {
  int line = 0, column = 0;
  std::string id, says;
};

struct WrongFile {
  fs::path path;
  std::string text;
  std::vector<Expected> expected;
  std::vector<std::pair<std::string, std::string>> set;
};

std::string after(const std::string& line, const std::string& key) {
  return line.starts_with(key) ? line.substr(key.size()) : std::string();
}

WrongFile read(const fs::path& path) {
  WrongFile file{path, {}, {}, {}};
  std::ifstream in(path);
  std::string line;
  while (std::getline(in, line)) {
    file.text += line + "\n";
    if (const std::string place = after(line, "# expect: "); !place.empty()) {
      Expected expected;
      char colon = 0;
      std::istringstream(place) >> expected.line >> colon >> expected.column >> expected.id;
      file.expected.push_back(expected);
    } else if (const std::string says = after(line, "# says: "); !says.empty()) {
      file.expected.back().says = says;
    } else if (const std::string set = after(line, "# set: "); !set.empty()) {
      const std::size_t equal = set.find('=');
      file.set.emplace_back(set.substr(0, equal), set.substr(equal + 1));
    }
  }
  return file;
}

std::vector<WrongFile> wrong_files(const char* folder) {
  std::vector<fs::path> paths;
  const fs::path root = fs::path(FOOTFALL_SOURCE_DIR) / "tests" / "language" / "mistakes" / folder;
  for (const auto& entry : fs::directory_iterator(root)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<WrongFile> files;
  for (const fs::path& path : paths) files.push_back(read(path));
  return files;
}

// What loading the file reports, by place.
std::vector<core::Diagnostic> report(const WrongFile& file) {
  core::Diagnostics diagnostics;
  const std::string path = file.path.string();
  if (file.text.find("\nrobot: 1\n") != std::string::npos) {
    model::load_robot(path, diagnostics);
  } else if (file.text.find("\nworld: 1\n") != std::string::npos) {
    const auto world = sim::load_world(path, diagnostics);
    if (!diagnostics.has_errors()) sim::check_supported(world, diagnostics);
  } else if (file.text.find("\nscenario: 1\n") != std::string::npos) {
    lab::load_scenario(path, {{FOOTFALL_SOURCE_DIR}}, diagnostics);
  } else {
    behaviors::LoadOptions options;
    options.search = {FOOTFALL_SOURCE_DIR};
    options.set = file.set;
    behaviors::load_behavior(path, options, diagnostics);
  }
  std::vector<core::Diagnostic> found = diagnostics.all();
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::tie(a.mark.line, a.mark.column) < std::tie(b.mark.line, b.mark.column);
  });
  return found;
}

std::string describe(const std::vector<core::Diagnostic>& found) {
  std::string out;
  for (const core::Diagnostic& item : found) {
    out += fmt::format("\n    {}:{} {}: {}", item.mark.line, item.mark.column, item.id, item.text);
  }
  return out.empty() ? "\n    nothing" : out;
}

bool fits(const Expected& expected, const core::Diagnostic& found) {
  return found.mark.line == expected.line && found.mark.column == expected.column &&
         found.id == expected.id && !expected.says.empty() &&
         found.text.find(expected.says) != std::string::npos;
}

void expect_exactly(const WrongFile& file) {
  const std::vector<core::Diagnostic> found = report(file);
  std::vector<Expected> expected = file.expected;
  std::sort(expected.begin(), expected.end(), [](const Expected& a, const Expected& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
  std::string wanted;
  for (const Expected& item : expected) {
    wanted += fmt::format("\n    {}:{} {}: ...{}...", item.line, item.column, item.id, item.says);
  }
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), found.begin(), found.end(), fits))
      << file.path.filename().string() << "\n  expected" << wanted << "\n  found"
      << describe(found);
  for (const core::Diagnostic& item : found) {
    const core::DiagnosticInfo* info = core::find_diagnostic_id(item.id);
    ASSERT_NE(info, nullptr) << item.id;
    EXPECT_EQ(info->severity, item.severity) << item.id;
  }
}

TEST(Mistakes, EachWrongFileGetsOneDiagnosticAtItsPlaceThatSaysWhatToDo) {
  const std::vector<WrongFile> files = wrong_files("one");
  EXPECT_GE(files.size(), 120U);
  for (const WrongFile& file : files) {
    EXPECT_EQ(file.expected.size(), 1U) << file.path;
    expect_exactly(file);
  }
}

TEST(Mistakes, FiveMistakesInAFileAreReportedInOnePass) {
  const std::vector<WrongFile> files = wrong_files("five");
  EXPECT_GE(files.size(), 20U);
  for (const WrongFile& file : files) {
    EXPECT_EQ(file.expected.size(), 5U) << file.path;
    expect_exactly(file);
  }
}

TEST(Mistakes, EveryIdInTheSourcesIsRegistered) {
  for (const auto& [id, file] : ids_in_sources(FOOTFALL_SOURCE_DIR)) {
    EXPECT_NE(core::find_diagnostic_id(id), nullptr)
        << "'" << id << "' in " << file << " is missing in core/diagnostics/ids.cc";
  }
}

TEST(Mistakes, EveryRegisteredIdIsUsedAndHasAWrongFile) {
  std::set<std::string> used, shown;
  for (const auto& [id, file] : ids_in_sources(FOOTFALL_SOURCE_DIR)) used.insert(id);
  for (const WrongFile& file : wrong_files("one")) shown.insert(file.expected.front().id);
  core::Diagnostics nothing_there;  // the one mistake that no file can show
  behaviors::load_behavior("no/such/file.yaml", {}, nothing_there);
  for (const core::Diagnostic& item : nothing_there.all()) shown.insert(item.id);
  for (const core::DiagnosticInfo& info : core::diagnostic_ids()) {
    const std::string id(info.id);
    EXPECT_TRUE(used.contains(id)) << "nothing reports '" << id << "'";
    EXPECT_TRUE(shown.contains(id))
        << "no file in tests/language/mistakes/one expects '" << id << "'";
  }
}

}  // namespace
}  // namespace footfall::tests
