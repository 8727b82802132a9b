// The end of an MCAP file: DataEnd, the summary that lets readers seek, and the footer.
#include "engine/log/mcap_format.h"
#include "engine/log/mcap_writer.h"

namespace footfall::engine {

void McapWriter::write_chunk_index(const ChunkEntry& entry) {
  std::vector<std::uint8_t> offsets;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const std::uint64_t offset = index_offsets_[entry.first_offset + i];
    if (offset == 0) continue;
    McapBytes(offsets).u16(static_cast<std::uint16_t>(i + 1));
    McapBytes(offsets).u64(offset);
  }
  McapBytes content(scratch_);
  content.u64(entry.start_time);
  content.u64(entry.end_time);
  content.u64(entry.offset);
  content.u64(entry.length);
  content.u32(static_cast<std::uint32_t>(offsets.size()));
  content.raw(offsets);
  content.u64(entry.index_length);
  content.text("zstd");
  content.u64(entry.compressed);
  content.u64(entry.uncompressed);
  put_record(static_cast<std::uint8_t>(McapRecord::chunk_index), scratch_);
}

void McapWriter::write_statistics() {
  McapBytes content(scratch_);
  content.u64(message_count_);
  content.u16(static_cast<std::uint16_t>(schema_records_.size()));
  content.u32(static_cast<std::uint32_t>(channels_.size()));
  content.u32(static_cast<std::uint32_t>(attachments_.size()));
  content.u32(static_cast<std::uint32_t>(metadata_.size()));
  content.u32(static_cast<std::uint32_t>(chunks_.size()));
  content.u64(file_start_);
  content.u64(file_end_);
  content.u32(static_cast<std::uint32_t>(channels_.size() * 10));
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    content.u16(static_cast<std::uint16_t>(i + 1));
    content.u64(channels_[i].sequence);
  }
  put_record(static_cast<std::uint8_t>(McapRecord::statistics), scratch_);
}

void McapWriter::write_attachment_index(const AttachmentEntry& entry) {
  McapBytes content(scratch_);
  content.u64(entry.offset);
  content.u64(entry.length);
  content.u64(0);  // log time
  content.u64(0);  // creation time
  content.u64(entry.size);
  content.text(entry.name);
  content.text(entry.media_type);
  put_record(static_cast<std::uint8_t>(McapRecord::attachment_index), scratch_);
}

void McapWriter::write_metadata_index(const MetadataEntry& entry) {
  McapBytes content(scratch_);
  content.u64(entry.offset);
  content.u64(entry.length);
  content.text(entry.name);
  put_record(static_cast<std::uint8_t>(McapRecord::metadata_index), scratch_);
}

void McapWriter::write_summary() {
  scratch_.clear();
  McapBytes(scratch_).u32(data_crc_);
  put_record(static_cast<std::uint8_t>(McapRecord::data_end), scratch_);
  write_out();

  const std::uint64_t summary_start = position();
  struct Group {
    McapRecord kind;
    std::uint64_t start, length;
  };
  std::vector<Group> groups;
  const auto group = [&](McapRecord kind, auto&& write) {
    const std::uint64_t start = position();
    write();
    if (position() > start) groups.push_back({kind, start, position() - start});
  };
  group(McapRecord::schema, [&] {
    for (const auto& r : schema_records_)
      put_record(static_cast<std::uint8_t>(McapRecord::schema), r);
  });
  group(McapRecord::channel, [&] {
    for (const auto& r : channel_records_) {
      put_record(static_cast<std::uint8_t>(McapRecord::channel), r);
    }
  });
  group(McapRecord::statistics, [&] { write_statistics(); });
  group(McapRecord::chunk_index, [&] {
    for (const ChunkEntry& entry : chunks_) write_chunk_index(entry);
  });
  group(McapRecord::attachment_index, [&] {
    for (const AttachmentEntry& entry : attachments_) write_attachment_index(entry);
  });
  group(McapRecord::metadata_index, [&] {
    for (const MetadataEntry& entry : metadata_) write_metadata_index(entry);
  });
  const std::uint64_t offset_start = position();
  for (const Group& g : groups) {
    McapBytes content(scratch_);
    content.u8(static_cast<std::uint8_t>(g.kind));
    content.u64(g.start);
    content.u64(g.length);
    put_record(static_cast<std::uint8_t>(McapRecord::summary_offset), scratch_);
  }
  // The footer's CRC covers the summary and the footer up to the CRC itself.
  McapBytes out(out_);
  out.u8(static_cast<std::uint8_t>(McapRecord::footer));
  out.u64(8 + 8 + 4);
  out.u64(summary_start);
  out.u64(offset_start);
  out.u32(crc32(out_));
  out.raw(kMcapMagic);
  write_out();
}

}  // namespace footfall::engine
