// LCM's messages out of the datagrams that carry them, as anybody may have sent them. LCM's own
// reader (1.3.1) ends the process at some that are damaged, which must not happen beside a robot.
// Source: LCM documentation, "UDP Multicast Protocol".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace footfall::engine {

struct LcmMessage {
  std::string_view channel;
  std::span<const std::uint8_t> content;
};

class LcmReader {
 public:
  // Of messages that come in several datagrams, those with at most so many bytes are put together;
  // 0: none. What is kept of them is no more than has arrived.
  explicit LcmReader(std::size_t largest) : largest_(largest) {}

  // A message if the datagram completes one; valid until the next call. Parts count as they come:
  // in order, from one sender (a number that tells them apart), of one message at a time.
  std::optional<LcmMessage> take(std::uint64_t sender, std::span<const std::uint8_t> datagram);
  // Datagrams that are no part of an LCM message, or of one that is not put together.
  std::int64_t strange() const noexcept { return strange_; }

 private:
  struct Parts {
    std::uint64_t sender = 0;
    std::uint32_t message = 0, size = 0;
    std::uint16_t next = 0, count = 0;  // parts; count 0: free
    std::string channel;
    std::vector<std::uint8_t> content;
  };
  std::optional<LcmMessage> take_part(std::uint64_t sender, std::span<const std::uint8_t> rest);
  Parts* parts_of(std::uint64_t sender);

  std::size_t largest_;
  std::array<Parts, 8> parts_;  // of as many senders
  std::size_t oldest_ = 0;
  std::int64_t strange_ = 0;
};

}  // namespace footfall::engine
