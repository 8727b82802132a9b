// The log comes back as it was written, whole or cut at any byte, and twice the same.
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "engine/log/mcap_format.h"
#include "engine/log/schema.h"
#include "engine/log/writer.h"
#include "engine/tick/input_row.h"
#include "lab/log/mcap.h"
#include "lab/log/reader.h"
#include "tests/support/allocation_guard.h"

namespace footfall::engine {
namespace {

using tests::AllocationGuard;

constexpr int kTicks = 3000;
constexpr double kPeriod = 1e-3;
constexpr int kEvery = 4;       // ticks from row to row
constexpr int kLookBack = 200;  // 0.2 s in ticks

std::string temporary(const std::string& name) {
  return (std::filesystem::path(testing::TempDir()) /
          ("footfall_" + std::to_string(getpid()) + name))
      .string();
}

core::SignalTable small_table() {
  core::SignalTable table;
  table.add("time", core::kTime, "time since start");
  table.add("com.pos.z", core::kLength, "height of the centre of mass");
  for (int i = 0; i < 41; ++i) {
    std::string name = "s";
    name += std::to_string(i);
    table.add(name, core::kTorque, "a torque");
  }
  return table;
}

LogHeader small_header() {
  LogHeader header;
  header.run = {{"behavior", "balance"}, {"seed", "7"}};
  header.setup = "{}";
  header.events = {"start", "stop"};
  header.files = {{"/a/b.yaml", "application/yaml", "behavior: 1\n"}};
  header.parameters = {{"goal", 0, 2}, {"height", 2, 1}};
  header.values = {0.1, -0.0, 0.91};
  header.names.joints = {"hip", "knee"};
  header.names.contacts = {"foot"};
  header.rate_mhz = 1'000'000;
  header.row_every = kEvery;
  return header;
}

// What a tick holds.
double expected(std::int64_t tick, int signal) {
  if (signal == 0) return static_cast<double>(tick) * kPeriod;
  return std::sin(0.01 * static_cast<double>(tick) + signal) * (signal + 1) / 3.0;
}

hal::Sensors sensors_at(std::int64_t tick) {
  hal::Sensors s;
  s.time_ns = tick * 1'000'000 + 17;
  s.q[0] = expected(tick, 100);
  s.qd[1] = expected(tick, 101);
  s.tau[0] = expected(tick - 1, 102);
  s.gyro[2] = std::nextafter(expected(tick, 103), 9.0);
  s.accelerometer[0] = tick % 10 == 3 ? std::nan("") : 9.81;
  s.contact[0] = tick % 3 == 0;
  s.force[0] = {0.0, -0.0, expected(tick, 104)};
  s.has_truth = true;
  s.p_WB = {expected(tick, 105), 1e-310, 3.0};
  s.body_contact = tick == 77;
  s.backend_fault = tick == 78;
  return s;
}

hal::Commands commands_at(std::int64_t tick) {
  hal::Commands c;
  c.tau[0] = expected(tick, 102);
  return c;
}

bool fresh_at(std::int64_t tick) { return tick % 11 != 5; }
bool highlight_at(std::int64_t tick) { return tick == 1500 || tick == 1530 || tick == 2990; }

void write_tick(LogWriter& log, core::SignalTable& table, std::int64_t tick) {
  for (int i = 0; i < table.size(); ++i) table[i] = expected(tick, i);
  if (tick % 100 == 0 && tick >= 0) log.event(tick, "mark", "step", "n " + std::to_string(tick));
  InputTrace trace;
  if (tick == 40) {
    trace.writes = {{1, 0.3}, {0, -0.0}};
    trace.events = {1, 0};
  }
  if (tick % 50 == 7) {
    trace.plans = {
        {0, static_cast<std::uint32_t>(tick), true, {0.1, 1e-3 / 3.0, 0.0}, {1, 2}, {3, 4}, 0.25}};
  }
  log.inputs(tick, trace);
  log.tick(tick, sensors_at(tick), fresh_at(tick), commands_at(tick), table.values(),
           highlight_at(tick));
}

void write(const std::string& path, int ticks = kTicks) {
  core::SignalTable table = small_table();
  LogWriter log(path, table, small_header());
  for (std::int64_t tick = -1; tick < ticks; ++tick) write_tick(log, table, tick);
  log.close();
}

std::string slurp(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Rows of a log that are as expected, all of them counted; fails the test on a wrong one.
std::size_t checked_rows(const lab::Log& log) {
  for (std::size_t row = 0; row < log.rows(); ++row) {
    EXPECT_DOUBLE_EQ(log.time[row], static_cast<double>(log.tick[row]) * kPeriod);
    for (std::size_t i = 0; i < log.column.size(); ++i) {
      const auto want = static_cast<float>(expected(log.tick[row], static_cast<int>(i)));
      if (log.column[i][row] != want) {
        ADD_FAILURE() << "row " << row << " signal " << i;
        return row;
      }
    }
  }
  return log.rows();
}

// Ticks whose inputs, commands and digests are as expected, bit for bit; all of them counted.
std::int64_t checked_inputs(const lab::Log& log) {
  const InputLayout layout(log.inputs.names);
  EXPECT_EQ(layout.names(), log.inputs.columns);
  core::SignalTable table = small_table();
  std::vector<std::uint64_t> want(static_cast<std::size_t>(layout.columns()));
  for (std::int64_t k = 0; k < log.inputs.ticks(); ++k) {
    const std::int64_t tick = log.inputs.first_tick + k;
    layout.pack(sensors_at(tick), fresh_at(tick), commands_at(tick), want.data());
    for (int i = 0; i < table.size(); ++i) table[i] = expected(tick, i);
    const bool same =
        std::equal(want.begin(), want.end(), log.inputs.row(tick)) &&
        log.inputs.digest[static_cast<std::size_t>(k)] == digest(table.values(), table.size());
    if (!same) {
      ADD_FAILURE() << "tick " << tick;
      return k;
    }
  }
  return log.inputs.ticks();
}

TEST(LogWriter, ALogComesBackAsItWasWritten) {
  const std::string path = temporary("whole.mcap");
  write(path);
  const lab::Log log = lab::read_log(path, {.all_rows = false, .inputs = true});
  EXPECT_TRUE(log.complete);
  EXPECT_EQ(log.get("behavior"), "balance");
  EXPECT_EQ(log.get("seed"), "7");
  ASSERT_EQ(log.signals.size(), 43U);
  EXPECT_EQ(log.signals[1].name, "com.pos.z");
  EXPECT_EQ(log.signals[1].unit, "m");
  EXPECT_EQ(log.signals[1].doc, "height of the centre of mass");
  EXPECT_EQ(checked_rows(log), static_cast<std::size_t>(kTicks / kEvery));
  EXPECT_EQ(log.inputs.first_tick, -1);
  EXPECT_EQ(checked_inputs(log), kTicks + 1);
  ASSERT_EQ(log.events.size(), 30U);
  EXPECT_DOUBLE_EQ(log.events[3].time, 0.3);
  EXPECT_EQ(log.events[3].tick, 300);
  EXPECT_EQ(log.events[3].kind, "mark");
  EXPECT_EQ(log.events[3].name, "step");
  EXPECT_EQ(log.events[3].detail, "n 300");
}

TEST(LogWriter, WhatAReplayNeedsComesBackBitForBit) {
  const std::string path = temporary("replay.mcap");
  write(path, 100);
  const lab::Log log = lab::read_log(path);
  ASSERT_EQ(log.edits.size(), 1U);
  EXPECT_EQ(log.edits[0].tick, 40);
  ASSERT_EQ(log.edits[0].writes.size(), 2U);
  EXPECT_EQ(log.edits[0].writes[0], (std::pair<int, double>(1, 0.3)));
  EXPECT_TRUE(std::signbit(log.edits[0].writes[1].second));
  EXPECT_EQ(log.edits[0].events, (std::vector<int>{1, 0}));
  ASSERT_EQ(log.plans.size(), 2U);
  EXPECT_EQ(log.plans[1].tick, 57);
  EXPECT_EQ(log.plans[1].sequence, 57U);
  EXPECT_EQ(log.plans[1].target[1], 1e-3 / 3.0);
  EXPECT_EQ(log.plans[1].extension, 0.25);
  ASSERT_EQ(log.parameters.size(), 2U);
  EXPECT_EQ(log.parameters[1].name, "height");
  EXPECT_EQ(log.parameter_values[2], 0.91);
  EXPECT_TRUE(std::signbit(log.parameter_values[1]));
  ASSERT_EQ(log.files.size(), 1U);
  EXPECT_EQ(log.files[0].path, "/a/b.yaml");
  EXPECT_EQ(log.files[0].content, "behavior: 1\n");
  EXPECT_EQ(log.event_names[1], "stop");
}

// Full rate from 0.2 s before to 0.2 s after each highlight, else every fourth tick; in the order
// of time, none twice.
TEST(LogWriter, RowsAreDenseAroundHighlightsOnly) {
  const std::string path = temporary("dense.mcap");
  write(path);
  const lab::Log log = lab::read_log(path, {.all_rows = true, .inputs = false});
  std::vector<std::int64_t> want;
  for (std::int64_t tick = 0; tick < kTicks; ++tick) {
    bool wanted = tick % kEvery == 0;
    for (const std::int64_t center : {1500, 1530, 2990}) {
      wanted |= std::abs(tick - center) <= kLookBack;
    }
    if (wanted) want.push_back(tick);
  }
  EXPECT_EQ(log.tick, want);
  EXPECT_EQ(checked_rows(log), want.size());
}

TEST(LogWriter, ACutLogKeepsAllChunksBeforeTheCut) {
  const std::string path = temporary("uncut.mcap");
  write(path);
  const std::string bytes = slurp(path);
  const std::string cut_path = temporary("cut.mcap");
  std::int64_t ticks_before = 0;
  for (std::size_t size = 0; size < bytes.size(); size += 9973) {
    std::ofstream(cut_path, std::ios::binary) << bytes.substr(0, size);
    try {
      const lab::Log log = lab::read_log(cut_path, {.all_rows = true, .inputs = true});
      // The last eight bytes are the end's magic: only a cut behind them is a whole file.
      EXPECT_FALSE(log.complete) << size;
      checked_rows(log);
      const std::int64_t ticks = checked_inputs(log);
      EXPECT_GE(ticks, ticks_before) << size;
      ticks_before = ticks;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(ticks_before, 0) << size << ": " << error.what();
      EXPECT_LT(size, 12000U) << "the head of the file ends before";
    }
  }
  EXPECT_GE(ticks_before, kTicks - 100);
}

// Two batches of 50 ms: what the kernel has is what a killed process leaves behind.
TEST(LogWriter, AKilledProcessLosesAtMostATenthOfASecond) {
  const std::string path = temporary("killed.mcap");
  core::SignalTable table = small_table();
  LogWriter log(path, table, small_header());
  for (std::int64_t tick = -1; tick < 500; ++tick) {
    write_tick(log, table, tick);
    if (tick % 83 != 0) continue;
    const lab::Log so_far = lab::read_log(path, {.all_rows = true, .inputs = true});
    EXPECT_FALSE(so_far.complete);
    EXPECT_GE(so_far.inputs.first_tick + so_far.inputs.ticks(), tick - 100) << tick;
  }
}

TEST(LogWriter, ADamagedChunkEndsTheLogThere) {
  const std::string path = temporary("damaged.mcap");
  write(path);
  std::string bytes = slurp(path);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  std::ofstream(path, std::ios::binary) << bytes;
  const lab::Log log = lab::read_log(path, {.all_rows = false, .inputs = true});
  EXPECT_FALSE(log.complete);
  checked_rows(log);
  EXPECT_LT(checked_inputs(log), kTicks);
}

TEST(LogWriter, ATickAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  core::SignalTable table = small_table();
  LogWriter log(temporary("allocations.mcap"), table, small_header());
  InputTrace trace;
  trace.writes = {{1, 0.3}};
  trace.plans.resize(2);
  const hal::Sensors sensors = sensors_at(1);
  for (std::int64_t tick = -1; tick < 200; ++tick) {
    log.tick(tick, sensors, true, {}, table.values(), tick % 50 == 0);
  }
  const AllocationGuard guard;
  for (std::int64_t tick = 200; tick < 2000; ++tick) {
    log.inputs(tick, trace);
    log.event(tick, "mark", "step", "x");
    log.tick(tick, sensors, true, {}, table.values(), tick % 50 == 0);
  }
  EXPECT_EQ(guard.allocations(), 0);
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
  LogWriter log(path, table, small_header());
  log.event(0, "mark", "", text);
  log.close();
  const lab::Log back = lab::read_log(path);
  ASSERT_EQ(back.events.size(), 1U);
  EXPECT_EQ(back.events[0].detail, text.substr(0, 4095));
}

TEST(LogWriter, NoRightsToWriteIsOneSentenceWithThePath) {
  core::SignalTable table = small_table();
  try {
    LogWriter log("/no/such/folder/log.mcap", table, small_header());
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

// Read back by hand, by the rules of descriptor.proto: file {name 1, package 2, message 4, syntax
// 12}, message {name 1, field 2}, field {name 1, number 3, label 4, type 5}.
TEST(LogSchema, NamesEveryMessageOfTheLog) {
  const std::vector<std::uint8_t> bytes = log_descriptor_set();
  lab::Cursor set(bytes);
  lab::Cursor file(lab::next_field(set).bytes);
  EXPECT_TRUE(set.empty());
  std::vector<std::string> messages;
  std::string digest_field;
  while (!file.empty()) {
    const lab::ProtoField field = lab::next_field(file);
    if (field.number == 2 || field.number == 12) {
      EXPECT_EQ(field.text(), field.number == 2 ? "footfall" : "proto3");
    }
    if (field.number != 4) continue;
    lab::Cursor message(field.bytes);
    messages.push_back(lab::next_field(message).text());
    while (messages.back() == "InputBlock" && !message.empty()) {
      lab::Cursor last(lab::next_field(message).bytes);
      digest_field = lab::next_field(last).text();
      std::vector<std::uint64_t> numbers;
      while (!last.empty()) numbers.push_back(lab::next_field(last).integer);
      // fixed64 is type 6, repeated is label 3.
      if (message.empty()) {
        EXPECT_EQ(numbers, (std::vector<std::uint64_t>{5, 3, 6}));
      }
    }
  }
  EXPECT_EQ(digest_field, "digest");
  EXPECT_EQ(messages, (std::vector<std::string>{"InputBlock", "SignalBlock", "Event", "PlanBlock",
                                                "Edit", "Parameters"}));
}

TEST(Digest, ChangesWithAnyBit) {
  std::vector<double> values(219, 0.5);
  const std::uint64_t whole = digest(values.data(), 219);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const int bit : {0, 31, 52, 63}) {
      values[i] =
          std::bit_cast<double>(std::bit_cast<std::uint64_t>(0.5) ^ std::uint64_t{1} << bit);
      EXPECT_NE(digest(values.data(), 219), whole) << i << " " << bit;
    }
    values[i] = 0.5;
  }
}

}  // namespace
}  // namespace footfall::engine
