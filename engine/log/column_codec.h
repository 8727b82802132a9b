// Lossless coding of columns of numbers that change little from row to row, as bytes that a general
// compressor then shrinks well. docs/log.md has the format for those who read it elsewhere.
//
// A number is taken as an unsigned integer in the order of its value: x -> ~x if its sign bit is
// set, else x with the sign bit set. A column is coded as what remains of it after a prediction:
// d(k) = x(k), or x(k) minus what another column lets expect: its value in row k, in row k - 1, its
// negative, or the value before plus its integral over the row's period;
// r(k) = d(k) minus the polynomial of order 0 to 3 through the values before it, modulo 2^bits,
// zigzag (0, -1, 1, -2 -> 0, 1, 2, 3), the bytes of equal significance together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace footfall::engine {

// An integer in the order of the number whose bits it is made from, and back.
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

// Codes or decodes one block of rows after another. Word: std::uint32_t (float) or std::uint64_t
// (double). The first `known` columns are not coded: both sides have them, and others may refer to
// them. Allocates in its constructor only (decode(): nothing but its error).
template <typename Word>
class ColumnCodec {
 public:
  // period: s from row to row, for integrals.
  ColumnCodec(int columns, int known, int max_rows, double period = 0.0);

  // Column c (doubles) is the integral of column `rate` < c. Only the coding side needs to know.
  void set_integral(int c, int rate) { rates_[static_cast<std::size_t>(c)] = rate; }
  // The squares of column c and of the three from `first` on add up to 1 (quaternions).
  void set_unit(int c, int first) { units_[static_cast<std::size_t>(c)] = first; }

  // Room for the words of a block, column by column: column c begins at c * max_rows().
  Word* column(int c) noexcept {
    return words_.data() + static_cast<std::size_t>(c) * static_cast<std::size_t>(max_rows_);
  }
  int max_rows() const noexcept { return max_rows_; }
  // Bytes that a block of `rows` takes at most.
  std::size_t bound(int rows) const noexcept;

  // Codes the words (bits as they are) of `rows` rows; continues: predictions may look at the block
  // coded before. Returns the end of what was written to `out`.
  std::uint8_t* encode(int rows, bool continues, std::uint8_t* out) noexcept;
  // Puts the words back; the known columns must be there. False: the bytes are damaged.
  bool decode(std::span<const std::uint8_t> bytes, int rows, bool continues) noexcept;

 private:
  static constexpr int kHistory = 4;
  // How another column predicts: second part of a column's head.
  enum class Relation : std::uint8_t {
    none,
    same,       // its value
    before,     // its value in the row before
    negative,   // its value with the other sign
    integral2,  // x(k-1) + period ((1 - a) y(k-1) + a y(k)), a = 2/4 (trapezoid)
    integral3,  // 3/4 (semi-implicit Euler in two steps)
    integral4,  // 4/4 (semi-implicit Euler)
    unit,       // sqrt(1 - the squares of three columns), with the sign of x(k-1)
  };
  struct Choice {
    int order = 0;
    Relation relation = Relation::none;
    int reference = -1;
    std::uint64_t cost = 0;
  };
  Word& before(int c, int back) noexcept {
    return history_[static_cast<std::size_t>(c * kHistory + back - 1)];
  }
  Word word_at(int c, int row) noexcept;
  Word expected(const Choice& choice, int c, int row) noexcept;
  void order_words(int rows) noexcept;
  void difference(const Choice& choice, int c, int rows) noexcept;
  void try_orders(Choice choice, int c, int rows, Choice& best) noexcept;
  bool similar(int c, const Choice& choice, int rows) noexcept;
  Choice choose(int c, int rows) noexcept;
  void remember(int rows) noexcept;

  int columns_, known_, max_rows_;
  double period_;
  std::vector<int> rates_, units_;   // by column: set_integral(), set_unit(); else -1
  int seen_ = 0;                     // rows of history that count
  std::vector<Word> words_;          // by column, max_rows_ each
  std::vector<Word> history_;        // by column, the newest first
  std::vector<Word> difference_;     // d of one column, kHistory rows before it
  std::vector<Word> residual_;       // r of one column
  std::vector<std::uint8_t> moves_;  // by column: it is not the same in all rows
};

extern template class ColumnCodec<std::uint32_t>;
extern template class ColumnCodec<std::uint64_t>;

}  // namespace footfall::engine
