// Lossless coding of columns of slowly varying numbers, as bytes that a general compressor then
// compresses well. docs/log.md describes the format for other readers.
//
// A number is mapped to an unsigned integer with the same order: x -> ~x if its sign bit is set,
// else x with the sign bit set. A column is coded as the residual of a prediction: d(k) = x(k), or
// x(k) minus a prediction from another column: its value in row k, in row k - 1, its negative, or
// the previous value plus its integral over the row's period; r(k) = d(k) minus the polynomial of
// order 0 to 3 through the previous values, modulo 2^bits, zigzag (0, -1, 1, -2 -> 0, 1, 2, 3),
// bytes of equal significance together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace footfall::engine {

// Maps the bits of a number to an integer with the same order, and back.
template <typename Word>
constexpr Word ordered_bits(Word bits) noexcept {
  constexpr Word kSign = Word{1} << (8 * sizeof(Word) - 1);
  return (bits & kSign) != 0 ? static_cast<Word>(~bits) : static_cast<Word>(bits | kSign);
}
template <typename Word>
constexpr Word plain_bits(Word ordered) noexcept {
  constexpr Word kSign = Word{1} << (8 * sizeof(Word) - 1);
  return (ordered & kSign) != 0 ? static_cast<Word>(ordered ^ kSign) : static_cast<Word>(~ordered);
}

// Encodes or decodes consecutive blocks of rows. Word: std::uint32_t (float) or std::uint64_t
// (double). The first `known` columns are not coded: both sides have them, and other columns may
// refer to them. Allocates only in its constructor (decode() only in case of an error).
template <typename Word>
class ColumnCodec {
 public:
  // period: s between rows, for integrals.
  ColumnCodec(int columns, int known, int max_rows, double period = 0.0);

  // Declares column c (doubles) to be the integral of column `rate` < c; needed only for encoding.
  void set_integral(int c, int rate) { rates_[static_cast<std::size_t>(c)] = rate; }
  // The squares of column c and of the three from `first` on add up to 1 (quaternions).
  void set_unit(int c, int first) { units_[static_cast<std::size_t>(c)] = first; }

  // Memory for the words of a block, column by column: column c begins at c * max_rows().
  Word* column(int c) noexcept {
    return words_.data() + static_cast<std::size_t>(c) * static_cast<std::size_t>(max_rows_);
  }
  int max_rows() const noexcept { return max_rows_; }
  // Maximum number of bytes for a block of `rows`.
  std::size_t bound(int rows) const noexcept;

  // Encodes the words (unchanged bits) of `rows` rows; continues: predictions may use the previous
  // block. Returns the end of the data written to `out`.
  std::uint8_t* encode(int rows, bool continues, std::uint8_t* out) noexcept;
  // Restores the words; the known columns must be present. False if the bytes are malformed.
  bool decode(std::span<const std::uint8_t> bytes, int rows, bool continues) noexcept;

 private:
  static constexpr int kHistory = 4;
  // Prediction from another column: second part of a column's header.
  enum class Relation : std::uint8_t {
    none,
    same,       // its value
    before,     // its value in the previous row
    negative,   // its negated value
    integral2,  // x(k-1) + period ((1 - a) y(k-1) + a y(k)), a = 2/4 (trapezoid)
    integral3,  // 3/4 (semi-implicit Euler in two steps)
    integral4,  // 4/4 (semi-implicit Euler)
    unit,       // sqrt(1 - sum of the squares of three columns), with the sign of x(k-1)
  };
  struct Choice {
    int order = 0;
    Relation relation = Relation::none;
    int reference = -1;
    std::uint64_t cost = 0;
  };
  struct Probe {
    Word same = 0, other = 0;  // of a row, by relation
  };
  Word& before(int c, int back) noexcept {
    return history_[static_cast<std::size_t>(c * kHistory + back - 1)];
  }
  Word word_at(int c, int row) noexcept;
  Word expected(const Choice& choice, int c, int row) noexcept;
  void order_words(int rows) noexcept;
  void difference(const Choice& choice, int c, int rows) noexcept;
  void try_orders(Choice choice, int c, int rows, Choice& best) noexcept;
  bool rests(int c) noexcept;
  void take_probes(int rows) noexcept;
  bool similar(int c, const Choice& choice, int rows) noexcept;
  Choice choose(int c, int rows) noexcept;
  void remember(int rows) noexcept;

  int columns_, known_, max_rows_;
  double period_;
  std::vector<int> rates_, units_;   // by column: arguments of set_integral(), set_unit(); else -1
  int seen_ = 0;                     // valid rows of history
  std::vector<Word> words_;          // by column, max_rows_ each
  std::vector<Word> history_;        // by column, newest first
  std::vector<Word> difference_;     // d of one column, preceded by kHistory rows
  std::vector<Word> residual_;       // r of one column
  std::vector<std::uint8_t> moves_;  // by column: whether its value changes
  std::vector<Probe> probes_;        // by column, of the middle row
};

extern template class ColumnCodec<std::uint32_t>;
extern template class ColumnCodec<std::uint64_t>;

}  // namespace footfall::engine
