// Changed files are told once they have settled; what only looks changed is not.
#include "engine/realtime/file_watch.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

namespace footfall::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr double kInterval = 0.02;  // s

class Watched : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("footfall_watch_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  // Until it was told so often, at most 5 s.
  bool told(int times) const {
    for (int k = 0; k < 500 && told_ < times; ++k) std::this_thread::sleep_for(10ms);
    return told_ == times;
  }

  fs::path folder_;
  std::atomic<int> told_{0};
};

TEST_F(Watched, AChangeIsToldOnceItHasSettled) {
  write("a", "one");
  write("b", "one");
  std::string read;  // the first time; told_ hands it over
  engine::FileWatch watch({path("a"), path("b")}, kInterval, [&] {
    if (told_ == 0) std::ifstream(path("a")) >> read;
    ++told_;
    return std::vector<std::string>{path("a"), path("b")};
  });
  std::ofstream out(path("a"), std::ios::binary);
  for (const char* part : {"t", "w", "o"}) {  // quicker than it looks
    out << part << std::flush;
    std::this_thread::sleep_for(1ms);
  }
  out.close();
  EXPECT_TRUE(told(1));
  EXPECT_EQ(read, "two");
  fs::last_write_time(path("b"), fs::last_write_time(path("b")) + 1h);  // the same content
  std::this_thread::sleep_for(8 * 20ms);
  EXPECT_TRUE(told(1));
  fs::remove(path("b"));
  EXPECT_TRUE(told(2));
  write("b", "one");
  EXPECT_TRUE(told(3));
}

TEST_F(Watched, EachLookIsToldToo) {
  write("a", "one");
  std::atomic<int> looks{0};
  engine::FileWatch watch(
      {path("a")}, kInterval, [&] { return std::vector<std::string>{path("a")}; },
      [&] { ++looks; });
  for (int k = 0; k < 500 && looks < 3; ++k) std::this_thread::sleep_for(10ms);
  EXPECT_GE(looks, 3);
}

// Many editors empty a file before they fill it.
TEST_F(Watched, AnEmptyFileIsGivenTimeToBeFilled) {
  write("a", "one");
  engine::FileWatch watch({path("a")}, kInterval, [&] {
    ++told_;
    return std::vector<std::string>{path("a")};
  });
  write("a", "");
  std::this_thread::sleep_for(3 * 20ms);
  EXPECT_EQ(told_, 0);
  EXPECT_TRUE(told(1));  // it stays empty: that is what was meant
  write("a", "two");
  EXPECT_TRUE(told(2));
}

TEST_F(Watched, WhatTheChangeNamedIsWatchedFromThenOn) {
  write("a", "one");
  write("c", "one");
  engine::FileWatch watch({path("a")}, kInterval, [&] {
    ++told_;
    return std::vector<std::string>{path("a"), path("c")};
  });
  write("a", "two");
  EXPECT_TRUE(told(1));
  std::this_thread::sleep_for(8 * 20ms);  // it has looked at the new one
  write("c", "two");
  EXPECT_TRUE(told(2));
}

}  // namespace
}  // namespace footfall::tests
