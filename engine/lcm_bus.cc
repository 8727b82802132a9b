// LCM's C interface; see lcm_bus.h. Its errors go to stderr and its good() says little, so what can
// be known before is asked before: the URL's parts, the route.
#include "engine/lcm_bus.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <lcm/lcm.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <string_view>

namespace footfall::engine {
namespace {

constexpr int kQueued = 512;            // packets that wait for poll(), of one channel
constexpr int kMostAtOnce = 512;        // packets of one poll()
constexpr int kReceiveBytes = 2 << 20;  // asked of the kernel, unless the URL says otherwise

[[noreturn]] void refuse(const std::string& url, const std::string& why) {
  throw std::invalid_argument(
      fmt::format("'{}' {}; expected a URL such as '{}'", url, why, kLiveUrl));
}

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
      whole_number(url, value, "recv_buf_size", 1, 1 << 30);
    } else {
      refuse(url, fmt::format("has the option '{}', no 'ttl' or 'recv_buf_size'", name));
    }
    options.remove_prefix(std::min(end + 1, options.size()));
  }
}

// What LCM would print, as one error that says what to do.
void check_route(const LiveAddress& address) {
  const int probe = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(address.port));
  inet_pton(AF_INET, address.group.c_str(), &to.sin_addr);
  const bool good =
      probe >= 0 && ::connect(probe, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  const int problem = errno;
  if (probe >= 0) ::close(probe);
  if (good) return;
  throw std::runtime_error(fmt::format(
      "no network reaches {} ({}); on one host alone, `ip link set lo up; ip route add {} dev lo` "
      "(as root) gives it one",
      address.group, std::strerror(problem), address.group));
}

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
  ~Impl() {
    if (lcm != nullptr) lcm_destroy(lcm);
  }
  static void hand_over(const lcm_recv_buf_t* buffer, const char*, void* context) noexcept {
    try {
      (*static_cast<Handler*>(context))(
          {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    } catch (...) {  // an exception through LCM's C code would leave it unusable
    }
  }
  lcm_t* lcm = nullptr;
  std::deque<Handler> handlers;  // their places do not change
};

LcmBus::LcmBus(const std::string& url) : impl_(std::make_unique<Impl>()) {
  const LiveAddress address = parse_live_url(url);
  check_route(address);
  std::string full = fmt::format("udpm://{}:{}?ttl={}", address.group, address.port, address.ttl);
  const std::size_t size = url.find("recv_buf_size=");
  full += size == std::string::npos ? fmt::format("&recv_buf_size={}", kReceiveBytes)
                                    : "&" + url.substr(size, url.find('&', size) - size);
  impl_->lcm = lcm_create(full.c_str());
  if (impl_->lcm == nullptr) throw std::runtime_error("LCM cannot use '" + url + "'");
}

LcmBus::~LcmBus() = default;

void LcmBus::subscribe(const std::string& channel, Handler handler) {
  Handler& kept = impl_->handlers.emplace_back(std::move(handler));
  lcm_subscription_t* const subscription =
      lcm_subscribe(impl_->lcm, channel.c_str(), Impl::hand_over, &kept);
  if (subscription == nullptr) {
    throw std::runtime_error(
        "LCM hears nothing of what it sends: a firewall, or no route for multicast; on one host "
        "alone, `ip link set lo up; ip route add 239.255.76.67 dev lo` (as root) gives it one");
  }
  lcm_subscription_set_queue_capacity(subscription, kQueued);
}

bool LcmBus::publish(const std::string& channel, std::span<const std::uint8_t> packet) noexcept {
  return lcm_publish(impl_->lcm, channel.c_str(), packet.data(),
                     static_cast<unsigned>(packet.size())) == 0;
}

int LcmBus::poll(int milliseconds) noexcept {
  int handled = 0;
  while (handled < kMostAtOnce &&
         lcm_handle_timeout(impl_->lcm, handled == 0 ? milliseconds : 0) > 0) {
    ++handled;
  }
  return handled;
}

int LcmBus::file_descriptor() const noexcept { return lcm_get_fileno(impl_->lcm); }

}  // namespace footfall::engine
