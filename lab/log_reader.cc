// Reader of logs; see log_reader.h. Every length in the file is checked: a log may be damaged.
#include "lab/log_reader.h"

#include <zstd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <system_error>

#include "engine/mcap_format.h"

namespace footfall::lab {
namespace {

using engine::McapRecord;
using Bytes = std::span<const std::uint8_t>;

constexpr std::uint64_t kMaxChunk = 256U << 20;  // far above what the writer makes

// The file, or a part of it, is not what it says.
struct Damaged {};

// Takes numbers and texts from the front of some bytes; Damaged when they end too early.
class Cursor {
 public:
  explicit Cursor(Bytes bytes) : rest_(bytes) {}
  bool empty() const { return rest_.empty(); }
  std::size_t left() const { return rest_.size(); }
  Bytes take(std::uint64_t size) {
    if (size > rest_.size()) throw Damaged{};
    const Bytes front = rest_.first(static_cast<std::size_t>(size));
    rest_ = rest_.subspan(front.size());
    return front;
  }
  template <typename T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string text(std::uint64_t size) {
    const Bytes bytes = take(size);
    return {bytes.begin(), bytes.end()};
  }
  std::string text() { return text(number<std::uint32_t>()); }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto byte = number<std::uint8_t>();
      value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
      if (byte < 0x80) return value;
    }
    throw Damaged{};
  }

 private:
  Bytes rest_;
};

// One field of a protobuf message: the number as it is stored, or the bytes.
struct Field {
  std::uint64_t number = 0;
  double value = 0.0;
  Bytes bytes;
};

Field next_field(Cursor& cursor) {
  const std::uint64_t tag = cursor.varint();
  Field field{tag >> 3, 0.0, {}};
  switch (tag & 7) {
    case 0:
      field.value = static_cast<double>(cursor.varint());
      break;
    case 1:
      field.value = cursor.number<double>();
      break;
    case 2:
      field.bytes = cursor.take(cursor.varint());
      break;
    case 5:
      field.value = static_cast<double>(cursor.number<float>());
      break;
    default:
      throw Damaged{};
  }
  return field;
}

// Builds a Log from the records of a file.
class Reader {
 public:
  explicit Reader(Log& log) : log_(log) {}

  void read(Bytes file) {
    Cursor cursor(file.subspan(engine::kMcapMagic.size()));
    while (cursor.left() >= engine::kMcapRecordHead) {
      const auto kind = cursor.number<McapRecord>();
      const auto size = cursor.number<std::uint64_t>();
      if (size > cursor.left()) return;  // cut off
      if (kind == McapRecord::data_end) {
        log_.complete =
            file.size() >= 2 * engine::kMcapMagic.size() &&
            std::ranges::equal(file.last(engine::kMcapMagic.size()), engine::kMcapMagic);
        return;
      }
      record(kind, cursor.take(size));
    }
  }
  bool described() const { return !log_.signals.empty() && signals_ >= 0; }

 private:
  void record(McapRecord kind, Bytes content) {
    Cursor cursor(content);
    if (kind == McapRecord::metadata) metadata(cursor);
    if (kind == McapRecord::channel) channel(cursor);
    if (kind == McapRecord::chunk) chunk(cursor);
    if (kind == McapRecord::message) message(cursor);
  }

  void metadata(Cursor& cursor) {
    const std::string name = cursor.text();
    Cursor map(cursor.take(cursor.number<std::uint32_t>()));
    while (!map.empty()) {
      const std::string key = map.text();
      const std::string value = map.text();
      if (name == "run") log_.run[key] = value;
      if (name == "signals" && key == "signals") signals(value);
    }
  }

  void signals(const std::string& json) {
    log_.signals.clear();
    const auto list = nlohmann::json::parse(json, nullptr, false);
    if (!list.is_array()) throw Damaged{};
    for (const auto& item : list) {
      if (!item.is_object()) throw Damaged{};
      const auto text = [&](const char* key) {
        const auto found = item.find(key);
        return found != item.end() && found->is_string() ? found->get<std::string>() : "";
      };
      log_.signals.push_back({text("name"), text("field"), text("unit"), text("doc")});
    }
    log_.column.resize(log_.signals.size());
  }

  void channel(Cursor& cursor) {
    const auto id = cursor.number<std::uint16_t>();
    cursor.number<std::uint16_t>();  // schema
    const std::string topic = cursor.text();
    if (topic == "/signals") signals_ = id;
    if (topic == "/events") events_ = id;
  }

  void chunk(Cursor& cursor) {
    cursor.take(16);  // first and last time
    const auto size = cursor.number<std::uint64_t>();
    const auto crc = cursor.number<std::uint32_t>();
    const std::string compression = cursor.text();
    const Bytes packed = cursor.take(cursor.number<std::uint64_t>());
    Bytes records = packed;
    if (compression == "zstd") {
      if (size > kMaxChunk) throw Damaged{};
      plain_.resize(static_cast<std::size_t>(size));
      const std::size_t n =
          ZSTD_decompress(plain_.data(), plain_.size(), packed.data(), packed.size());
      if (ZSTD_isError(n) != 0U || n != size) throw Damaged{};
      records = plain_;
    } else if (!compression.empty()) {
      throw Damaged{};
    }
    if (crc != 0 && engine::crc32(records) != crc) throw Damaged{};
    Cursor inner(records);
    while (!inner.empty()) {
      const auto kind = inner.number<McapRecord>();
      const Bytes content = inner.take(inner.number<std::uint64_t>());
      if (kind != McapRecord::chunk) record(kind, content);
    }
  }

  void message(Cursor& cursor) {
    const int id = cursor.number<std::uint16_t>();
    cursor.number<std::uint32_t>();  // sequence
    const auto time_ns = cursor.number<std::uint64_t>();
    cursor.number<std::uint64_t>();  // publish time
    if (id == signals_) row(cursor, time_ns);
    if (id == events_) event(cursor);
  }

  void row(Cursor& cursor, std::uint64_t time_ns) {
    log_.time.push_back(static_cast<double>(time_ns) * 1e-9);
    for (auto& column : log_.column) column.push_back(0.0F);
    while (!cursor.empty()) {
      const Field field = next_field(cursor);
      if (field.number == 0 || field.number > log_.column.size()) continue;
      log_.column[static_cast<std::size_t>(field.number - 1)].back() =
          static_cast<float>(field.value);
    }
  }

  void event(Cursor& cursor) {
    LoggedEvent event;
    while (!cursor.empty()) {
      const Field field = next_field(cursor);
      const std::string text(field.bytes.begin(), field.bytes.end());
      if (field.number == 1) event.time = field.value;
      if (field.number == 2) event.kind = text;
      if (field.number == 3) event.name = text;
      if (field.number == 4) event.detail = text;
    }
    log_.events.push_back(std::move(event));
  }

  Log& log_;
  int signals_ = -1, events_ = -1;  // channels
  std::vector<std::uint8_t> plain_;
};

std::vector<std::uint8_t> load(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  // A folder opens, too, and claims the largest size there is.
  if (size < 0 || size == std::numeric_limits<std::streamoff>::max()) {
    const auto why = file ? std::errc::is_a_directory : std::errc::no_such_file_or_directory;
    throw std::runtime_error("cannot read the log '" + path +
                             "': " + std::make_error_code(why).message());
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!file) throw std::runtime_error("cannot read the log '" + path + "'");
  return bytes;
}

}  // namespace

int Log::find(std::string_view name) const {
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (signals[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

const std::vector<float>* Log::values(std::string_view name) const {
  const int index = find(name);
  return index < 0 ? nullptr : &column[static_cast<std::size_t>(index)];
}

std::string Log::get(const std::string& key, const std::string& otherwise) const {
  const auto found = run.find(key);
  return found == run.end() ? otherwise : found->second;
}

Log read_log(const std::string& path) {
  const std::vector<std::uint8_t> bytes = load(path);
  if (bytes.size() < engine::kMcapMagic.size() ||
      !std::equal(engine::kMcapMagic.begin(), engine::kMcapMagic.end(), bytes.begin())) {
    throw std::runtime_error("'" + path + "' is not a log of Footfall (an MCAP file was expected)");
  }
  Log log;
  log.path = path;
  Reader reader(log);
  try {
    reader.read(bytes);
  } catch (const Damaged&) {
    log.complete = false;  // what came before the damage stays
    const std::size_t rows = log.rows();
    for (auto& column : log.column) column.resize(rows);
  }
  if (!reader.described()) {
    throw std::runtime_error("the log '" + path +
                             "' has no signals: it is damaged, cut off at its start, or not ours");
  }
  return log;
}

}  // namespace footfall::lab
