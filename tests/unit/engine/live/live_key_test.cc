// Key files: made whole, once, for their owner alone; refused with a reason else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "engine/live/key.h"

namespace footfall::engine {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class LiveKeys : public testing::Test {
 protected:
  LiveKeys() {
    std::string name = (fs::temp_directory_path() / "footfall-key-XXXXXX").string();
    folder = ::mkdtemp(name.data());
    ::setenv("XDG_RUNTIME_DIR", folder.c_str(), 1);
  }
  ~LiveKeys() override {
    ::unsetenv("XDG_RUNTIME_DIR");
    fs::remove_all(folder);
  }
  std::string file(const std::string& text, mode_t mode = 0600) const {
    const std::string path = folder + "/some.key";
    std::ofstream(path) << text;
    ::chmod(path.c_str(), mode);
    return path;
  }
  static std::string problem(const std::string& path) {
    try {
      read_key(path);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  std::string folder;
};

TEST_F(LiveKeys, AKeyIsReadAsItWasWritten) {
  const std::string digits = "000102030405060708090a0b0c0d0e0f101112131415161718191A1B1C1D1E1F";
  LiveKey expected{};
  for (std::size_t k = 0; k < expected.size(); ++k) expected[k] = static_cast<std::uint8_t>(k);
  EXPECT_EQ(read_key(file(digits + "\n")), expected);
  EXPECT_EQ(read_key(file(digits)), expected);
}

TEST_F(LiveKeys, OnlyItsOwnerMayReadIt) {
  make_key(folder + "/a/b/new.key");
  struct stat facts {};
  ASSERT_EQ(::stat((folder + "/a/b/new.key").c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777, 0600U);
  ASSERT_EQ(::stat((folder + "/a/b").c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777, 0700U);
  for (const mode_t mode : {0640, 0604, 0620, 0602, 0666}) {
    const std::string path = file(std::string(64, 'a'), mode);
    EXPECT_EQ(problem(path), path +
                                 ": error: others than its owner may read or write this key: "
                                 "chmod 600 '" +
                                 path + "'");
  }
}

TEST_F(LiveKeys, WhatIsNoKeyIsRefused) {
  for (const std::string& text :
       {std::string(), std::string(63, 'a'), std::string(65, 'a'), std::string(63, 'a') + "g",
        std::string(64, 'a') + "\n\n", std::string(64, 'a') + " ",
        std::string(32, 'a') + "\n" + std::string(32, 'a')}) {
    EXPECT_THAT(problem(file(text)), HasSubstr("expected a key of 64 hexadecimal digits")) << text;
  }
  EXPECT_THAT(problem(folder), HasSubstr("expected a file"));
  EXPECT_EQ(problem(folder + "/none"), folder + "/none: error: no such file; `footfall tune key " +
                                           folder + "/none` makes a key");
}

TEST_F(LiveKeys, AFileThatIsThereIsNotOverwritten) {
  const std::string path = file("precious");
  EXPECT_THROW(make_key(path), std::runtime_error);
  std::string text;
  std::ifstream(path) >> text;
  EXPECT_EQ(text, "precious");
}

TEST_F(LiveKeys, TheUsersOwnIsMadeOnceForAllThatBeginTogether) {
  std::vector<LiveKey> keys(8);
  std::vector<std::thread> beginners;
  for (LiveKey& key : keys) beginners.emplace_back([&key] { key = default_key(); });
  for (std::thread& beginner : beginners) beginner.join();
  for (const LiveKey& key : keys) EXPECT_EQ(key, keys[0]);
  EXPECT_NE(keys[0], LiveKey{});
  EXPECT_EQ(read_key(folder + "/footfall/lcm.key"), keys[0]);
  // Nothing but the key is left.
  EXPECT_EQ(std::distance(fs::directory_iterator(folder + "/footfall"), fs::directory_iterator()),
            1);
}

}  // namespace
}  // namespace footfall::engine
