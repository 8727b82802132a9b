#include "core/text/file_change.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace footfall::core {
namespace {

namespace fs = std::filesystem;

TEST(UnifiedDiff, ShowsThreeLinesAroundWhatChanges) {
  EXPECT_EQ(unified_diff("f", "1\n2\n3\n4\n5\n6\n7\n8\n9\n", "1\n2\n3\n4\nfive\n6\n7\n8\n9\n"),
            "--- f\n+++ f\n@@ -2,7 +2,7 @@\n 2\n 3\n 4\n-5\n+five\n 6\n 7\n 8\n");
  EXPECT_EQ(unified_diff("f", "same\n", "same\n"), "");
}

TEST(UnifiedDiff, JoinsWhatIsNoMoreThanSixLinesApart) {
  EXPECT_EQ(unified_diff("f", "a\n1\n2\n3\n4\n5\n6\nb\n", "A\n1\n2\n3\n4\n5\n6\nB\n"),
            "--- f\n+++ f\n@@ -1,8 +1,8 @@\n-a\n+A\n 1\n 2\n 3\n 4\n 5\n 6\n-b\n+B\n");
  EXPECT_EQ(unified_diff("f", "a\n1\n2\n3\n4\n5\n6\n7\nb\n", "A\n1\n2\n3\n4\n5\n6\n7\nB\n"),
            "--- f\n+++ f\n@@ -1,4 +1,4 @@\n-a\n+A\n 1\n 2\n 3\n"
            "@@ -6,4 +6,4 @@\n 5\n 6\n 7\n-b\n+B\n");
}

TEST(UnifiedDiff, ShowsNewFilesAndMissingLineEnds) {
  EXPECT_EQ(unified_diff("f", "", "a\nb\n", true),
            "--- /dev/null\n+++ f\n@@ -0,0 +1,2 @@\n+a\n+b\n");
  EXPECT_EQ(unified_diff("f", "a\nb", "a\nc"),
            "--- f\n+++ f\n@@ -1,2 +1,2 @@\n a\n-b\n\\ No newline at end of file\n+c\n"
            "\\ No newline at end of file\n");
  EXPECT_EQ(unified_diff("f", "a\n", "a\nb\n"), "--- f\n+++ f\n@@ -1 +1,2 @@\n a\n+b\n");
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// What `patch` makes of a text, strictly: every line must be where the diff's heads say.
std::string patched(const std::string& before, const std::string& diff) {
  const auto old = lines_of(before);
  std::string out;
  std::size_t at = 0, line_number = 1;
  const auto copy = [&] { out += old.at(at++) + "\n", ++line_number; };
  for (const std::string& line : lines_of(diff)) {
    if (line.starts_with("--- ") || line.starts_with("+++ ")) continue;
    if (line.starts_with("@@")) {
      int first = 0, count = 1, new_first = 0, new_count = 1;
      if (std::sscanf(line.c_str(), "@@ -%d,%d", &first, &count) < 1) return "bad head: " + line;
      const std::size_t plus = line.find('+');
      std::sscanf(line.c_str() + plus, "+%d,%d", &new_first, &new_count);
      while (at + (count == 0 ? 0 : 1) < static_cast<std::size_t>(first)) copy();
      if (line_number != static_cast<std::size_t>(new_first + (new_count == 0)))
        return "bad: " + line;
    } else if (line[0] == '+') {
      out += line.substr(1) + "\n", ++line_number;
    } else {
      if (old.at(at) != line.substr(1)) return "not there: " + line;
      if (line[0] == ' ')
        copy();
      else
        ++at;
    }
  }
  while (at < old.size()) copy();
  return out;
}

TEST(UnifiedDiff, LeadsFromOneTextToTheOther) {
  std::mt19937 random(3);
  const auto below = [&random](unsigned bound) { return static_cast<unsigned>(random()) % bound; };
  for (int k = 0; k < 3000; ++k) {
    std::string before, after;  // alike in most lines
    for (unsigned n = below(25); n > 0; --n) {
      const std::string line = std::string(1, static_cast<char>('a' + below(4))) + "\n";
      const unsigned what = below(8);
      if (what != 0) before += line;
      if (what != 1) after += what == 2 ? "x\n" : line;
    }
    EXPECT_EQ(patched(before, unified_diff("f", before, after)), after);
  }
}

class Folder : public testing::Test {
 protected:
  Folder() { fs::create_directories(path_); }
  ~Folder() override { fs::remove_all(path_); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string put(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }
  std::string get(const std::string& name) const {
    std::ifstream in(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path_), {}));
  }
  fs::path path_ =
      fs::temp_directory_path() / ("footfall_change_" + std::to_string(::getpid()) +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(Folder, WrittenFilesKeepModeAndLinks) {
  put("real", "old");
  ASSERT_EQ(::chmod(file("real").c_str(), 0640), 0);
  fs::create_symlink("real", file("link"));
  EXPECT_TRUE(
      write_changes({{file("link"), "old", "new", false}, {file("fresh"), "", "fresh\n", true}})
          .empty());
  EXPECT_EQ(get("real"), "new");
  EXPECT_TRUE(fs::is_symlink(file("link")));
  EXPECT_EQ(static_cast<int>(fs::status(file("real")).permissions()), 0640);
  EXPECT_EQ(get("fresh"), "fresh\n");
  EXPECT_EQ(count(), 3u);  // nothing is left beside them
}

TEST_F(Folder, NothingIsWrittenIfOneOfTheFilesHasChanged) {
  put("a", "old");
  put("b", "by now something else");
  const auto reasons =
      write_changes({{file("a"), "old", "new", false}, {file("b"), "old", "new", false}});
  ASSERT_EQ(reasons.size(), 1u);
  EXPECT_EQ(reasons[0], file("b") + ": it has changed meanwhile; nothing was written");
  EXPECT_EQ(get("a"), "old");
  EXPECT_EQ(get("b"), "by now something else");
  EXPECT_EQ(count(), 2u);
}

TEST_F(Folder, ANewFileTakesNobodysPlace) {
  put("a", "old");
  put("there", "somebody's");
  EXPECT_FALSE(
      write_changes({{file("a"), "old", "new", false}, {file("there"), "", "new", true}}).empty());
  EXPECT_EQ(get("a"), "old");
  EXPECT_EQ(get("there"), "somebody's");
  EXPECT_FALSE(write_changes({{file("no/such/folder/f"), "", "new", true}}).empty());
  EXPECT_FALSE(write_changes({{file("gone"), "old", "new", false}}).empty());
  EXPECT_EQ(count(), 2u);
}

}  // namespace
}  // namespace footfall::core
