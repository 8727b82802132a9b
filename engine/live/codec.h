// Messages of live tuning (engine/lcm) to packets and back. A packet may be forged: it is validated
// completely before anything is decoded or allocated.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/live/key.h"

namespace footfall::engine {

// What speaks against a packet.
enum class PacketProblem : std::uint8_t {
  none,
  too_large,      // for a message of its type
  wrong_type,     // the fingerprint is of something else
  not_authentic,  // signed by another key, or not at all
  malformed,      // counts, lengths, texts or its own length do not fit
  count,
};
const char* packet_problem_name(PacketProblem problem);

using PacketBytes = std::vector<std::uint8_t>;

// Both exist for every message of engine/lcm/messages with the constant LARGEST_PACKET.

// With a key, what has a `mac` must be signed by it; that is checked before anything else is read.
// The message is written only if the packet is well formed: texts are UTF-8 without control
// characters, counts and lengths within the packet, no byte left over. Numbers may be anything,
// also not finite. Needs at most a small multiple of the packet's size.
template <class Message>
PacketProblem decode(std::span<const std::uint8_t> packet, const LiveKey* key,
                     Message& message) noexcept;

// Counts are taken from the lengths of the lists. With a key, what has a `mac` is signed by it
// (crypto_auth over all bytes before), else its `mac` is zero.
template <class Message>
PacketBytes encode(Message message, const LiveKey* key);

// An encoded message whose last 32 bytes are replaced by the `mac` of the others; shorter ones stay
// as they are.
PacketBytes seal(PacketBytes packet, const LiveKey& key);

}  // namespace footfall::engine
