// The door to LCM: a multicast address to publish on and to hear, whose packets are handed over as
// bytes. LCM publishes; what arrives is read here (see datagram.h for the reason). One thread a
// bus.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace footfall::engine {

inline constexpr const char* kLiveUrl = "udpm://239.255.76.67:7667?ttl=0";
inline constexpr const char* kLivePrefix = "FOOTFALL";

// Where packets go.
struct LiveAddress {
  std::string group;  // 239.255.76.67
  int port = 7667;
  int ttl = 0;                  // routers that may be passed, plus one; 0: packets stay on the host
  int receive_bytes = 2 << 20;  // asked of the kernel, for what waits to be read
};

// `udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES`, all of it optional from the group on. Throws
// std::invalid_argument with one sentence.
LiveAddress parse_live_url(const std::string& url);
// The first part of the channels' names. Throws likewise.
void check_live_prefix(const std::string& prefix);

class LcmBus {
 public:
  using Handler = std::function<void(std::span<const std::uint8_t> packet)>;

  // Throws what parse_live_url() throws, and std::runtime_error (no such network here, and what to
  // do about it).
  // Hears messages of more than one datagram (64 kB) if they have at most `largest` bytes.
  explicit LcmBus(const std::string& url, std::size_t largest = 0);
  ~LcmBus();
  LcmBus(const LcmBus&) = delete;
  LcmBus& operator=(const LcmBus&) = delete;

  // The handler is called in poll(); what it throws is dropped.
  void subscribe(const std::string& channel, Handler handler);
  // False: it could not be sent.
  bool publish(const std::string& channel, std::span<const std::uint8_t> packet) noexcept;
  // Hands over what is there; waits at most `milliseconds` for the first. Returns how many.
  int poll(int milliseconds) noexcept;
  // Readable when there is something for poll().
  int file_descriptor() const noexcept;
  // Datagrams that were no LCM messages.
  std::int64_t strange() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::engine
