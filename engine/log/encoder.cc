// Batches to MCAP messages; see encoder.h.
#include "engine/log/encoder.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/index.h"
#include "core/text/json_text.h"
#include "core/units/units.h"
#include "engine/log/proto_bytes.h"
#include "engine/log/schema.h"

namespace footfall::engine {
namespace {

constexpr std::int64_t kKeyBlocks = 20;       // blocks between self-contained ones
constexpr double kWindow = 0.2;               // s around a highlight
constexpr std::size_t kOtherMessage = 16384;  // bytes, upper limit for messages other than blocks

std::size_t block_bytes(std::size_t columns, int rows) {
  return columns + 64 + at(rows) * (sizeof(std::uint64_t) + 5);
}

std::string signals_json(const core::SignalTable& table) {
  auto list = nlohmann::ordered_json::array();
  for (const core::SignalInfo& info : table.infos()) {
    list.push_back(
        {{"name", info.name}, {"unit", core::unit_text(info.dimension)}, {"doc", info.doc}});
  }
  return core::json_text(list);
}

std::size_t parameter_bytes(const LogHeader& header) {
  std::size_t size = 64 + header.values.size() * sizeof(double);
  for (const LogParameter& parameter : header.parameters) size += parameter.name.size() + 24;
  return size;
}

}  // namespace

LogEncoder::LogEncoder(const std::string& path, const core::SignalTable& table,
                       const LogHeader& header, int batch)
    : layout_(header.names),
      signals_(table.size()),
      batch_(batch),
      rate_mhz_(header.rate_mhz),
      row_every_(std::max(1, header.row_every)),
      window_(static_cast<std::int64_t>(kWindow * static_cast<double>(header.rate_mhz) / 1e3)),
      input_codec_(layout_.columns(), 0, batch, 1e3 / static_cast<double>(header.rate_mhz)),
      plan_codec_(kPlanColumns, 0, kMostPlans),
      row_codec_(layout_.columns() + signals_, layout_.columns(), batch),
      ring_size_(window_ + batch),
      ring_(at(ring_size_) * at(layout_.columns() + signals_)),
      ring_tick_(at(ring_size_), -1'000'000'000),
      ring_done_(at(ring_size_)),
      coded_(std::max(
          {input_codec_.bound(batch), row_codec_.bound(batch), plan_codec_.bound(kMostPlans)})),
      message_(block_bytes(coded_.size(), batch)),
      mcap_(path, "footfall", std::max({message_.size(), kOtherMessage, parameter_bytes(header)})) {
  wanted_.reserve(at(ring_size_));
  for (const auto& [rate, integral] : layout_.integrals()) {
    input_codec_.set_integral(integral, rate);
  }
  for (const int w : layout_.quaternions()) input_codec_.set_unit(w + 3, w);
  write_head(table, header);
  write_parameters(header);
}

void LogEncoder::write_head(const core::SignalTable& table, const LogHeader& header) {
  mcap_.add_metadata("run", header.run);
  mcap_.add_metadata("signals", {{"signals", signals_json(table)}});
  mcap_.add_metadata("columns", {{"columns", core::json_text(layout_.names())},
                                 {"joints", core::json_text(header.names.joints)},
                                 {"contacts", core::json_text(header.names.contacts)},
                                 {"markers", core::json_text(header.names.markers)},
                                 {"estimation", header.names.estimation ? "true" : "false"},
                                 {"aids", header.names.aids ? "true" : "false"}});
  mcap_.add_metadata("events", {{"events", core::json_text(header.events)}});
  mcap_.add_metadata("setup", {{"setup", header.setup},
                               {"rate_mhz", std::to_string(header.rate_mhz)},
                               {"row_every", std::to_string(row_every_)}});
  for (const LogFile& file : header.files) {
    mcap_.add_attachment(file.path, file.media_type, file.content);
  }
  const std::vector<std::uint8_t> schema = log_descriptor_set();
  const auto add = [&](const char* message, const char* topic) {
    const std::uint16_t id = mcap_.add_schema(message, "protobuf", schema);
    mcap_.add_channel(id, topic, "protobuf");
  };
  // In the order of LogChannel.
  add("footfall.InputBlock", "/inputs");
  add("footfall.SignalBlock", "/signals");
  add("footfall.Event", "/events");
  add("footfall.PlanBlock", "/plans");
  add("footfall.Edit", "/edits");
  add("footfall.Parameters", "/parameters");
}

void LogEncoder::write_parameters(const LogHeader& header) {
  std::vector<std::uint8_t> bytes(parameter_bytes(header));
  ProtoBytes proto(bytes.data());
  for (const LogParameter& p : header.parameters) proto.text(1, p.name);
  for (const LogParameter& p : header.parameters) proto.number(2, static_cast<unsigned>(p.slot));
  for (const LogParameter& p : header.parameters) proto.number(3, static_cast<unsigned>(p.size));
  proto.reals(4, header.values);
  std::memcpy(mcap_.message(static_cast<std::uint16_t>(LogChannel::parameters), 0, proto.size()),
              bytes.data(), proto.size());
  mcap_.end_chunk();
}

std::int64_t LogEncoder::time_ns(std::int64_t tick) const noexcept {
  return std::max<std::int64_t>(0, tick) * 1'000'000'000'000LL / rate_mhz_;
}

void LogEncoder::write(const LogBatch& batch) noexcept {
  std::size_t at_byte = 0;
  if (batch.ticks > 0) write_inputs(batch);
  if (batch.plans > 0) write_plans(batch);
  while (at_byte < batch.message_bytes) {
    LogBatch::MessageHead head;
    std::memcpy(&head, batch.messages.data() + at_byte, sizeof head);
    at_byte += sizeof head;
    std::uint8_t* to =
        mcap_.message(static_cast<std::uint16_t>(head.channel), head.time_ns, head.size);
    std::memcpy(to, batch.messages.data() + at_byte, head.size);
    at_byte += head.size;
  }
  if (batch.ticks > 0) {
    keep_rows(batch);
    write_rows(batch);
  }
  mcap_.end_chunk();
}

void LogEncoder::put(LogChannel channel, std::int64_t tick, std::size_t size) noexcept {
  std::memcpy(mcap_.message(static_cast<std::uint16_t>(channel), time_ns(tick), size),
              message_.data(), size);
}

void LogEncoder::write_inputs(const LogBatch& batch) noexcept {
  const int columns = layout_.columns();
  for (int k = 0; k < batch.ticks; ++k) {
    const std::uint64_t* row = batch.inputs.data() + at(k) * at(columns);
    for (int c = 0; c < columns; ++c) input_codec_.column(c)[k] = row[c];
  }
  const bool continues = input_blocks_++ % kKeyBlocks != 0;
  const std::uint8_t* end = input_codec_.encode(batch.ticks, continues, coded_.data());
  const auto size = static_cast<std::size_t>(end - coded_.data());
  ProtoBytes proto(message_.data());
  proto.signed_number(1, batch.first_tick);
  proto.number(2, static_cast<unsigned>(batch.ticks));
  proto.number(3, continues ? 1 : 0);
  proto.text(4, {reinterpret_cast<const char*>(coded_.data()), size});
  proto.begin_text(5, at(batch.ticks) * sizeof(std::uint64_t));
  for (int k = 0; k < batch.ticks; ++k) {
    proto.fixed(digest(batch.signals.data() + at(k) * at(signals_), signals_));
  }
  put(LogChannel::inputs, batch.first_tick, proto.size());
}

void LogEncoder::write_plans(const LogBatch& batch) noexcept {
  for (int k = 0; k < batch.plans; ++k) {
    const std::uint64_t* row = batch.plan_rows.data() + at(k) * kPlanColumns;
    for (int c = 0; c < kPlanColumns; ++c) plan_codec_.column(c)[k] = row[c];
  }
  const bool continues = plan_blocks_++ % kKeyBlocks != 0;
  const std::uint8_t* end = plan_codec_.encode(batch.plans, continues, coded_.data());
  ProtoBytes proto(message_.data());
  proto.number(1, static_cast<unsigned>(batch.plans));
  proto.number(2, continues ? 1 : 0);
  proto.text(3, {reinterpret_cast<const char*>(coded_.data()),
                 static_cast<std::size_t>(end - coded_.data())});
  put(LogChannel::plans, static_cast<std::int64_t>(batch.plan_rows.front()), proto.size());
}

std::size_t LogEncoder::ring_row(std::int64_t tick) const noexcept {
  return at((tick + ring_size_) % ring_size_);  // the first tick is -1
}

void LogEncoder::keep_rows(const LogBatch& batch) noexcept {
  const auto columns = at(layout_.columns());
  const auto width = columns + at(signals_);
  for (int k = 0; k < batch.ticks; ++k) {
    const std::size_t row = ring_row(batch.first_tick + k);
    ring_tick_[row] = batch.first_tick + k;
    ring_done_[row] = 0;
    float* to = ring_.data() + row * width;
    const std::uint64_t* inputs = batch.inputs.data() + at(k) * columns;
    for (std::size_t c = 0; c < columns; ++c) {
      to[c] = static_cast<float>(std::bit_cast<double>(inputs[c]));
    }
    const double* signals = batch.signals.data() + at(k) * at(signals_);
    for (std::size_t s = 0; s < at(signals_); ++s) to[columns + s] = static_cast<float>(signals[s]);
  }
}

// Writes every row_every-th tick, and all unwritten ones in the window around a highlight.
void LogEncoder::write_rows(const LogBatch& batch) noexcept {
  const std::int64_t begin = batch.first_tick, end = begin + batch.ticks;
  std::int64_t full_from = end;  // of the first highlight in this batch
  std::int64_t next = end;       // first tick whose nearest later highlight is not yet known
  wanted_.clear();
  for (std::int64_t t = end - 1; t >= begin; --t) {
    if (batch.highlight[at(t - begin)] != 0) full_from = std::min(full_from, t - window_);
  }
  next = std::max(std::min(full_from, begin), end - ring_size_);
  std::int64_t ahead = -1;  // the first highlight at or after t, searched below
  for (std::int64_t t = next; t < end; ++t) {
    const std::size_t row = ring_row(t);
    if (t < 0 || ring_tick_[row] != t || ring_done_[row] != 0) continue;
    if (t >= begin && batch.highlight[at(t - begin)] != 0) full_until_ = t + window_;
    if (ahead < t) {
      ahead = std::max(t, begin);
      while (ahead < end && batch.highlight[at(ahead - begin)] == 0) ++ahead;
    }
    const bool before = ahead < end && ahead - t <= window_;
    if (before || t <= full_until_ || (t >= begin && t % row_every_ == 0)) {
      wanted_.push_back(t);
      ring_done_[row] = 1;
    }
  }
  for (std::size_t k = 0; k < wanted_.size(); k += at(batch_)) {
    write_row_block(wanted_.data() + k, static_cast<int>(std::min(at(batch_), wanted_.size() - k)));
  }
}

void LogEncoder::write_row_block(const std::int64_t* ticks, int rows) noexcept {
  const auto width = at(layout_.columns() + signals_);
  for (int k = 0; k < rows; ++k) {
    const float* row = ring_.data() + ring_row(ticks[k]) * width;
    for (std::size_t c = 0; c < width; ++c) {
      row_codec_.column(static_cast<int>(c))[k] = std::bit_cast<std::uint32_t>(row[c]);
    }
  }
  const bool continues = row_blocks_++ % kKeyBlocks != 0;
  const std::uint8_t* end = row_codec_.encode(rows, continues, coded_.data());
  ProtoBytes proto(message_.data());
  proto.signed_number(1, ticks[0]);
  std::size_t offsets = 0;
  for (int k = 0; k < rows; ++k) {
    offsets += ProtoBytes::varint_size(static_cast<std::uint64_t>(ticks[k] - ticks[0]));
  }
  proto.begin_text(2, offsets);
  for (int k = 0; k < rows; ++k) proto.varint(static_cast<std::uint64_t>(ticks[k] - ticks[0]));
  proto.number(3, continues ? 1 : 0);
  proto.text(4, {reinterpret_cast<const char*>(coded_.data()),
                 static_cast<std::size_t>(end - coded_.data())});
  put(LogChannel::signals, ticks[0], proto.size());
}

}  // namespace footfall::engine
