// Packets: what is sent arrives as it was, what is damaged is refused or is well formed, and
// nothing that announces much makes room for it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/live/codec.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/live_packets.h"

namespace footfall::tests {
namespace {

using namespace footfall_lcm;
using engine::decode;
using engine::encode;
using engine::LiveKey;
using engine::PacketBytes;
using engine::PacketProblem;

constexpr std::size_t kMac = 32;

LiveKey some_key(std::uint8_t first) {
  LiveKey key{};
  for (std::size_t k = 0; k < key.size(); ++k) key[k] = static_cast<std::uint8_t>(first + 7 * k);
  return key;
}

template <class Message>
class LiveCodec : public testing::Test {
 protected:
  RandomMessages random{1};
};
using Messages = testing::Types<hello_t, request_t, answer_t, catalogue_t, values_t, telemetry_t>;
TYPED_TEST_SUITE(LiveCodec, Messages);

TYPED_TEST(LiveCodec, WhatIsSentArrivesAsItWas) {
  const LiveKey key = some_key(3);
  for (int k = 0; k < 300; ++k) {
    const PacketBytes sent = encode(this->random.template some<TypeParam>(), &key);
    TypeParam read;
    ASSERT_EQ(decode(sent, &key, read), PacketProblem::none);
    ASSERT_EQ(encode(read, &key), sent);
  }
}

TYPED_TEST(LiveCodec, EveryBeginningOfAPacketIsRefused) {
  PacketBytes packet = encode(this->random.template some<TypeParam>(), nullptr);
  TypeParam read;
  for (std::size_t size = 0; size < packet.size(); ++size) {
    ASSERT_NE(decode(std::span(packet).first(size), nullptr, read), PacketProblem::none) << size;
  }
  packet.push_back(0);
  EXPECT_EQ(decode(packet, nullptr, read), PacketProblem::malformed);
}

// Accepted is only what an encoder could have written: the same bytes come out again.
TYPED_TEST(LiveCodec, ADamagedPacketIsRefusedOrWellFormed) {
  int refused = 0;
  PacketBytes packet;
  for (int k = 0; k < 20'000; ++k) {
    if (k % 50 == 0) packet = encode(this->random.template some<TypeParam>(), nullptr);
    const PacketBytes damaged = this->random.damaged(packet);
    TypeParam read;
    if (decode(damaged, nullptr, read) != PacketProblem::none) {
      ++refused;
      continue;
    }
    PacketBytes again = encode(read, nullptr);
    ASSERT_EQ(again.size(), damaged.size());
    // All but the mac, which is not looked at without a key.
    const std::size_t own =
        std::is_same_v<TypeParam, hello_t> || std::is_same_v<TypeParam, telemetry_t>
            ? again.size()
            : again.size() - kMac;
    ASSERT_TRUE(std::equal(again.begin(), again.begin() + static_cast<std::ptrdiff_t>(own),
                           damaged.begin()));
  }
  EXPECT_GT(refused, 2'000);
}

TYPED_TEST(LiveCodec, APacketOfAnotherTypeIsRefused) {
  TypeParam read;
  const PacketBytes other = std::is_same_v<TypeParam, hello_t>
                                ? encode(this->random.template some<request_t>(), nullptr)
                                : encode(this->random.template some<hello_t>(), nullptr);
  EXPECT_NE(decode(other, nullptr, read), PacketProblem::none);
  EXPECT_EQ(decode({}, nullptr, read), PacketProblem::wrong_type);
}

TEST(LiveCodecKeys, WithAKeyNoOtherPacketPasses) {
  const LiveKey key = some_key(1), other = some_key(2);
  RandomMessages random(7);
  request_t read;
  for (int k = 0; k < 2'000; ++k) {
    const request_t request = random.some<request_t>();
    const PacketBytes packet = encode(request, &key);
    ASSERT_EQ(decode(packet, &key, read), PacketProblem::none);
    ASSERT_EQ(decode(packet, &other, read), PacketProblem::not_authentic);
    ASSERT_EQ(decode(encode(request, nullptr), &key, read), PacketProblem::not_authentic);
    const PacketBytes damaged = random.damaged(packet);
    if (damaged == packet) continue;
    ASSERT_NE(decode(damaged, &key, read), PacketProblem::none);
  }
}

TEST(LiveCodecKeys, OneChangedBitAnywhereIsNoticed) {
  const LiveKey key = some_key(1);
  RandomMessages random(8);
  PacketBytes packet = encode(random.some<request_t>(), &key);
  request_t read;
  for (std::size_t bit = 0; bit < 8 * packet.size(); ++bit) {
    packet[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    ASSERT_NE(decode(packet, &key, read), PacketProblem::none) << bit;
    packet[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
  }
  EXPECT_EQ(decode(packet, &key, read), PacketProblem::none);
}

// As two others write it: the bytes by lcm-gen's Python code, the mac by Python's hmac (SHA-512,
// the first 32 bytes).
TEST(LiveCodecKeys, APacketIsWhatOthersWrite) {
  request_t request{};
  request.session = 1;
  request.client = 2;
  request.sequence = 3;
  request.who = "ann";
  request.over = 0.5;
  request.revision = -1;
  request.changes = {change_t{"kp", -1, 0, {2.0}}};
  request.events = {"go"};
  const LiveKey key = some_key(1);
  std::string digits;
  for (const std::uint8_t byte : encode(request, &key)) digits += fmt::format("{:02x}", byte);
  EXPECT_EQ(digits,
            "c95292c777826966000000020000000000000001000000000000000200000000"
            "00000003"
            "0000000004616e6e003fe0000000000000ffffffffffffffff00000001000000036b7000ffffffff"
            "0000000140000000000000000000000100000003676f00"
            "d85ca0428d097581f6285cf882b4347385a34157b646982a34114a5e170c464c");
}

TEST(LiveCodecKeys, TheMacIsTheLastFieldAndZeroWithoutAKey) {
  request_t request{};
  request.who = "ann@bench";
  const PacketBytes open = encode(request, nullptr);
  EXPECT_TRUE(std::all_of(open.end() - kMac, open.end(), [](auto byte) { return byte == 0; }));
  const LiveKey key = some_key(1);
  const PacketBytes closed = encode(request, &key);
  EXPECT_TRUE(std::equal(open.begin(), open.end() - kMac, closed.begin()));
  EXPECT_FALSE(std::equal(open.end() - kMac, open.end(), closed.end() - kMac));
}

// The packet's numbers are as they were sent, also those that a server must refuse.
TEST(LiveCodecTexts, NumbersThatAreNoneArrive) {
  request_t request{}, read;
  request.over = -std::numeric_limits<double>::infinity();
  change_t change{"goal", -1, 0, {std::nan(""), 1.0}};
  request.changes = {change};
  ASSERT_EQ(decode(encode(request, nullptr), nullptr, read), PacketProblem::none);
  EXPECT_EQ(read.over, request.over);
  EXPECT_TRUE(std::isnan(read.changes[0].values[0]));
  EXPECT_EQ(read.changes[0].values[1], 1.0);
}

TEST(LiveCodecTexts, ATextThatIsNoneIsRefused) {
  for (const char* text : {"\xff", "\xc0\x80", "a\x1b[2J", "\xed\xa0\x80", "\x7f"}) {
    request_t request{}, read;
    request.who = text;
    EXPECT_EQ(decode(encode(request, nullptr), nullptr, read), PacketProblem::malformed);
    request.who = "ann";
    request.events = {text};
    EXPECT_EQ(decode(encode(request, nullptr), nullptr, read), PacketProblem::malformed);
  }
}

TEST(LiveCodecTexts, AClientsNamesAreShort) {
  request_t request{}, read;
  request.who = std::string(128, 'a');
  EXPECT_EQ(decode(encode(request, nullptr), nullptr, read), PacketProblem::none);
  request.who += 'a';
  EXPECT_EQ(decode(encode(request, nullptr), nullptr, read), PacketProblem::malformed);
}

// 2^31 - 1 changes would take 137 GB; a packet that has none of them is refused before a byte is
// asked for.
TEST(LiveCodecRoom, AnAnnouncedCountMakesNoRoom) {
  PacketBytes packet = encode(request_t{}, nullptr);
  // Before the mac: change_count and event_count, 4 bytes each.
  for (const std::size_t back : {kMac + 8, kMac + 4}) {
    PacketBytes lying = packet;
    std::uint8_t* const count = lying.data() + lying.size() - back;
    count[0] = 0x7f;
    count[1] = count[2] = count[3] = 0xff;
    request_t read;
    const AllocationGuard guard;
    EXPECT_EQ(decode(lying, nullptr, read), PacketProblem::malformed);
    EXPECT_EQ(guard.allocations(), 0);
  }
}

TEST(LiveCodecRoom, AHugePacketIsRefusedUnread) {
  const PacketBytes huge(70'000, 0);
  request_t request;
  hello_t hello;
  EXPECT_EQ(decode(huge, nullptr, request), PacketProblem::too_large);
  EXPECT_EQ(decode(std::span(huge).first(65), nullptr, hello), PacketProblem::too_large);
}

}  // namespace
}  // namespace footfall::tests
