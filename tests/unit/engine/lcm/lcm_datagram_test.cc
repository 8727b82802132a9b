// Datagrams: what LCM sends is read, in one or in parts; whatever else comes is counted.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "engine/lcm/bus.h"
#include "engine/lcm/datagram.h"
#include "tests/support/live_packets.h"
#include "tests/support/multicast.h"

namespace footfall::tests {
namespace {

using engine::LcmReader;
using Bytes = std::vector<std::uint8_t>;

void put(Bytes& to, std::uint32_t value, int bytes) {
  for (int k = bytes - 1; k >= 0; --k) to.push_back(static_cast<std::uint8_t>(value >> 8 * k));
}
void put(Bytes& to, const std::string& text) { to.insert(to.end(), text.begin(), text.end()); }

Bytes whole(const std::string& channel, const std::string& content) {
  Bytes datagram;
  put(datagram, "LC02");
  put(datagram, 7, 4);
  put(datagram, channel + '\0' + content);
  return datagram;
}

Bytes part(std::uint32_t message, const std::string& channel, const std::string& content,
           std::uint32_t begin, std::uint32_t end, std::uint16_t number, std::uint16_t count) {
  Bytes datagram;
  put(datagram, "LC03");
  put(datagram, message, 4);
  put(datagram, static_cast<std::uint32_t>(content.size()), 4);
  put(datagram, begin, 4);
  put(datagram, number, 2);
  put(datagram, count, 2);
  if (number == 0) put(datagram, channel + '\0');
  put(datagram, content.substr(begin, end - begin));
  return datagram;
}

std::string text(std::span<const std::uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

TEST(LcmReader, AMessageIsReadWithItsChannel) {
  LcmReader reader(0);
  const Bytes datagram = whole("FOOTFALL_HELLO", std::string("a\0b", 3));
  const auto message = reader.take(1, datagram);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel, "FOOTFALL_HELLO");
  EXPECT_EQ(text(message->content), std::string("a\0b", 3));
  EXPECT_TRUE(reader.take(1, whole("", "")));
  EXPECT_EQ(reader.strange(), 0);
}

TEST(LcmReader, PartsOfTwoSendersArePutTogether) {
  LcmReader reader(100);
  EXPECT_FALSE(reader.take(1, part(5, "A", "abcdef", 0, 2, 0, 3)));
  EXPECT_FALSE(reader.take(2, part(5, "B", "123", 0, 1, 0, 2)));
  EXPECT_FALSE(reader.take(1, part(5, "A", "abcdef", 2, 4, 1, 3)));
  const Bytes two = part(5, "B", "123", 1, 3, 1, 2), one = part(5, "A", "abcdef", 4, 6, 2, 3);
  const auto second = reader.take(2, two);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->channel, "B");
  EXPECT_EQ(text(second->content), "123");
  const auto first = reader.take(1, one);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->channel, "A");
  EXPECT_EQ(text(first->content), "abcdef");
  EXPECT_EQ(reader.strange(), 0);
}

TEST(LcmReader, WhatDoesNotFitTogetherIsCounted) {
  LcmReader reader(100);
  const std::string content = "abcdef";
  EXPECT_FALSE(reader.take(1, part(5, "A", content, 2, 4, 1, 3)));  // no first part
  EXPECT_FALSE(reader.take(1, part(5, "A", content, 0, 2, 0, 3)));
  EXPECT_FALSE(reader.take(1, part(6, "A", content, 2, 4, 1, 3)));  // of another message
  EXPECT_FALSE(reader.take(1, part(5, "A", content, 4, 6, 2, 3)));  // one is missing
  EXPECT_FALSE(reader.take(1, part(5, "A", content, 3, 5, 1, 3)));  // not where the first ended
  EXPECT_FALSE(reader.take(1, part(5, "A", content + "g", 2, 4, 1, 3)));          // of another size
  EXPECT_FALSE(reader.take(1, part(5, "A", content, 0, 2, 0, 0)));                // of no parts
  EXPECT_FALSE(reader.take(1, part(5, "A", std::string(101, 'a'), 0, 2, 0, 2)));  // too large
  EXPECT_EQ(reader.strange(), 7);
  EXPECT_FALSE(reader.take(1, Bytes{}));
  EXPECT_FALSE(reader.take(1, Bytes{'L', 'C', '0', '2', 0, 0, 0, 1, 'A'}));  // no zero
  EXPECT_FALSE(reader.take(1, whole(std::string(64, 'A'), "")));
  EXPECT_EQ(reader.strange(), 10);
  LcmReader small(0);
  EXPECT_FALSE(small.take(1, part(5, "A", content, 0, 6, 0, 1)));
  EXPECT_EQ(small.strange(), 1);
}

TEST(LcmReader, DamagedDatagramsDoNoHarm) {
  LcmReader reader(1000);
  RandomMessages random(3);
  const std::string content(300, 'x');
  for (int k = 0; k < 50'000; ++k) {
    const auto number = static_cast<std::uint16_t>(k % 3);
    const Bytes good = k % 4 == 0 ? whole("CHANNEL", content)
                                  : part(static_cast<std::uint32_t>(k / 3), "CHANNEL", content,
                                         number * 100U, number * 100U + 100U, number, 3);
    const Bytes damaged = k % 2 == 0 ? good : random.damaged(good);
    const auto message = reader.take(static_cast<std::uint64_t>(k % 12), damaged);
    if (message) {
      ASSERT_LE(message->content.size(), 1000U);
    }
  }
  EXPECT_GT(reader.strange(), 0);
}

// LCM's own publisher, with one datagram and with four.
TEST(LcmReader, WhatLcmPublishesArrives) {
  std::random_device device;
  const int port = std::uniform_int_distribution<int>(20'000, 60'000)(device);
  const std::string url = "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0";
  if (!multicast_works()) GTEST_SKIP() << kNoMulticast;
  engine::LcmBus sending(url), hearing(url, 1'000'000);
  std::vector<Bytes> heard;
  hearing.subscribe("DATA", [&](auto packet) { heard.emplace_back(packet.begin(), packet.end()); });
  for (const std::size_t size : {0U, 10U, 60'000U, 200'000U}) {
    Bytes sent(size);
    std::iota(sent.begin(), sent.end(), std::uint8_t{1});
    ASSERT_TRUE(sending.publish("OTHER", sent));
    ASSERT_TRUE(sending.publish("DATA", sent));
    heard.clear();
    for (int k = 0; k < 100 && heard.empty(); ++k) hearing.poll(50);
    ASSERT_EQ(heard.size(), 1U) << size;
    EXPECT_EQ(heard[0], sent) << size;
  }
}

}  // namespace
}  // namespace footfall::tests
