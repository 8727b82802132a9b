// Writes an MCAP file: messages in zstd-compressed chunks, each flushed to the kernel when
// complete, so that a killed process loses only the last chunk. Not for use in the tick: called by
// the logger.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

struct ZSTD_CCtx_s;

namespace footfall::engine {

// Appends little-endian values to a vector.
class McapBytes {
 public:
  explicit McapBytes(std::vector<std::uint8_t>& out) : out_(out) {}
  void u8(std::uint8_t value);
  void u16(std::uint16_t value);
  void u32(std::uint32_t value);
  void u64(std::uint64_t value);
  void text(std::string_view value);  // 32-bit length, then bytes
  void raw(std::span<const std::uint8_t> value);

 private:
  std::vector<std::uint8_t>& out_;
};

using McapPairs = std::vector<std::pair<std::string, std::string>>;

class McapWriter {
 public:
  // Creates the file and writes its header. max_message: size of the longest message, bytes. Throws
  // std::runtime_error, naming the path, if the file cannot be created.
  McapWriter(const std::string& path, std::string_view library, std::size_t max_message);
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  // To be called before the first message; ids count from 1 in call order.
  std::uint16_t add_schema(std::string_view name, std::string_view encoding,
                           std::span<const std::uint8_t> data);
  std::uint16_t add_channel(std::uint16_t schema, std::string_view topic,
                            std::string_view encoding);
  void add_metadata(std::string_view name, const McapPairs& pairs);
  // Embeds a complete file.
  void add_attachment(std::string_view name, std::string_view media_type, std::string_view content);

  // Memory for one message of `size` <= max_message bytes, to be filled at once. Does not allocate
  // while there are less than kReservedChunks chunks. Ends the previous chunk if it is due.
  std::uint8_t* message(std::uint16_t channel, std::int64_t time_ns, std::size_t size) noexcept;
  // Ends the chunk: compresses it and flushes it to the kernel.
  void end_chunk() noexcept;
  // Ends the last chunk and writes the summary. Throws std::runtime_error if any write failed.
  void close();
  // Whether a write failed (e.g. disk full); later data are dropped.
  bool failed() const noexcept { return error_ != 0; }

 private:
  struct Channel {
    std::uint32_t sequence = 0;
    std::vector<std::uint64_t> index;  // alternating time and offset of each message of this chunk
  };
  struct ChunkEntry {
    std::uint64_t start_time, end_time, offset, length, index_length, compressed, uncompressed;
    std::vector<std::uint64_t>::size_type first_offset;  // index into index_offsets_
  };
  struct MetadataEntry {
    std::uint64_t offset, length;
    std::string name;
  };
  struct AttachmentEntry {
    std::uint64_t offset, length, size;
    std::string name, media_type;
  };

  void put_record(std::uint8_t kind, std::span<const std::uint8_t> content);
  void write_out() noexcept;  // writes out_ to the kernel and clears it
  void write_indices(ChunkEntry& entry);
  void write_summary();
  void write_chunk_index(const ChunkEntry& entry);
  void write_attachment_index(const AttachmentEntry& entry);
  void write_metadata_index(const MetadataEntry& entry);
  void write_statistics();
  std::uint64_t position() const { return written_ + out_.size(); }

  std::string path_;
  int file_ = -1;
  int error_ = 0;  // errno of the first failed write
  bool closed_ = false;
  std::uint64_t written_ = 0;   // bytes written to the kernel
  std::uint32_t data_crc_ = 0;  // over all bytes written to the kernel
  ZSTD_CCtx_s* zstd_ = nullptr;
  std::size_t capacity_ = 0;
  std::vector<std::uint8_t> chunk_;       // uncompressed records of the current chunk
  std::size_t chunk_size_ = 0;            // bytes of chunk_ in use
  std::vector<std::uint8_t> compressed_;  // worst case for a full chunk
  std::vector<std::uint8_t> out_;         // records to be written next
  std::vector<std::uint8_t> scratch_;     // content of one record
  std::uint64_t chunk_start_ = 0, chunk_end_ = 0;
  std::uint64_t file_start_ = 0, file_end_ = 0, message_count_ = 0;
  std::vector<Channel> channels_;  // by id - 1
  std::vector<std::vector<std::uint8_t>> schema_records_, channel_records_;
  std::vector<ChunkEntry> chunks_;
  std::vector<std::uint64_t> index_offsets_;  // per chunk and channel; 0: no messages
  std::vector<MetadataEntry> metadata_;
  std::vector<AttachmentEntry> attachments_;
};

}  // namespace footfall::engine
