// Every bit comes back, whatever the columns hold; what is related costs little.
#include "engine/log/column_codec.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace footfall::engine {
namespace {

constexpr int kRows = 75;

// Columns of every kind: constant, smooth, noise, all bit patterns, copies of others.
template <typename Word>
std::vector<std::vector<Word>> columns_of_block(int block, std::mt19937_64& random) {
  using Real = std::conditional_t<sizeof(Word) == 8, double, float>;
  const auto bits = [](double x) { return std::bit_cast<Word>(static_cast<Real>(x)); };
  std::vector<std::vector<Word>> columns(8, std::vector<Word>(kRows));
  for (int k = 0; k < kRows; ++k) {
    const double t = 1e-3 * (block * kRows + k);
    columns[0][k] = bits(0.25);
    columns[1][k] = bits(std::sin(9.0 * t));
    columns[2][k] = static_cast<Word>(random());
    columns[3][k] = k % 7 == 0 ? bits(std::numeric_limits<double>::quiet_NaN()) : bits(-0.0);
    columns[4][k] = columns[1][k];
    columns[5][k] = k > 0 ? columns[1][k - 1] : bits(3.0);
    columns[6][k] = bits(-std::sin(9.0 * t));
    columns[7][k] = bits(k % 2 == 0 ? 1e308 : -std::numeric_limits<double>::infinity());
  }
  return columns;
}

template <typename Word>
void round_trip(int known) {
  std::mt19937_64 random(1);
  ColumnCodec<Word> coder(8, known, kRows, 1e-3), decoder(8, known, kRows, 1e-3);
  coder.set_integral(7, 1);
  std::vector<std::uint8_t> bytes(coder.bound(kRows));
  for (int block = 0; block < 50; ++block) {
    const int rows = block % 5 == 4 ? 1 + block % 7 : kRows;
    const bool continues = block % 6 != 0;
    const auto columns = columns_of_block<Word>(block, random);
    for (int c = 0; c < 8; ++c) {
      std::copy_n(columns[c].begin(), rows, coder.column(c));
      if (c < known) std::copy_n(columns[c].begin(), rows, decoder.column(c));
    }
    const std::uint8_t* end = coder.encode(rows, continues, bytes.data());
    const auto size = static_cast<std::size_t>(end - bytes.data());
    ASSERT_LE(size, bytes.size());
    ASSERT_TRUE(decoder.decode({bytes.data(), size}, rows, continues)) << block;
    for (int c = 0; c < 8; ++c) {
      for (int k = 0; k < rows; ++k) {
        ASSERT_EQ(decoder.column(c)[k], columns[c][k]) << block << " " << c << " " << k;
      }
    }
  }
}

TEST(ColumnCodec, EveryBitOfADoubleComesBack) { round_trip<std::uint64_t>(0); }
TEST(ColumnCodec, EveryBitOfAFloatComesBack) { round_trip<std::uint32_t>(0); }
TEST(ColumnCodec, ColumnsThatBothSidesKnowAreReferredTo) { round_trip<std::uint32_t>(2); }

TEST(ColumnCodec, ABlockThatDoesNotContinueStandsByItself) {
  std::mt19937_64 random(2);
  ColumnCodec<std::uint64_t> coder(8, 0, kRows), late(8, 0, kRows);
  std::vector<std::uint8_t> bytes(coder.bound(kRows));
  std::uint8_t* end = nullptr;
  std::vector<std::vector<std::uint64_t>> columns;
  for (int block = 0; block < 3; ++block) {
    columns = columns_of_block<std::uint64_t>(block, random);
    for (int c = 0; c < 8; ++c) std::copy_n(columns[c].begin(), kRows, coder.column(c));
    end = coder.encode(kRows, block != 2, bytes.data());
  }
  ASSERT_TRUE(
      late.decode({bytes.data(), static_cast<std::size_t>(end - bytes.data())}, kRows, false));
  EXPECT_EQ(late.column(1)[40], columns[1][40]);
}

TEST(ColumnCodec, ConstantColumnsAndCopiesCostNothingButTheirHeads) {
  ColumnCodec<std::uint64_t> coder(3, 0, kRows);
  std::vector<std::uint8_t> bytes(coder.bound(kRows));
  std::size_t size = 0;
  for (int block = 0; block < 2; ++block) {
    for (int k = 0; k < kRows; ++k) {
      coder.column(0)[k] = std::bit_cast<std::uint64_t>(0.1);
      coder.column(1)[k] = std::bit_cast<std::uint64_t>(std::sin(0.1 * (block * kRows + k)));
      coder.column(2)[k] = coder.column(1)[k];
    }
    size = static_cast<std::size_t>(coder.encode(kRows, true, bytes.data()) - bytes.data());
  }
  // Heads: 2 bytes, 4 where another column is named; planes: at most 8 of the one that moves.
  EXPECT_LE(size, 2U + 2U + 4U + 8U * kRows);
}

TEST(ColumnCodec, DamagedBytesAreToldAndNothingElse) {
  std::mt19937_64 random(3);
  ColumnCodec<std::uint64_t> coder(8, 0, kRows);
  const auto columns = columns_of_block<std::uint64_t>(0, random);
  for (int c = 0; c < 8; ++c) std::copy_n(columns[c].begin(), kRows, coder.column(c));
  std::vector<std::uint8_t> bytes(coder.bound(kRows));
  bytes.resize(static_cast<std::size_t>(coder.encode(kRows, false, bytes.data()) - bytes.data()));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ColumnCodec<std::uint64_t> decoder(8, 0, kRows);
    EXPECT_FALSE(decoder.decode({bytes.data(), size}, kRows, false)) << size;
  }
  for (int k = 0; k < 500; ++k) {  // any byte changed: told, or other numbers, but no crash
    std::vector<std::uint8_t> wrong = bytes;
    wrong[random() % wrong.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
    ColumnCodec<std::uint64_t> decoder(8, 0, kRows);
    decoder.decode(wrong, kRows, false);
  }
}

TEST(OrderedBits, KeepTheOrderOfNumbersAndComeBack) {
  const double numbers[] = {-1e300, -2.5, -1e-310, -0.0, 0.0, 5e-324, 1.0, 1e300};
  for (std::size_t i = 0; i + 1 < std::size(numbers); ++i) {
    const auto a = std::bit_cast<std::uint64_t>(numbers[i]);
    const auto b = std::bit_cast<std::uint64_t>(numbers[i + 1]);
    EXPECT_LT(ordered_bits(a), ordered_bits(b)) << numbers[i];
    EXPECT_EQ(plain_bits(ordered_bits(a)), a);
  }
}

}  // namespace
}  // namespace footfall::engine
