// The only use of LCM: publishes on and receives from a multicast address; packets are byte
// sequences. LCM publishes; packets are received here (datagram.h gives the reason). One thread per
// bus.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace footfall::engine {

// The address without one on the command line: $LCM_DEFAULT_URL, as in all tools of LCM, else this
// host alone.
std::string default_url();
inline constexpr const char* kLiveUrl = "udpm://239.255.76.67:7667?ttl=0";
inline constexpr const char* kLivePrefix = "FOOTFALL";

// Destination of packets.
struct LiveAddress {
  std::string group;  // 239.255.76.67
  int port = 7667;
  int ttl = 0;                  // routers that may be passed, plus one; 0: only this host
  int receive_bytes = 2 << 20;  // requested size of the kernel's receive buffer
};

// `udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES`, all parts from the group on are optional. Throws
// std::invalid_argument with one sentence.
LiveAddress parse_live_url(const std::string& url);
// Checks a prefix of channel names. Throws like parse_live_url().
void check_live_prefix(const std::string& prefix);

class LcmBus {
 public:
  using Handler = std::function<void(std::span<const std::uint8_t> packet)>;

  // Throws like parse_live_url(), or std::runtime_error if the network is not available, with the
  // remedy. Messages of more than one datagram (64 kB) are received up to `largest` bytes.
  explicit LcmBus(const std::string& url, std::size_t largest = 0);
  ~LcmBus();
  LcmBus(const LcmBus&) = delete;
  LcmBus& operator=(const LcmBus&) = delete;

  // Sets the handler called in poll(); its exceptions are ignored.
  void subscribe(const std::string& channel, Handler handler);
  // False if sending failed.
  bool publish(const std::string& channel, std::span<const std::uint8_t> packet) noexcept;
  // Handles waiting messages; waits at most `milliseconds` for the first one. Returns their number.
  int poll(int milliseconds) noexcept;
  // Readable when poll() has messages to handle.
  int file_descriptor() const noexcept;
  // Number of malformed datagrams.
  std::int64_t strange() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::engine
