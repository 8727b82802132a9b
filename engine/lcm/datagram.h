// Assembles LCM messages from untrusted datagrams. LCM's own reader (1.3.1) terminates the process
// for some malformed ones, which must not happen beside a robot. Source: LCM documentation, "UDP
// Multicast Protocol".
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
  // Messages of several datagrams are assembled up to `largest` bytes; 0: never. Memory grows only
  // with the data received.
  explicit LcmReader(std::size_t largest) : largest_(largest) {}

  // The message completed by this datagram, if any; valid until the next call. Fragments are
  // accepted only in order, from one sender (a number that identifies it), for one message at a
  // time.
  std::optional<LcmMessage> take(std::uint64_t sender, std::span<const std::uint8_t> datagram);
  // Number of datagrams that are malformed or belong to an unassembled message.
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
  std::array<Parts, 8> parts_;  // for several concurrent senders
  std::size_t oldest_ = 0;
  std::int64_t strange_ = 0;
};

}  // namespace footfall::engine
