// Validates a packet before the generated code decodes it; see codec.h. The generated code trusts
// counts and lengths: it would allocate 2^31 entries announced by a packet of 60 bytes.
#include "engine/live/codec.h"

#include <algorithm>
#include <footfall_lcm/layouts.hpp>
#include <string_view>

#include "core/text/printable.h"
#include "engine/live/authentication.h"

namespace footfall::engine {
namespace {

using namespace footfall_lcm;

constexpr std::size_t kFingerprintBytes = 8;

bool is_signed(std::string_view layout) { return layout.ends_with('m'); }

// Follows a layout (engine/lcm/message_layouts.py) through the bytes of a packet.
class Walk {
 public:
  Walk(std::span<const std::uint8_t> bytes, std::int32_t longest_text)
      : rest_(bytes), longest_text_(longest_text) {}

  bool at_end() const { return rest_.empty(); }

  // False if the bytes do not match the layout.
  bool follow(std::string_view fields) {
    std::int32_t count = 0;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      bool good = true;
      switch (fields[i]) {
        case 's':
          good = text(static_cast<std::int32_t>(std::min<std::size_t>(rest_.size(), INT32_MAX)));
          break;
        case 'n':
          good = text(longest_text_);
          break;
        case 'm':
          good = skip(kMacBytes);
          break;
        case 'c':
          good = number(count) && count >= 0;
          break;
        case '{': {
          const std::size_t end = end_of_group(fields, i);
          const std::string_view group = fields.substr(i + 1, end - i - 1);
          // Every group has at least one byte, so a false count ends at the end of the packet.
          for (std::int32_t k = 0; good && k < count; ++k) good = follow(group);
          i = end;
          break;
        }
        default:
          good = skip(static_cast<std::size_t>(fields[i] - '0'));
      }
      if (!good) return false;
    }
    return true;
  }

 private:
  static std::size_t end_of_group(std::string_view fields, std::size_t begin) {
    int depth = 0;
    std::size_t i = begin;
    do {
      depth += fields[i] == '{' ? 1 : fields[i] == '}' ? -1 : 0;
    } while (depth > 0 && ++i < fields.size());
    return i;
  }

  bool skip(std::size_t bytes) {
    if (rest_.size() < bytes) return false;
    rest_ = rest_.subspan(bytes);
    return true;
  }

  bool number(std::int32_t& value) {  // big-endian
    if (rest_.size() < 4) return false;
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 4; ++k) bits = bits << 8 | rest_[k];
    value = static_cast<std::int32_t>(bits);
    return skip(4);
  }

  // Its length includes the terminating zero.
  bool text(std::int32_t longest) {
    std::int32_t length = 0;
    if (!number(length) || length < 1 || length - 1 > longest) return false;
    const auto bytes = static_cast<std::size_t>(length);
    if (rest_.size() < bytes || rest_[bytes - 1] != 0) return false;
    const std::string_view content(reinterpret_cast<const char*>(rest_.data()), bytes - 1);
    return core::is_plain_text(content) && skip(bytes);
  }

  std::span<const std::uint8_t> rest_;
  std::int32_t longest_text_;
};

bool has_fingerprint(std::span<const std::uint8_t> packet, std::int64_t fingerprint) {
  if (packet.size() < kFingerprintBytes) return false;
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < kFingerprintBytes; ++k) bits = bits << 8 | packet[k];
  return bits == static_cast<std::uint64_t>(fingerprint);
}

// The protocol is the first field of a message of a channel. A shorter packet is malformed.
bool is_of_other_protocol(std::span<const std::uint8_t> packet) {
  if (packet.size() < kFingerprintBytes + 4) return false;
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < 4; ++k) bits = bits << 8 | packet[kFingerprintBytes + k];
  return bits != static_cast<std::uint32_t>(hello_t::PROTOCOL);
}

}  // namespace

const char* packet_problem_name(PacketProblem problem) {
  constexpr const char* kNames[] = {
      "none", "too large", "of another type", "of another protocol", "not authentic", "malformed"};
  return kNames[static_cast<std::size_t>(problem)];
}

template <class Message>
PacketProblem decode(std::span<const std::uint8_t> packet, const LiveKey* key,
                     Message& message) noexcept {
  const std::string_view layout = layout_of(message);
  if (packet.size() > static_cast<std::size_t>(Message::LARGEST_PACKET))
    return PacketProblem::too_large;
  if (!has_fingerprint(packet, Message::getHash())) return PacketProblem::wrong_type;
  if constexpr (requires { message.protocol; }) {
    if (is_of_other_protocol(packet)) return PacketProblem::other_protocol;
  }
  if (key != nullptr && is_signed(layout) && !authentic(packet, *key)) {
    return PacketProblem::not_authentic;
  }
  Walk walk(packet.subspan(kFingerprintBytes), longest_text(message));
  if (!walk.follow(layout) || !walk.at_end()) return PacketProblem::malformed;
  try {
    Message read{};  // new: the generated code does not clear lists without entries
    const int size = static_cast<int>(packet.size());
    if (read.decode(packet.data(), 0, size) != size) return PacketProblem::malformed;
    message = std::move(read);
  } catch (...) {  // out of memory
    return PacketProblem::malformed;
  }
  return PacketProblem::none;
}

template <class Message>
PacketBytes encode(Message message, const LiveKey* key) {
  settle(message);
  if constexpr (requires { message.protocol; }) message.protocol = hello_t::PROTOCOL;
  const std::string_view layout = layout_of(message);
  PacketBytes packet(static_cast<std::size_t>(message.getEncodedSize()));
  const int size = message.encode(packet.data(), 0, static_cast<int>(packet.size()));
  packet.resize(static_cast<std::size_t>(std::max(0, size)));
  if (!is_signed(layout) || packet.size() < kMacBytes) return packet;
  if (key != nullptr) return seal(std::move(packet), *key);
  std::fill(packet.end() - kMacBytes, packet.end(), std::uint8_t{0});
  return packet;
}

#define FOOTFALL_MESSAGE(type)                                                                  \
  template PacketProblem decode(std::span<const std::uint8_t>, const LiveKey*, type&) noexcept; \
  template PacketBytes encode(type, const LiveKey*);
FOOTFALL_PACKETS(FOOTFALL_MESSAGE)
#undef FOOTFALL_MESSAGE

}  // namespace footfall::engine
