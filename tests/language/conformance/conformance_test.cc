// Runs the cases of the files given: conformance_test FILE.yaml... Each case is a chart, a script
// and the lines that `footfall trace` prints for it (active atomic states in document order), or
// the error that the chart is refused with. `why` names the clause that the lines follow from.
#include <gtest/gtest.h>

#include <cctype>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/yaml/value_reader.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

struct Case {
  std::string name, why, chart, events, script, error;
  Lines lines;
};

class ConformanceTest : public testing::Test {
 public:
  explicit ConformanceTest(Case given) : case_(std::move(given)) {}
  void TestBody() override {
    core::Diagnostics diagnostics;
    const std::string text = "behavior: 1\n" + case_.chart;
    const auto behavior =
        behaviors::load_behavior_text(text, "chart", options_for_tests(), diagnostics);
    if (!case_.error.empty()) {
      EXPECT_EQ(behavior, nullptr);
      EXPECT_NE(diagnostics.to_string().find(case_.error), std::string::npos)
          << diagnostics.to_string();
      return;
    }
    ASSERT_NE(behavior, nullptr) << diagnostics.to_string();
    EXPECT_EQ(trace_of(*behavior, steps()), case_.lines) << case_.why << "\n" << case_.chart;
  }

 private:
  std::vector<behaviors::TraceStep> steps() const {
    if (case_.script.empty()) return behaviors::trace_events(case_.events);
    core::Diagnostics diagnostics;
    const auto script = behaviors::load_trace_script_text(case_.script, "script", diagnostics);
    if (!script) throw std::runtime_error(diagnostics.to_string());
    return *script;
  }
  Case case_;
};

// "a parent's transition" as AParentsTransition.
std::string test_name(const std::string& sentence) {
  std::string name;
  bool upper = true;
  for (const char c : sentence) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      name += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
      upper = false;
    } else {
      upper = upper || c != '\'';
    }
  }
  return name;
}

std::vector<Case> read_cases(const std::string& path) {
  core::Diagnostics diagnostics;
  const core::YamlNode root = core::load_yaml_file(path, diagnostics);
  std::vector<Case> cases;
  const core::YamlNode* list = root.find("cases");
  if (list == nullptr) throw std::runtime_error(path + ": no cases\n" + diagnostics.to_string());
  for (const core::YamlNode& node : list->items) {
    core::check_keys(node, {"name", "why", "chart", "events", "script", "trace", "error"},
                     diagnostics);
    const auto text = [&](const char* key) {
      const core::YamlNode* value = node.find(key);
      return value == nullptr ? std::string() : value->scalar;
    };
    Case c{text("name"),  text("why"), text("chart"), text("events"), text("script"),
           text("error"), {}};
    if (const core::YamlNode* trace = node.find("trace")) {
      for (const core::YamlNode& line : trace->items) c.lines.push_back(line.scalar);
    }
    if (c.name.empty() || c.why.empty() || c.lines.empty() == c.error.empty()) {
      diagnostics.error(node.mark, "expected",
                        "a case needs a name, a why, and a trace or an error");
    }
    cases.push_back(std::move(c));
  }
  if (diagnostics.has_errors()) throw std::runtime_error(diagnostics.to_string());
  return cases;
}

void register_cases(const std::string& path) {
  const std::string file = path.substr(path.find_last_of('/') + 1);
  const std::string suite = test_name(file.substr(0, file.find('.')));
  for (const Case& c : read_cases(path)) {
    testing::RegisterTest(suite.c_str(), test_name(c.name).c_str(), nullptr, nullptr, path.c_str(),
                          1, [c]() -> testing::Test* { return new ConformanceTest(c); });
  }
}

}  // namespace
}  // namespace footfall::tests

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  try {
    for (int k = 1; k < argc; ++k) footfall::tests::register_cases(argv[k]);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "%s\n", problem.what());
    return 2;
  }
  if (argc < 2) {
    std::fprintf(stderr, "usage: conformance_test FILE.yaml...\n");
    return 2;
  }
  return RUN_ALL_TESTS();
}
