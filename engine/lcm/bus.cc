// Receives on its own socket and publishes through LCM's C interface; see bus.h. LCM prints errors
// to stderr, so URL and route are checked before it is called.
#include "engine/lcm/bus.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <lcm/lcm.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "core/process/machine_error.h"
#include "engine/lcm/datagram.h"

namespace footfall::engine {
namespace {

constexpr int kMostAtOnce = 512;                  // maximum number of messages of one poll()
constexpr std::size_t kLargestDatagram = 65'536;  // bytes

[[noreturn]] void refuse(const std::string& url, const std::string& why) {
  throw std::invalid_argument(
      fmt::format("'{}' {}; expected a URL such as '{}'", url, why, kLiveUrl));
}

}  // namespace

std::string default_url() {
  const char* const variable = std::getenv("LCM_DEFAULT_URL");
  return variable != nullptr && *variable != '\0' ? variable : kLiveUrl;
}

namespace {

int whole_number(const std::string& url, std::string_view text, const char* what, int least,
                 int most) {
  int value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() || value < least || value > most) {
    refuse(url, fmt::format("has the {} '{}', no number from {} to {}", what, text, least, most));
  }
  return value;
}

bool is_multicast(const std::string& group) {
  in_addr address{};
  return inet_pton(AF_INET, group.c_str(), &address) == 1 && IN_MULTICAST(ntohl(address.s_addr));
}

// `ttl=1&recv_buf_size=4000000`
void read_options(const std::string& url, std::string_view options, LiveAddress& address) {
  while (!options.empty()) {
    const std::size_t end = std::min(options.find('&'), options.size());
    const std::string_view option = options.substr(0, end);
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string_view name = option.substr(0, equals);
    const std::string_view value = option.substr(std::min(equals + 1, option.size()));
    if (name == "ttl") {
      address.ttl = whole_number(url, value, "ttl", 0, 255);
    } else if (name == "recv_buf_size") {
      address.receive_bytes = whole_number(url, value, "recv_buf_size", 1, 1 << 30);
    } else {
      refuse(url, fmt::format("has the option '{}', no 'ttl' or 'recv_buf_size'", name));
    }
    options.remove_prefix(std::min(end + 1, options.size()));
  }
}

sockaddr_in socket_address(const LiveAddress& address) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(address.port));
  inet_pton(AF_INET, address.group.c_str(), &to.sin_addr);
  return to;
}

class Socket {
 public:
  explicit Socket(const LiveAddress& address) : address_(address) {
    fd_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (fd_ < 0) fail();
  }
  ~Socket() { ::close(fd_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int fd() const { return fd_; }

  // Asks the system's routing tables only: nothing is sent.
  void check_route() const {
    const sockaddr_in to = socket_address(address_);
    if (::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) fail();
  }

  // Bound to the group address, so that it receives neither other groups nor unicast packets to
  // this host.
  void join() const {
    const sockaddr_in from = socket_address(address_);
    const int on = 1;
    ip_mreq group{};
    group.imr_multiaddr = from.sin_addr;
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &address_.receive_bytes, sizeof(int));
    if (::setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
        ::bind(fd_, reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0 ||
        ::setsockopt(fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0) {
      fail();
    }
  }

 private:
  [[noreturn]] void fail() const {
    const char* const why = std::strerror(errno);
    throw core::MachineError(fmt::format(
        "no network reaches {} ({}); on one host alone, `ip link set lo up; ip route add {} dev "
        "lo` (as root) gives it one",
        address_.group, why, address_.group));
  }
  LiveAddress address_;
  int fd_ = -1;
};

}  // namespace

LiveAddress parse_live_url(const std::string& url) {
  constexpr std::string_view kScheme = "udpm://";
  if (!url.starts_with(kScheme)) refuse(url, "is of no network that live tuning can use");
  std::string_view rest = url;
  rest.remove_prefix(kScheme.size());
  LiveAddress address;
  const std::size_t question = std::min(rest.find('?'), rest.size());
  const std::string_view place = rest.substr(0, question);
  const std::size_t colon = std::min(place.find(':'), place.size());
  address.group = place.substr(0, colon);
  if (address.group.empty()) address.group = "239.255.76.67";
  if (!is_multicast(address.group)) {
    refuse(url, "names '" + address.group + "', no multicast address (224.0.0.0 to " +
                    "239.255.255.255)");
  }
  if (colon < place.size()) {
    address.port = whole_number(url, place.substr(colon + 1), "port", 1, 65535);
  }
  read_options(url, rest.substr(std::min(question + 1, rest.size())), address);
  return address;
}

void check_live_prefix(const std::string& prefix) {
  const bool good =
      !prefix.empty() && prefix.size() <= 40 && std::ranges::all_of(prefix, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_';
      });
  if (good) return;
  throw std::invalid_argument("'" + prefix +
                              "' cannot begin the names of channels: expected 1 to 40 letters, "
                              "digits and '_'");
}

struct LcmBus::Impl {
  Impl(const LiveAddress& address, std::size_t largest)
      : socket(address), reader(largest), buffer(kLargestDatagram) {}
  ~Impl() {
    if (lcm != nullptr) lcm_destroy(lcm);
  }

  // Handles the next waiting message; false if there is none.
  bool take() {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t bytes = ::recvfrom(socket.fd(), buffer.data(), buffer.size(), 0,
                                     reinterpret_cast<sockaddr*>(&from), &size);
    if (bytes < 0) return false;
    const std::uint64_t sender =
        std::uint64_t{ntohl(from.sin_addr.s_addr)} << 16 | ntohs(from.sin_port);
    const auto message =
        reader.take(sender, std::span(buffer).first(static_cast<std::size_t>(bytes)));
    if (!message) return true;
    for (auto& [channel, handler] : handlers) {
      if (channel == message->channel) handler(message->content);
    }
    return true;
  }

  Socket socket;
  LcmReader reader;
  std::vector<std::uint8_t> buffer;
  lcm_t* lcm = nullptr;
  std::vector<std::pair<std::string, Handler>> handlers;
};

LcmBus::LcmBus(const std::string& url, std::size_t largest) {
  const LiveAddress address = parse_live_url(url);
  Socket(address).check_route();
  impl_ = std::make_unique<Impl>(address, largest);
  impl_->socket.join();
  const std::string full =
      fmt::format("udpm://{}:{}?ttl={}", address.group, address.port, address.ttl);
  impl_->lcm = lcm_create(full.c_str());
  if (impl_->lcm == nullptr) throw core::MachineError("LCM cannot use '" + url + "'");
}

LcmBus::~LcmBus() = default;

void LcmBus::subscribe(const std::string& channel, Handler handler) {
  impl_->handlers.emplace_back(channel, std::move(handler));
}

bool LcmBus::publish(const std::string& channel, std::span<const std::uint8_t> packet) noexcept {
  return lcm_publish(impl_->lcm, channel.c_str(), packet.data(),
                     static_cast<unsigned>(packet.size())) == 0;
}

int LcmBus::poll(int milliseconds) noexcept {
  pollfd waiting = {impl_->socket.fd(), POLLIN, 0};
  if (::poll(&waiting, 1, milliseconds) <= 0) return 0;
  int handled = 0;
  for (bool more = true; more && handled < kMostAtOnce;) {
    try {
      more = impl_->take();
    } catch (...) {  // from a handler or an allocation: that message is lost
    }
    handled += more ? 1 : 0;
  }
  return handled;
}

int LcmBus::file_descriptor() const noexcept { return impl_->socket.fd(); }
std::int64_t LcmBus::strange() const noexcept { return impl_->reader.strange(); }

}  // namespace footfall::engine
