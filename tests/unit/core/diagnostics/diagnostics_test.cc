// Problems read like a compiler's, in the order of the file, and suggest what was meant.
#include "core/diagnostics/diagnostics.h"

#include <gtest/gtest.h>

#include "core/diagnostics/did_you_mean.h"

namespace footfall::core {
namespace {

TEST(DiagnosticsTest, ProblemsAreSortedByFileAndPlace) {
  Diagnostics diagnostics;
  const int a = diagnostics.add_file("a.yaml");
  const int b = diagnostics.add_file("b.yaml");
  EXPECT_EQ(diagnostics.add_file("a.yaml"), a);
  diagnostics.error({b, 2, 1}, "x", "third");
  diagnostics.error({a, 7, 3}, "x", "second");
  diagnostics.warning({a, 7, 1}, "x", "first");
  diagnostics.error({b, 0, 0}, "x", "of the whole file");
  EXPECT_EQ(diagnostics.to_string(),
            "a.yaml:7:1: warning: first\n"
            "a.yaml:7:3: error: second\n"
            "b.yaml: error: of the whole file\n"
            "b.yaml:2:1: error: third\n");
  EXPECT_EQ(diagnostics.error_count(), 3);
  EXPECT_TRUE(diagnostics.has_errors());
}

TEST(DiagnosticsTest, WarningsAreNoErrors) {
  Diagnostics diagnostics;
  diagnostics.warning({}, "x", "only a warning");
  EXPECT_FALSE(diagnostics.has_errors());
  EXPECT_EQ(diagnostics.to_string(), "warning: only a warning\n");
}

TEST(DiagnosticsTest, AProblemStaysOneLineAndIsToldOnce) {
  Diagnostics diagnostics;
  const int file = diagnostics.add_file("a.yaml");
  diagnostics.error({file, 1, 1}, "x", "no '\n\x1b[31m'");
  diagnostics.error({file, 1, 1}, "x", "no '\n\x1b[31m'");
  EXPECT_EQ(diagnostics.to_string(), "a.yaml:1:1: error: no '\\x0a\\x1b[31m'\n");
}

TEST(DiagnosticsTest, TheNearestNameIsSuggestedIfItIsNearEnough) {
  const std::vector<std::string> names = {"height", "attitude", "swing", "x"};
  EXPECT_EQ(nearest_name("heigth", names), "height");  // a swap of neighbours is one edit
  EXPECT_EQ(nearest_name("hight", names), "height");
  EXPECT_EQ(nearest_name("atitude", names), "attitude");
  EXPECT_EQ(did_you_mean("swnig", names), " (did you mean 'swing'?)");
  EXPECT_EQ(did_you_mean("gravity", names), "");
  EXPECT_EQ(nearest_name("y", names), "");  // every letter is near to x: no guess
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name(std::string(1'000'000, 'a'), names), "");
}

}  // namespace
}  // namespace footfall::core
