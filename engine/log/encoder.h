// The part of the log outside the tick: encodes batches of ticks as messages and writes them to the
// file. writer.h gives an overview, docs/log.md the format.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/log/column_codec.h"
#include "engine/log/mcap_writer.h"
#include "engine/log/writer.h"
#include "engine/tick/input_row.h"

namespace footfall::engine {

enum class LogChannel : std::uint16_t { inputs = 1, signals, events, plans, edits, parameters };

// Columns of a planner's answer: tick, planner, sequence, ok (integers), target x y z,
// predicted_pos x y, predicted_vel x y, extension (doubles).
inline constexpr int kPlanColumns = 12;
inline constexpr int kMostPlans = 256;  // limit per batch

// Consecutive ticks, and their small messages.
struct LogBatch {
  std::int64_t first_tick = 0;
  int ticks = 0;
  std::vector<std::uint64_t> inputs;    // ticks x InputLayout::columns()
  std::vector<double> signals;          // ticks x signals
  std::vector<std::uint8_t> highlight;  // by tick
  int plans = 0;
  std::vector<std::uint64_t> plan_rows;  // plans x kPlanColumns
  std::vector<std::uint8_t> messages;    // in sequence: MessageHead, bytes
  std::size_t message_bytes = 0;

  struct MessageHead {
    std::int64_t time_ns = 0;
    std::uint32_t size = 0;
    LogChannel channel = LogChannel::events;
  };
};

class LogEncoder {
 public:
  // Creates the file and writes everything before the first tick. batch: maximum number of ticks in
  // a batch.
  LogEncoder(const std::string& path, const core::SignalTable& table, const LogHeader& header,
             int batch);

  // Writes a batch and flushes it to the kernel; batches must be in tick order.
  void write(const LogBatch& batch) noexcept;
  void close() { mcap_.close(); }
  bool failed() const noexcept { return mcap_.failed(); }

  const InputLayout& layout() const noexcept { return layout_; }
  std::int64_t time_ns(std::int64_t tick) const noexcept;

 private:
  void write_head(const core::SignalTable& table, const LogHeader& header);
  void write_parameters(const LogHeader& header);
  void write_inputs(const LogBatch& batch) noexcept;
  void write_plans(const LogBatch& batch) noexcept;
  void keep_rows(const LogBatch& batch) noexcept;
  void write_rows(const LogBatch& batch) noexcept;
  void write_row_block(const std::int64_t* ticks, int rows) noexcept;
  void put(LogChannel channel, std::int64_t tick, std::size_t size) noexcept;
  std::size_t ring_row(std::int64_t tick) const noexcept;

  InputLayout layout_;
  int signals_, batch_;
  std::int64_t rate_mhz_, row_every_, window_;  // window_: ticks around a highlight
  ColumnCodec<std::uint64_t> input_codec_;
  ColumnCodec<std::uint64_t> plan_codec_;
  ColumnCodec<std::uint32_t> row_codec_;
  std::int64_t input_blocks_ = 0, plan_blocks_ = 0, row_blocks_ = 0;
  // Rows of the last 0.2 s and one batch, inputs then signals, as floats.
  std::int64_t ring_size_;
  std::vector<float> ring_;
  std::vector<std::int64_t> ring_tick_;  // tick of the row
  std::vector<std::uint8_t> ring_done_;  // whether it is in the file
  std::int64_t full_until_ = -1'000'000'000;
  std::vector<std::int64_t> wanted_;  // ticks to be written now
  std::vector<std::uint8_t> coded_;   // encoded columns of a block
  std::vector<std::uint8_t> message_;
  McapWriter mcap_;
};

}  // namespace footfall::engine
