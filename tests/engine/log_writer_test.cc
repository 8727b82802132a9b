// The log comes back as it was written, whole or cut at any byte, and twice the same.
#include "engine/log_writer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "engine/log_schema.h"
#include "engine/mcap_format.h"
#include "lab/log_reader.h"

namespace footfall::engine {
namespace {

constexpr int kRows = 2000;
constexpr std::int64_t kPeriod = 4'000'000;  // ns: 250 Hz

std::string temporary(const std::string& name) {
  return (std::filesystem::path(testing::TempDir()) /
          ("footfall_" + std::to_string(getpid()) + name))
      .string();
}

core::SignalTable small_table() {
  core::SignalTable table;
  table.add("time", core::kTime, "time since start");
  table.add("com.pos.z", core::kLength, "height of the centre of mass");
  table.add("com.pos_z", core::kLength, "another that would become the same field");
  for (int i = 0; i < 40; ++i) {
    std::string name = "s";
    name += std::to_string(i);
    table.add(name, core::kTorque, "a torque");
  }
  return table;
}

// What row `row` holds; exact in a float apart from the time, which is stored as double.
double expected(int row, int signal) {
  return signal == 0 ? row * 0.004 : 0.25 * row - signal + 0.5 * ((row * 7 + signal) % 13);
}

void write(const std::string& path, int rows = kRows) {
  core::SignalTable table = small_table();
  LogWriter log(path, table, {{{"behavior", "balance"}, {"seed", "7"}}});
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < table.size(); ++i) table[i] = expected(row, i);
    log.sample(row * kPeriod, table.values());
    if (row % 100 == 0) log.event(row * kPeriod, "mark", "step", "n " + std::to_string(row));
  }
  log.close();
}

std::string slurp(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Rows of a log that are as expected, all of them counted; fails the test on a wrong one.
std::size_t checked_rows(const lab::Log& log) {
  for (std::size_t row = 0; row < log.rows(); ++row) {
    EXPECT_DOUBLE_EQ(log.time[row], static_cast<double>(row) * 0.004);
    for (std::size_t i = 0; i < log.column.size(); ++i) {
      const auto want = static_cast<float>(expected(static_cast<int>(row), static_cast<int>(i)));
      if (log.column[i][row] != want) {
        ADD_FAILURE() << "row " << row << " signal " << i;
        return row;
      }
    }
  }
  return log.rows();
}

TEST(LogWriter, ALogComesBackAsItWasWritten) {
  const std::string path = temporary("whole.mcap");
  write(path);
  const lab::Log log = lab::read_log(path);
  EXPECT_TRUE(log.complete);
  EXPECT_EQ(log.get("behavior"), "balance");
  EXPECT_EQ(log.get("seed"), "7");
  ASSERT_EQ(log.signals.size(), 43U);
  EXPECT_EQ(log.signals[1].name, "com.pos.z");
  EXPECT_EQ(log.signals[1].field, "com_pos_z");
  EXPECT_EQ(log.signals[1].unit, "m");
  EXPECT_EQ(log.signals[1].doc, "height of the centre of mass");
  EXPECT_EQ(log.signals[2].field, "com_pos_z_2");
  EXPECT_EQ(checked_rows(log), static_cast<std::size_t>(kRows));
  ASSERT_EQ(log.events.size(), 20U);
  EXPECT_DOUBLE_EQ(log.events[3].time, 1.2);
  EXPECT_EQ(log.events[3].kind, "mark");
  EXPECT_EQ(log.events[3].name, "step");
  EXPECT_EQ(log.events[3].detail, "n 300");
}

TEST(LogWriter, ACutLogKeepsAllChunksBeforeTheCut) {
  const std::string path = temporary("uncut.mcap");
  write(path);
  const std::string bytes = slurp(path);
  const std::string cut_path = temporary("cut.mcap");
  std::size_t rows_before = 0;
  for (std::size_t size = 0; size < bytes.size(); size += 1000) {
    std::ofstream(cut_path, std::ios::binary) << bytes.substr(0, size);
    try {
      const lab::Log log = lab::read_log(cut_path);
      // The last eight bytes are the end's magic: only a cut behind them is a whole file.
      EXPECT_FALSE(log.complete) << size;
      const std::size_t rows = checked_rows(log);
      EXPECT_GE(rows, rows_before) << size;
      rows_before = rows;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(rows_before, 0U) << size << ": " << error.what();
      EXPECT_LT(size, 8000U) << "the head of the file ends before";
    }
  }
  EXPECT_EQ(rows_before, static_cast<std::size_t>(kRows));  // the cut fell into the summary
}

TEST(LogWriter, AKilledProcessLosesAtMostHalfASecond) {
  const std::string path = temporary("killed.mcap");
  core::SignalTable table = small_table();
  LogWriter log(path, table, {});
  for (int row = 0; row < 500; ++row) log.sample(row * kPeriod, table.values());
  // Not closed: what the kernel has is what a killed process leaves behind.
  const lab::Log so_far = lab::read_log(path);
  EXPECT_FALSE(so_far.complete);
  ASSERT_GT(so_far.rows(), 0U);
  EXPECT_GE(so_far.time.back(), 499 * 0.004 - 0.5);
}

TEST(LogWriter, ADamagedChunkEndsTheLogThere) {
  const std::string path = temporary("damaged.mcap");
  write(path);
  std::string bytes = slurp(path);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  std::ofstream(path, std::ios::binary) << bytes;
  const lab::Log log = lab::read_log(path);
  EXPECT_LT(checked_rows(log), static_cast<std::size_t>(kRows));
}

TEST(LogWriter, TwoEqualRunsGiveEqualFiles) {
  write(temporary("a.mcap"));
  write(temporary("b.mcap"));
  EXPECT_EQ(slurp(temporary("a.mcap")), slurp(temporary("b.mcap")));
}

TEST(LogWriter, AnEventWithALongTextIsCutBetweenCharacters) {
  const std::string path = temporary("long.mcap");
  core::SignalTable table = small_table();
  std::string text = "x";
  for (int i = 0; i < 5000; ++i) text += "\u00e4";
  LogWriter log(path, table, {});
  log.event(0, "mark", "", text);
  log.close();
  const lab::Log back = lab::read_log(path);
  ASSERT_EQ(back.events.size(), 1U);
  EXPECT_EQ(back.events[0].detail, text.substr(0, 4095));
}

TEST(LogWriter, NoRightsToWriteIsOneSentenceWithThePath) {
  core::SignalTable table = small_table();
  try {
    LogWriter log("/no/such/folder/log.mcap", table, {});
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "cannot create the log '/no/such/folder/log.mcap': No such file or directory");
  }
}

TEST(LogReader, WhatIsNotALogIsOneSentenceWithThePath) {
  const std::string path = temporary("text.mcap");
  std::ofstream(path) << "hello, this is not a log";
  const auto message = [](const std::string& file) -> std::string {
    try {
      lab::read_log(file);
      return "no error";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message(path), "'" + path + "' is not a log of Footfall (an MCAP file was expected)");
  EXPECT_EQ(message("/no/log.mcap"),
            "cannot read the log '/no/log.mcap': No such file or directory");
  EXPECT_EQ(message(testing::TempDir()),
            "cannot read the log '" + testing::TempDir() + "': Is a directory");
}

TEST(Crc32, AgreesWithThePublishedCheckValue) {
  // Check value of CRC-32/ISO-HDLC in every catalogue: crc("123456789") = cbf43926.
  const std::string nine = "123456789";
  const std::vector<std::uint8_t> bytes(nine.begin(), nine.end());
  EXPECT_EQ(crc32(bytes), 0xCBF43926U);
  EXPECT_EQ(crc32(std::span(bytes).subspan(4), crc32(std::span(bytes).first(4))), 0xCBF43926U);
}

TEST(LogSchema, ASmallDescriptorIsWhatProtocWrites) {
  core::SignalTable table;
  table.add("a.b", core::kLength, "");
  // Hand-encoded by the rules of descriptor.proto: file{name, package, message{name, field},
  // syntax}.
  const std::string field = std::string("\x0a\x03") + "a_b" + "\x18\x01\x20\x01\x28\x02";
  const std::string message =
      std::string("\x0a\x07") + "Signals" + "\x12" + static_cast<char>(field.size()) + field;
  const std::string file = std::string("\x0a\x16") + "footfall/signals.proto" + "\x12\x08" +
                           "footfall" + "\x22" + static_cast<char>(message.size()) + message +
                           "\x62\x06" + "proto3";
  const std::string want = std::string("\x0a") + static_cast<char>(file.size()) + file;
  const std::vector<std::uint8_t> got = signals_descriptor(table);
  EXPECT_EQ(std::string(got.begin(), got.end()), want);
}

}  // namespace
}  // namespace footfall::engine
