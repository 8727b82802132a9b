// The messages of a log as a protobuf schema; the only use of libprotobuf. The messages themselves
// are encoded by hand (engine/log/proto_bytes.h), because the writer must not allocate. docs/log.md
// describes each field.
#pragma once

#include <cstdint>
#include <vector>

namespace footfall::engine {

// Serialized google.protobuf.FileDescriptorSet with all messages: the data of every schema record.
std::vector<std::uint8_t> log_descriptor_set();

}  // namespace footfall::engine
