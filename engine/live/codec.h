// Encodes and decodes the messages of live tuning (engine/lcm). Packets are untrusted: a packet is
// validated completely before anything is decoded or allocated.
#pragma once

#include <cstdint>
#include <span>

#include "engine/live/authentication.h"
#include "engine/live/key.h"

namespace footfall::engine {

// Reasons to reject a packet.
enum class PacketProblem : std::uint8_t {
  none,
  too_large,       // for a message of its type
  wrong_type,      // another fingerprint
  other_protocol,  // hello_t.PROTOCOL of the sender
  not_authentic,   // signed with another key, or unsigned
  malformed,       // invalid counts, lengths, texts or packet size
  count,
};
const char* packet_problem_name(PacketProblem problem);

// Both exist for every message of engine/lcm/messages with the constant LARGEST_PACKET.

// Decodes a packet. With a key, a message type with a `mac` must be signed with it; that is checked
// first. The message is written only if the packet is well formed: texts are UTF-8 without control
// characters, counts and lengths are within the packet, no byte is left over. Numbers are not
// checked, they may be non-finite. Memory is bounded by a small multiple of the packet's size.
template <class Message>
PacketProblem decode(std::span<const std::uint8_t> packet, const LiveKey* key,
                     Message& message) noexcept;

// Encodes a message. Counts are taken from the lengths of the lists. With a key, a `mac` is
// computed (crypto_auth over all bytes before it), otherwise it is zero.
template <class Message>
PacketBytes encode(Message message, const LiveKey* key);

}  // namespace footfall::engine
