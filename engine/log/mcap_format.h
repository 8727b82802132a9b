// The MCAP container format, version 0 (https://mcap.dev/spec): definitions shared by writer and
// reader.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace footfall::engine {

// First and last bytes of a file.
inline constexpr std::array<std::uint8_t, 8> kMcapMagic = {0x89, 'M', 'C',  'A',
                                                           'P',  '0', '\r', '\n'};

// Type of a record: one byte, followed by a 64-bit length and the content; all little-endian.
enum class McapRecord : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  attachment = 0x09,
  attachment_index = 0x0A,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

inline constexpr std::size_t kMcapRecordHead = 9;    // type and length
inline constexpr std::size_t kMcapMessageHead = 22;  // channel, sequence, log and publish time

// CRC-32 (IEEE 802.3, reflected, as in zlib) of `bytes`, continued from `crc` (0 at the start).
std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0) noexcept;

}  // namespace footfall::engine
