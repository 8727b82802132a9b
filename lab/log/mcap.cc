// Records of an MCAP file; see mcap.h.
#include "lab/log/mcap.h"

#include <zstd.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <system_error>

#include "engine/log/mcap_format.h"

namespace footfall::lab {
namespace {

using engine::kMcapMagic;
using engine::McapRecord;

constexpr std::uint64_t kMaxChunk = 256U << 20;  // far above the chunks that the writer makes

class Walk {
 public:
  explicit Walk(McapVisitor& visitor) : visitor_(visitor) {}

  bool read(Bytes file) {
    Cursor cursor(file.subspan(kMcapMagic.size()));
    while (cursor.left() >= engine::kMcapRecordHead) {
      const auto kind = cursor.number<McapRecord>();
      const auto size = cursor.number<std::uint64_t>();
      if (size > cursor.left()) return false;  // truncated
      if (kind == McapRecord::data_end) {
        return file.size() >= 2 * kMcapMagic.size() &&
               std::ranges::equal(file.last(kMcapMagic.size()), kMcapMagic);
      }
      record(kind, cursor.take(size));
    }
    return false;
  }

 private:
  void record(McapRecord kind, Bytes content) {
    Cursor cursor(content);
    if (kind == McapRecord::metadata) metadata(cursor);
    if (kind == McapRecord::attachment) attachment(cursor, content);
    if (kind == McapRecord::channel) channel(cursor);
    if (kind == McapRecord::chunk) chunk(cursor);
    if (kind == McapRecord::message) message(cursor);
  }

  void metadata(Cursor& cursor) {
    const std::string name = cursor.text();
    Cursor map(cursor.take(cursor.number<std::uint32_t>()));
    while (!map.empty()) {
      const std::string key = map.text();
      visitor_.metadata(name, key, map.text());
    }
  }

  void attachment(Cursor& cursor, Bytes content) {
    cursor.take(16);  // log time, creation time
    const std::string name = cursor.text();
    const std::string media_type = cursor.text();
    const Bytes data = cursor.take(cursor.number<std::uint64_t>());
    const auto crc = cursor.number<std::uint32_t>();
    if (crc != 0 && engine::crc32(content.first(content.size() - sizeof crc)) != crc) {
      throw Damaged{};
    }
    visitor_.attachment(name, media_type, data);
  }

  void channel(Cursor& cursor) {
    const int id = cursor.number<std::uint16_t>();
    cursor.number<std::uint16_t>();  // schema
    visitor_.channel(id, cursor.text());
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
    cursor.take(4 + 8 + 8);  // sequence, log time, publish time
    visitor_.message(id, cursor.take(cursor.left()));
  }

  McapVisitor& visitor_;
  std::vector<std::uint8_t> plain_;
};

std::vector<std::uint8_t> load(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  // A folder can be opened, too, and reports the largest possible size.
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

std::uint64_t Cursor::varint() {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 64; shift += 7) {
    const auto byte = number<std::uint8_t>();
    value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
    if (byte < 0x80) return value;
  }
  throw Damaged{};
}

double ProtoField::real() const { return std::bit_cast<double>(integer); }

std::int64_t ProtoField::signed_integer() const {
  return static_cast<std::int64_t>(integer >> 1) ^ -static_cast<std::int64_t>(integer & 1);
}

ProtoField next_field(Cursor& cursor) {
  const std::uint64_t tag = cursor.varint();
  ProtoField field{tag >> 3, 0, {}};
  switch (tag & 7) {
    case 0:
      field.integer = cursor.varint();
      break;
    case 1:
      field.integer = cursor.number<std::uint64_t>();
      break;
    case 2:
      field.bytes = cursor.take(cursor.varint());
      break;
    case 5:
      field.integer = cursor.number<std::uint32_t>();
      break;
    default:
      throw Damaged{};
  }
  return field;
}

std::vector<std::uint8_t> load_mcap(const std::string& path) {
  std::vector<std::uint8_t> bytes = load(path);
  if (bytes.size() < kMcapMagic.size() ||
      !std::equal(kMcapMagic.begin(), kMcapMagic.end(), bytes.begin())) {
    throw std::runtime_error("'" + path + "' is not a log of Footfall (an MCAP file was expected)");
  }
  return bytes;
}

bool visit_mcap(Bytes file, McapVisitor& visitor) {
  try {
    return Walk(visitor).read(file);
  } catch (const Damaged&) {
    return false;  // records before the damage are kept
  }
}

}  // namespace footfall::lab
