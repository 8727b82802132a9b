// Floods the channels that an engine listens to with damaged packets: of messages at random, of
// edits that would be valid, with the engine's key, another one and none; and the network itself
// with damaged datagrams. Nothing of it may change anything. Prints what was sent as JSON.
//   --url URL --prefix NAME --key FILE --count N (on each channel) --datagrams N --forge N --rate R
//   --seed S
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/lcm/bus.h"
#include "engine/live/codec.h"
#include "tests/runs/live/options.h"
#include "tests/runs/live/random_edits.h"
#include "tests/support/live_packets.h"

namespace footfall::tests {
namespace {

using namespace footfall_lcm;
using engine::PacketBytes;
using Clock = std::chrono::steady_clock;

class Attack {
 public:
  explicit Attack(const Options& options)
      : options_(options),
        settings_(options.client()),
        client_(settings_),
        bus_(settings_.url.empty() ? engine::kLiveUrl : settings_.url),
        random_(static_cast<std::uint64_t>(options.number("--seed", 1))) {
    connect_or_exit(client_);
    edits_ = std::make_unique<RandomEdits>(client_.catalogue(), 1);
    other_key_.fill(9);
  }

  nlohmann::json run() {
    const auto count = static_cast<std::int64_t>(options_.number("--count", 1000));
    const auto datagrams = static_cast<std::int64_t>(options_.number("--datagrams", 0));
    for (std::int64_t k = 0; k < count; ++k) {
      bus_.publish(settings_.prefix + "_REQUEST", request());
      bus_.publish(settings_.prefix + "_HELLO", hello());
      pace(k);
    }
    for (std::int64_t k = 0; k < datagrams; ++k) {
      send_datagram();
      pace(k);
    }
    const auto forged = static_cast<std::int64_t>(options_.number("--forge", 0));
    for (std::int64_t k = 0; k < forged; ++k) {
      forge();
      pace(k);
    }
    return {{"packets_on_each_channel", count}, {"datagrams", datagrams}, {"forged", forged}};
  }

 private:
  // Bursts of 8, so that sleeping is worth its while.
  void pace(std::int64_t k) {
    if (k == 0) begin_ = Clock::now();
    if (k % 8 != 7) return;
    const auto due =
        std::chrono::duration<double>(static_cast<double>(k) / options_.number("--rate", 4000.0));
    std::this_thread::sleep_until(begin_ + std::chrono::duration_cast<Clock::duration>(due));
    client_.poll(0.0);
  }

  // Half of what a right key signs is damaged before: it passes the key and must fail later. None
  // of it is of the engine's session.
  PacketBytes request() {
    switch (random_.below(3)) {
      case 0: {  // an edit that was recorded on its way, damaged
        request_t edit = edits_->valid();
        edit.session = client_.catalogue().session;
        edit.client = 5;
        edit.sequence = ++sequence_;
        const PacketBytes packet = engine::encode(edit, key());
        PacketBytes damaged = random_.damaged(packet);
        while (damaged == packet) damaged = random_.damaged(packet);
        return damaged;
      }
      case 1:  // signed by somebody else, or not at all
        return random_.damaged(
            engine::encode(edits_->valid(), random_.below(1) == 0 ? &other_key_ : nullptr));
      case 2:  // of somebody who has the key, and a broken tool
        return signed_again(random_.damaged(engine::encode(random_.some<request_t>(), key())));
      default:  // another type
        return random_.damaged(engine::encode(random_.some<values_t>(), key()));
    }
  }

  // A valid edit of this session, by somebody who hears everything but has no key.
  void forge() {
    request_t edit = edits_->valid();
    edit.session = client_.catalogue().session;
    edit.client = 6;
    edit.sequence = ++sequence_;
    bus_.publish(settings_.prefix + "_REQUEST",
                 engine::encode(edit, random_.below(1) == 0 ? &other_key_ : nullptr));
  }

  PacketBytes hello() {
    return random_.below(9) == 0
               ? random_.damaged(engine::encode(random_.some<request_t>(), key()))
               : random_.damaged(engine::encode(random_.some<hello_t>(), nullptr));
  }

  PacketBytes signed_again(PacketBytes packet) { return engine::seal(std::move(packet), *key()); }

  // LCM's own headers: small messages `LC02`, number, channel, bytes; and parts of large ones
  // `LC03`, number, size, offset, part, parts, channel, bytes.
  void send_datagram() {
    PacketBytes datagram;
    const auto put = [&](std::uint32_t value, int bytes) {
      for (int k = bytes - 1; k >= 0; --k) {
        datagram.push_back(static_cast<std::uint8_t>(value >> 8 * k));
      }
    };
    const bool part = random_.below(1) == 0;
    put(part ? 0x4c433033 : 0x4c433032, 4);
    put(static_cast<std::uint32_t>(random_.below(50)), 4);
    const PacketBytes content = engine::encode(random_.some<request_t>(), nullptr);
    if (part) {
      put(static_cast<std::uint32_t>(content.size() * 2), 4);
      put(static_cast<std::uint32_t>(random_.below(1) == 0 ? 0 : content.size()), 4);
      put(static_cast<std::uint32_t>(random_.below(1)), 2);
      put(2, 2);
    }
    for (const char c : settings_.prefix + "_REQUEST")
      datagram.push_back(static_cast<std::uint8_t>(c));
    datagram.push_back(0);
    datagram.insert(datagram.end(), content.begin(), content.end());
    datagram = random_.damaged(std::move(datagram));
    if (socket_ < 0) open_socket();
    ::sendto(socket_, datagram.data(), datagram.size(), 0,
             reinterpret_cast<const sockaddr*>(&address_), sizeof address_);
  }

  void open_socket() {
    const engine::LiveAddress to =
        engine::parse_live_url(settings_.url.empty() ? engine::kLiveUrl : settings_.url);
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const int ttl = to.ttl;
    ::setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
    address_.sin_family = AF_INET;
    address_.sin_port = htons(static_cast<std::uint16_t>(to.port));
    inet_pton(AF_INET, to.group.c_str(), &address_.sin_addr);
  }

  const engine::LiveKey* key() const { return &*settings_.key; }

  const Options& options_;
  engine::LiveClientSettings settings_;
  engine::LiveClient client_;
  engine::LcmBus bus_;
  RandomMessages random_;
  std::unique_ptr<RandomEdits> edits_;
  engine::LiveKey other_key_{};
  std::int64_t sequence_ = 0;
  int socket_ = -1;
  sockaddr_in address_{};
  Clock::time_point begin_;
};

}  // namespace
}  // namespace footfall::tests

int main(int argc, char** argv) {
  const footfall::tests::Options options(argc, argv);
  try {
    std::printf("%s\n", footfall::tests::Attack(options).run().dump().c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
