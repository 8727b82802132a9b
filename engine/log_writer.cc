// The log of a run; see log_writer.h.
#include "engine/log_writer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "engine/log_schema.h"
#include "engine/mcap_writer.h"

namespace footfall::engine {
namespace {

constexpr std::size_t kMaxText = 4096;
constexpr int kWire64 = 1, kWireText = 2, kWire32 = 5;  // protobuf wire types

// A row as it is sent: tags stand, the numbers between them change. Most signals are floats.
struct Row {
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint32_t> offset;  // of each number
  std::vector<bool> wide;             // a double

  explicit Row(const core::SignalTable& table) {
    for (int i = 0; i < table.size(); ++i) {
      const bool is_wide = is_double(table.info(i));
      put_varint(bytes, static_cast<std::uint64_t>((i + 1) << 3 | (is_wide ? kWire64 : kWire32)));
      offset.push_back(static_cast<std::uint32_t>(bytes.size()));
      wide.push_back(is_wide);
      bytes.resize(bytes.size() + (is_wide ? sizeof(double) : sizeof(float)));
    }
  }
};

std::string signals_json(const core::SignalTable& table) {
  const std::vector<std::string> fields = field_names(table);
  auto list = nlohmann::ordered_json::array();
  for (int i = 0; i < table.size(); ++i) {
    const core::SignalInfo& info = table.info(i);
    list.push_back({{"name", info.name},
                    {"field", fields[static_cast<std::size_t>(i)]},
                    {"unit", core::unit_text(info.dimension)},
                    {"doc", info.doc}});
  }
  return list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// At most kMaxText bytes, never half a UTF-8 character.
std::string_view cut(std::string_view text) noexcept {
  if (text.size() <= kMaxText) return text;
  std::size_t end = kMaxText;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end);
}

std::size_t varint_size(std::size_t value) noexcept {
  std::size_t size = 1;
  for (; value >= 0x80; value >>= 7) ++size;
  return size;
}

std::uint8_t* store_text(std::uint8_t* at, int field, std::string_view text) noexcept {
  *at++ = static_cast<std::uint8_t>(field << 3 | kWireText);
  std::size_t size = text.size();
  for (; size >= 0x80; size >>= 7) *at++ = static_cast<std::uint8_t>(size | 0x80);
  *at++ = static_cast<std::uint8_t>(size);
  return std::copy(text.begin(), text.end(), at);
}

}  // namespace

struct LogWriter::Impl {
  Impl(const std::string& path, const core::SignalTable& table)
      : row(table),
        mcap(path, "footfall",
             std::max(row.bytes.size(), 3 * (kMaxText + 4) + sizeof(double) + 1)) {}

  Row row;
  McapWriter mcap;
  std::uint16_t signals = 0, events = 0;  // channels
  std::vector<std::uint32_t> wide;        // indices of the doubles
};

LogWriter::LogWriter(const std::string& path, const core::SignalTable& table,
                     const LogHeader& header)
    : impl_(std::make_unique<Impl>(path, table)) {
  McapWriter& mcap = impl_->mcap;
  mcap.add_metadata("run", header.run);
  mcap.add_metadata("signals", {{"signals", signals_json(table)}});
  const std::uint16_t signals_schema =
      mcap.add_schema("footfall.Signals", "protobuf", signals_descriptor(table));
  const std::uint16_t event_schema =
      mcap.add_schema("footfall.Event", "protobuf", event_descriptor());
  impl_->signals = mcap.add_channel(signals_schema, "/signals", "protobuf");
  impl_->events = mcap.add_channel(event_schema, "/events", "protobuf");
  for (std::uint32_t i = 0; i < impl_->row.wide.size(); ++i) {
    if (impl_->row.wide[i]) impl_->wide.push_back(i);
  }
}

LogWriter::~LogWriter() = default;

void LogWriter::sample(std::int64_t time_ns, const double* values) noexcept {
  const Row& row = impl_->row;
  std::uint8_t* to = impl_->mcap.message(impl_->signals, time_ns, row.bytes.size());
  std::memcpy(to, row.bytes.data(), row.bytes.size());
  // The rare doubles come last: writing 4 bytes there first does no harm, and the loop has no
  // branch.
  for (std::size_t i = 0; i < row.offset.size(); ++i) {
    const auto value = static_cast<float>(values[i]);
    std::memcpy(to + row.offset[i], &value, sizeof value);
  }
  for (const std::uint32_t i : impl_->wide) {
    std::memcpy(to + row.offset[i], &values[i], sizeof(double));
  }
}

void LogWriter::event(std::int64_t time_ns, std::string_view kind, std::string_view name,
                      std::string_view detail) noexcept {
  const std::array<std::string_view, 3> texts = {cut(kind), cut(name), cut(detail)};
  std::size_t size = 1 + sizeof(double);
  for (const std::string_view text : texts) size += 1 + varint_size(text.size()) + text.size();
  std::uint8_t* at = impl_->mcap.message(impl_->events, time_ns, size);
  *at++ = 1 << 3 | kWire64;
  const double time = static_cast<double>(time_ns) * 1e-9;
  std::memcpy(at, &time, sizeof time);
  at += sizeof time;
  for (int i = 0; i < 3; ++i) at = store_text(at, i + 2, texts[static_cast<std::size_t>(i)]);
}

void LogWriter::close() { impl_->mcap.close(); }

bool LogWriter::failed() const noexcept { return impl_->mcap.failed(); }

}  // namespace footfall::engine
