// The messages of a log as a protobuf schema; the one door to libprotobuf. The messages themselves
// are written by hand (engine/log/proto_bytes.h), since the writer must not allocate. docs/log.md
// says what each field means.
#pragma once

#include <cstdint>
#include <vector>

namespace footfall::engine {

// Serialized google.protobuf.FileDescriptorSet with all messages: the data of every schema record.
std::vector<std::uint8_t> log_descriptor_set();

}  // namespace footfall::engine
