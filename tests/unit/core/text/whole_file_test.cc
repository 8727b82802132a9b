#include "core/text/whole_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace footfall::core {
namespace {

namespace fs = std::filesystem;

class WholeFile : public testing::Test {
 protected:
  WholeFile() { fs::create_directories(path_); }
  ~WholeFile() override { fs::remove_all(path_); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::ptrdiff_t count() const { return std::distance(fs::directory_iterator(path_), {}); }
  static std::string refusal(const std::string& path, const std::string& text) {
    try {
      write_whole_file(path, text);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  fs::path path_ =
      fs::temp_directory_path() / ("footfall_whole_" + std::to_string(::getpid()) +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(WholeFile, ReturnsEveryByteThatWasWritten) {
  std::string text("a\0b\r\n\xff", 6);
  while (text.size() < 100'000) text += text;
  write_whole_file(file("f"), text);
  EXPECT_EQ(read_whole_file(file("f")), text);
  write_whole_file(file("f"), "");
  EXPECT_EQ(read_whole_file(file("f")), "");
  EXPECT_EQ(count(), 1);
}

TEST_F(WholeFile, KeepsTheModeOfTheOldFileAndTheLinkToIt) {
  write_whole_file(file("real"), "old");
  ASSERT_EQ(::chmod(file("real").c_str(), 0640), 0);
  fs::create_symlink("real", file("link"));
  write_whole_file(file("link"), "new");
  EXPECT_TRUE(fs::is_symlink(file("link")));
  EXPECT_EQ(read_whole_file(file("real")), "new");
  EXPECT_EQ(static_cast<int>(fs::status(file("real")).permissions()), 0640);
}

TEST_F(WholeFile, NamesThePathAndTheReasonOfAFailure) {
  EXPECT_EQ(refusal(path_.string(), "x"), path_.string() + ": cannot write: Is a directory");
  EXPECT_EQ(refusal(file("no/such/f"), "x"),
            file("no/such/f") + ": cannot write: No such file or directory");
  try {
    read_whole_file(file("gone"));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), file("gone") + ": cannot read: No such file or directory");
  }
}

// A disk that fills up, by the limit on the size of a file.
TEST_F(WholeFile, LeavesTheOldFileIntactWhenTheNewOneCannotBeWritten) {
  write_whole_file(file("f"), "old");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small = {1000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string reason = refusal(file("f"), std::string(5000, 'x'));
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(reason, file("f") + ": cannot write: File too large");
  EXPECT_EQ(read_whole_file(file("f")), "old");
  EXPECT_EQ(count(), 1);
}

// As root, who may rename over a device: /dev/full would be a file from then on.
TEST_F(WholeFile, APipeIsWrittenIntoAndStaysAPipe) {
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0600), 0);
  const int reader = ::open(file("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  write_whole_file(file("pipe"), "text");
  char got[5] = {};
  EXPECT_EQ(::read(reader, got, 4), 4);
  EXPECT_STREQ(got, "text");
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(file("pipe")));
  EXPECT_THROW(StagedFile(file("pipe"), "text"), std::runtime_error);
  EXPECT_TRUE(fs::is_fifo(file("pipe")));
  EXPECT_EQ(count(), 1);
}

TEST_F(WholeFile, ANewFileNeverTakesThePlaceOfAnother) {
  {
    StagedFile staged(file("f"), "mine");
    EXPECT_EQ(count(), 1);  // beside, not there
    EXPECT_FALSE(fs::exists(file("f")));
    std::ofstream(file("f")) << "theirs";
    EXPECT_THROW(staged.create(), std::runtime_error);
  }
  EXPECT_EQ(read_whole_file(file("f")), "theirs");
  EXPECT_EQ(count(), 1);
}

}  // namespace
}  // namespace footfall::core
