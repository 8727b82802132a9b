// Random messages of live tuning, and packets that were damaged on their way: for tests, and for
// the program that attacks an engine.
#pragma once

#include <cstdint>
#include <cstring>
#include <footfall_lcm/answer_t.hpp>
#include <footfall_lcm/catalogue_t.hpp>
#include <footfall_lcm/hello_t.hpp>
#include <footfall_lcm/request_t.hpp>
#include <footfall_lcm/telemetry_t.hpp>
#include <footfall_lcm/values_t.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace footfall::tests {

class RandomMessages {
 public:
  explicit RandomMessages(std::uint64_t seed) : random_(seed) {}

  // 0 ... most
  int below(int most) { return std::uniform_int_distribution<int>(0, most)(random_); }
  std::int64_t integer() { return static_cast<std::int64_t>(random_()); }
  double number() {
    switch (below(9)) {
      case 0:
        return std::numeric_limits<double>::quiet_NaN();
      case 1:
        return -std::numeric_limits<double>::infinity();
      default:
        return std::normal_distribution<double>(0.0, 100.0)(random_);
    }
  }
  std::string text() {
    static const std::vector<std::string> kPieces = {
        "lift_time", "gains.single.swing.kp", " ", "°", "步", "𝕗", "a", "\n", "goal[1]"};
    std::string text;
    for (int k = below(3); k > 0; --k) {
      text += kPieces[static_cast<std::size_t>(below(static_cast<int>(kPieces.size()) - 1))];
    }
    return text;
  }
  std::vector<std::string> texts() {
    return list<std::string>([this] { return text(); });
  }
  std::vector<double> numbers() {
    return list<double>([this] { return number(); });
  }

  template <class T, class Make>
  std::vector<T> list(Make make) {
    std::vector<T> all;
    for (int k = below(5); k > 0; --k) all.push_back(make());
    return all;
  }

  void fill(footfall_lcm::hello_t& m) { m.client = integer(); }
  void fill(footfall_lcm::change_t& m) {
    m.name = text();
    m.component = below(3) - 1;
    m.values = numbers();
  }
  void fill(footfall_lcm::request_t& m) {
    m.session = integer();
    m.client = integer();
    m.sequence = integer();
    m.what = static_cast<std::int8_t>(below(3));
    m.who = text();
    m.over = number();
    m.revision = below(9) - 1;
    m.changes = list<footfall_lcm::change_t>([this] { return some<footfall_lcm::change_t>(); });
    m.events = texts();
  }
  void fill(footfall_lcm::answer_t& m) {
    m.session = integer();
    m.client = integer();
    m.sequence = integer();
    m.who = text();
    m.accepted = static_cast<std::int8_t>(below(1));
    m.tick = integer();
    m.revision = integer();
    m.text = text();
    m.reasons = texts();
  }
  void fill(footfall_lcm::parameter_t& m) {
    m.name = text();
    m.first = below(99);
    m.size = below(9);
    m.unit = text();
    m.has_range = static_cast<std::int8_t>(below(1));
    m.min = number();
    m.max = number();
    m.gain = static_cast<std::int8_t>(below(1));
    m.doc = text();
  }
  void fill(footfall_lcm::catalogue_t& m) {
    m.session = integer();
    m.generation = below(9);
    m.revision = below(9);
    m.behavior = text();
    m.path = text();
    m.robot = text();
    m.rate = number();
    m.keyed = static_cast<std::int8_t>(below(1));
    m.parameters =
        list<footfall_lcm::parameter_t>([this] { return some<footfall_lcm::parameter_t>(); });
    m.values = numbers();
    m.events = texts();
    for (std::size_t k = 0; k < m.events.size(); ++k) m.event_docs.push_back(text());
    m.states = texts();
    m.tasks = texts();
    m.feet = texts();
    m.signals = texts();
    for (std::size_t k = 0; k < m.signals.size(); ++k) m.signal_units.push_back(text());
    m.faults = texts();
  }
  void fill(footfall_lcm::values_t& m) {
    m.session = integer();
    m.generation = integer();
    m.revision = integer();
    m.tick = integer();
    m.undo_count = below(9);
    m.redo_count = below(9);
    m.now = numbers();
    for (std::size_t k = 0; k < m.now.size(); ++k) m.target.push_back(number());
  }
  void fill(footfall_lcm::telemetry_t& m) {
    m.session = integer();
    m.generation = integer();
    m.revision = integer();
    m.tick = integer();
    m.time = number();
    m.condition = static_cast<std::int8_t>(below(3));
    m.dropped = integer();
    m.active = list<std::int32_t>([this] { return below(99); });
    m.tasks = list<footfall_lcm::task_t>([this] {
      return footfall_lcm::task_t{below(99), number(), number()};
    });
    m.forces = list<std::vector<double>>([this] {
      return std::vector<double>{number(), number(), number()};
    });
    m.faults = list<std::int64_t>([this] { return integer(); });
    m.tick_us = static_cast<float>(below(999));
    m.tick_us_worst = static_cast<float>(below(999));
    m.signals = list<float>([this] { return static_cast<float>(number()); });
  }

  // A message of a type, its counts and `mac` left alone.
  template <class Message>
  Message some() {
    Message message{};
    fill(message);
    return message;
  }

  // One to three kinds of damage: bits, bytes, numbers where a count or length may be, a piece
  // dropped, doubled or put in, the end cut off. Now and then the packet stays what it was.
  std::vector<std::uint8_t> damaged(std::vector<std::uint8_t> packet) {
    for (int k = 1 + below(2); k > 0; --k) damage(packet);
    return packet;
  }

 private:
  void damage(std::vector<std::uint8_t>& packet) {
    if (packet.empty()) {
      packet.push_back(static_cast<std::uint8_t>(below(255)));
      return;
    }
    const auto place = static_cast<std::size_t>(below(static_cast<int>(packet.size()) - 1));
    const auto rest = static_cast<int>(packet.size() - place);
    const auto from = packet.begin() + static_cast<std::ptrdiff_t>(place);
    switch (below(7)) {
      case 0:
        packet[place] ^= static_cast<std::uint8_t>(1 << below(7));
        break;
      case 1:
        packet[place] = static_cast<std::uint8_t>(below(255));
        break;
      case 2:
      case 3:
        put_count(packet, place);
        break;
      case 4:
        packet.resize(place);
        break;
      case 5:
        packet.erase(from, from + 1 + below(std::min(rest, 16) - 1));
        break;
      case 6: {
        const std::vector<std::uint8_t> piece(from, from + 1 + below(std::min(rest, 32) - 1));
        packet.insert(packet.begin() + below(static_cast<int>(packet.size())), piece.begin(),
                      piece.end());
        break;
      }
      default:
        packet.insert(from, static_cast<std::size_t>(1 + below(7)),
                      static_cast<std::uint8_t>(below(255)));
    }
  }

  void put_count(std::vector<std::uint8_t>& packet, std::size_t place) {
    constexpr std::int32_t kCounts[] = {-1, 0,       1,       2,         3,         16,
                                        17, 255,     65536,   INT32_MAX, INT32_MIN, 0x7fffff,
                                        -8, 1 << 28, 1 << 20, 0x01010101};
    const auto bits = static_cast<std::uint32_t>(kCounts[below(std::size(kCounts) - 1)]);
    for (std::size_t k = 0; k < 4 && place + k < packet.size(); ++k) {
      packet[place + k] = static_cast<std::uint8_t>(bits >> (24 - 8 * k));
    }
  }

  std::mt19937_64 random_;
};

}  // namespace footfall::tests
