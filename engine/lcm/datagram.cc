// LCM datagrams, numbers big-endian; see datagram.h.
//   complete message: LC02, number, channel and a zero, content
//   fragment:         LC03, number, size of the complete content, offset of this fragment in it,
//                     number of the fragment, number of fragments (2 bytes each), in the first
//                     fragment the channel and a zero, content
#include "engine/lcm/datagram.h"

#include <algorithm>

namespace footfall::engine {
namespace {

constexpr std::uint32_t kWhole = 0x4c433032, kPart = 0x4c433033;
constexpr std::size_t kWholeHead = 8, kPartHead = 20;
constexpr std::size_t kLongestChannel = 63;

std::uint32_t number(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size = 4) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < size; ++k) value = value << 8 | bytes[at + k];
  return value;
}

// Removes the zero-terminated channel name from the front; nullopt if malformed.
std::optional<std::string_view> take_channel(std::span<const std::uint8_t>& rest) {
  const auto longest = rest.first(std::min(rest.size(), kLongestChannel + 1));
  const auto end = std::find(longest.begin(), longest.end(), 0);
  if (end == longest.end()) return std::nullopt;
  const auto size = static_cast<std::size_t>(end - longest.begin());
  const std::string_view name(reinterpret_cast<const char*>(rest.data()), size);
  rest = rest.subspan(size + 1);
  return name;
}

}  // namespace

std::optional<LcmMessage> LcmReader::take(std::uint64_t sender,
                                          std::span<const std::uint8_t> datagram) {
  if (datagram.size() >= kWholeHead && number(datagram, 0) == kWhole) {
    auto rest = datagram.subspan(kWholeHead);
    if (const auto channel = take_channel(rest)) return LcmMessage{*channel, rest};
  } else if (largest_ > 0 && datagram.size() >= kPartHead && number(datagram, 0) == kPart) {
    return take_part(sender, datagram);
  }
  ++strange_;
  return std::nullopt;
}

LcmReader::Parts* LcmReader::parts_of(std::uint64_t sender) {
  const auto found = std::ranges::find_if(
      parts_, [&](const Parts& p) { return p.count > 0 && p.sender == sender; });
  return found == parts_.end() ? nullptr : &*found;
}

std::optional<LcmMessage> LcmReader::take_part(std::uint64_t sender,
                                               std::span<const std::uint8_t> datagram) {
  const std::uint32_t message = number(datagram, 4), size = number(datagram, 8),
                      begin = number(datagram, 12);
  const auto part = static_cast<std::uint16_t>(number(datagram, 16, 2));
  const auto count = static_cast<std::uint16_t>(number(datagram, 18, 2));
  auto rest = datagram.subspan(kPartHead);
  Parts* parts = parts_of(sender);
  if (part == 0) {
    const auto channel = take_channel(rest);
    if (channel && count > 0 && size <= largest_) {
      if (parts == nullptr) parts = &parts_[oldest_++ % parts_.size()];
      *parts = {sender, message, size, 0, count, std::string(*channel), {}};
    } else {
      parts = nullptr;
    }
  }
  const bool fits = parts != nullptr && parts->message == message && parts->size == size &&
                    parts->count == count && parts->next == part &&
                    parts->content.size() == begin && rest.size() <= size - begin;
  if (!fits) {
    ++strange_;
    return std::nullopt;
  }
  parts->content.insert(parts->content.end(), rest.begin(), rest.end());
  if (++parts->next < count) return std::nullopt;
  parts->count = 0;
  if (parts->content.size() == size) return LcmMessage{parts->channel, parts->content};
  ++strange_;
  return std::nullopt;
}

}  // namespace footfall::engine
