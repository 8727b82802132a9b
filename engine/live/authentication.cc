#include "engine/live/authentication.h"

#include <sodium.h>

#include <tuple>

namespace footfall::engine {

static_assert(kMacBytes == crypto_auth_BYTES && std::tuple_size_v<LiveKey> == crypto_auth_KEYBYTES);

bool authentic(std::span<const std::uint8_t> packet, const LiveKey& key) {
  if (packet.size() < kMacBytes) return false;
  const std::size_t size = packet.size() - kMacBytes;
  return crypto_auth_verify(packet.data() + size, packet.data(), size, key.data()) == 0;
}

PacketBytes seal(PacketBytes packet, const LiveKey& key) {
  if (packet.size() < kMacBytes) return packet;
  const std::size_t size = packet.size() - kMacBytes;
  crypto_auth(packet.data() + size, packet.data(), size, key.data());
  return packet;
}

}  // namespace footfall::engine
