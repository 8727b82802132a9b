// The `mac` at the end of a signed packet: whoever has the key wrote all bytes before it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/live/key.h"

namespace footfall::engine {

using PacketBytes = std::vector<std::uint8_t>;

inline constexpr std::size_t kMacBytes = 32;  // libsodium's crypto_auth

// Whether the last 32 bytes are the `mac` of the others. Compares in constant time.
bool authentic(std::span<const std::uint8_t> packet, const LiveKey& key);

// Replaces the last 32 bytes of an encoded message by the `mac` of the others; shorter packets are
// unchanged.
PacketBytes seal(PacketBytes packet, const LiveKey& key);

}  // namespace footfall::engine
