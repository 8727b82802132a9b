// The protobuf side of the log: field names of signals and the FileDescriptorSets that describe the
// messages, written by hand (https://protobuf.dev/programming-guides/encoding) to need no
// libprotobuf.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/signal_table.h"

namespace footfall::engine {

// Field name of each signal: letters, digits and `_`, unique, in the order of the table.
std::vector<std::string> field_names(const core::SignalTable& table);

// True where the signal is stored as double: absolute times outgrow a float.
bool is_double(const core::SignalInfo& info);

// Serialized google.protobuf.FileDescriptorSet with the one message footfall.Signals.
std::vector<std::uint8_t> signals_descriptor(const core::SignalTable& table);

// The same for footfall.Event.
std::vector<std::uint8_t> event_descriptor();

// A protobuf varint at the end of `out`.
void put_varint(std::vector<std::uint8_t>& out, std::uint64_t value);

}  // namespace footfall::engine
