// Encodes and decodes columns; see column_codec.h.
#include "engine/log/column_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace footfall::engine {
namespace {

// First byte of a column's header: order in the lowest bits, then the relation.
constexpr int kOrderBits = 2;
constexpr std::uint8_t kOrderMask = 3;
constexpr int kSample = 3;  // distance of the sample rows evaluated to choose an order
// Two columns are candidates for a reference if they differ by at most this many units in the last
// place.
constexpr int kNear = 64;
constexpr int kMostOrder = 3;

std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

template <typename Word>
Word zigzag(Word value) noexcept {
  using Signed = std::make_signed_t<Word>;
  const auto sign = static_cast<Word>(static_cast<Signed>(value) >> (8 * sizeof(Word) - 1));
  return static_cast<Word>(value << 1) ^ sign;
}

template <typename Word>
Word unzigzag(Word value) noexcept {
  return static_cast<Word>(value >> 1) ^ static_cast<Word>(Word{0} - (value & 1));
}

// NaN bit patterns differ between platforms.
template <typename Word>
Word number_word(double x) noexcept {
  return ordered_bits(std::isnan(x) ? Word{0} : std::bit_cast<Word>(x));
}

// Extrapolates the polynomial of `order` through the values before *d.
template <typename Word>
Word predicted(const Word* d, int order) noexcept {
  switch (order) {
    case 0:
      return 0;
    case 1:
      return d[-1];
    case 2:
      return 2 * d[-1] - d[-2];
    default:
      return 3 * (d[-1] - d[-2]) + d[-3];
  }
}

}  // namespace

template <typename Word>
ColumnCodec<Word>::ColumnCodec(int columns, int known, int max_rows, double period)
    : columns_(columns),
      known_(known),
      max_rows_(max_rows),
      period_(period),
      rates_(at(columns), -1),
      units_(at(columns), -1),
      words_(at(columns) * at(max_rows)),
      history_(at(columns * kHistory)),
      difference_(at(max_rows + kHistory)),
      residual_(at(max_rows)),
      moves_(at(columns)),
      probes_(at(columns)) {}

template <typename Word>
std::size_t ColumnCodec<Word>::bound(int rows) const noexcept {
  return at(columns_ - known_) * (4 + sizeof(Word) * at(rows));
}

template <typename Word>
void ColumnCodec<Word>::order_words(int rows) noexcept {
  for (int c = 0; c < columns_; ++c) {
    Word* words = column(c);
    Word changes = 0;
    for (int k = 0; k < rows; ++k) {
      words[k] = ordered_bits(words[k]);
      changes |= words[k] ^ words[0];
    }
    moves_[at(c)] = changes != 0 ? 1 : 0;
  }
}

// The value in a row, which may precede the block.
template <typename Word>
Word ColumnCodec<Word>::word_at(int c, int row) noexcept {
  if (row >= 0) return column(c)[row];
  return -row <= seen_ ? before(c, -row) : 0;
}

// The prediction of column c in a row from the other column.
template <typename Word>
Word ColumnCodec<Word>::expected(const Choice& choice, int c, int row) noexcept {
  switch (choice.relation) {
    case Relation::none:
      return 0;
    case Relation::same:
      return word_at(choice.reference, row);
    case Relation::before:
      return word_at(choice.reference, row - 1);
    case Relation::negative:
      return static_cast<Word>(~word_at(choice.reference, row));
    default:
      break;
  }
  if constexpr (sizeof(Word) == sizeof(double)) {
    const auto real = [](Word word) { return std::bit_cast<double>(plain_bits(word)); };
    if (choice.relation == Relation::unit) {
      double rest = 1.0;
      for (int k = 0; k < 3; ++k) {
        const double x = real(word_at(choice.reference + k, row));
        rest -= x * x;
      }
      const double root = std::copysign(std::sqrt(std::max(0.0, rest)), real(word_at(c, row - 1)));
      return number_word<Word>(root);
    }
    const double a = 0.25 * static_cast<double>(static_cast<int>(choice.relation) -
                                                static_cast<int>(Relation::integral2) + 2);
    const double rate = (1.0 - a) * real(word_at(choice.reference, row - 1)) +
                        a * real(word_at(choice.reference, row));
    return number_word<Word>(real(word_at(c, row - 1)) + period_ * rate);
  }
  return 0;
}

template <typename Word>
void ColumnCodec<Word>::difference(const Choice& choice, int c, int rows) noexcept {
  Word* d = difference_.data() + kHistory;
  const Word* x = column(c);
  if (choice.relation == Relation::same) {
    const Word* y = column(choice.reference);
    for (int k = 0; k < rows; ++k) d[k] = x[k] - y[k];
  } else if (choice.relation == Relation::none) {
    std::copy_n(x, rows, d);
  } else {
    for (int k = 0; k < rows; ++k) d[k] = x[k] - expected(choice, c, k);
  }
  for (int back = 1; back <= kMostOrder; ++back) {
    d[-back] = word_at(c, -back) - expected(choice, c, -back);
  }
}

// Number of residual bits for each order; the first rows have fewer preceding values.
template <typename Word>
void ColumnCodec<Word>::try_orders(Choice choice, int c, int rows, Choice& best) noexcept {
  difference(choice, c, rows);
  const Word* d = difference_.data() + kHistory;
  for (choice.order = 0; choice.order <= kMostOrder; ++choice.order) {
    choice.cost = 0;
    for (int k = 0; k < rows; k += kSample) {
      const int order = std::min(choice.order, k + seen_);
      choice.cost +=
          static_cast<std::uint64_t>(std::bit_width(zigzag<Word>(d[k] - predicted(d + k, order))));
    }
    if (choice.cost < best.cost) best = choice;
  }
}

// The value has been the same for as long as predictions look back, so that it takes no bits.
template <typename Word>
bool ColumnCodec<Word>::rests(int c) noexcept {
  const Word x = column(c)[0];
  if (moves_[at(c)] != 0) return false;
  if (x == 0) return true;
  return seen_ > 0 && before(c, 1) == x;
}

// Side by side what similar() looks at first: it mostly ends there, and columns lie far apart.
template <typename Word>
void ColumnCodec<Word>::take_probes(int rows) noexcept {
  const int row = rows / 2;
  for (int c = 0; c < columns_; ++c) {
    const Word x = column(c)[row];
    const Word other = sizeof(Word) == sizeof(double) ? word_at(c, row - 1) : static_cast<Word>(~x);
    probes_[at(c)] = {x, other};
  }
}

template <typename Word>
bool ColumnCodec<Word>::similar(int c, const Choice& choice, int rows) noexcept {
  const Word* x = column(c);
  for (const int k : {rows / 2, rows - 1, rows / 4 + 1, 3 * rows / 4}) {
    if (x[k] - expected(choice, c, k) + kNear > 2 * kNear) return false;
  }
  return true;
}

template <typename Word>
typename ColumnCodec<Word>::Choice ColumnCodec<Word>::choose(int c, int rows) noexcept {
  Choice best{0, Relation::none, -1, ~std::uint64_t{0}};
  if (rests(c)) {  // what the search below would find
    best.order = column(c)[0] == 0 ? 0 : 1;
    return best;
  }
  try_orders({}, c, rows, best);
  if (moves_[at(c)] == 0 || rows < 4) return best;
  if (rates_[at(c)] >= 0) {
    for (const Relation integral :
         {Relation::integral2, Relation::integral3, Relation::integral4}) {
      try_orders({0, integral, rates_[at(c)], 0}, c, rows, best);
    }
    return best;
  }
  if (units_[at(c)] >= 0) {
    try_orders({0, Relation::unit, units_[at(c)], 0}, c, rows, best);
    return best;
  }
  // One row earlier: commands and their measurement one tick later. Negative: errors relative to 0,
  // which are derived.
  constexpr bool kInputs = sizeof(Word) == sizeof(std::uint64_t);
  constexpr Relation kOther = kInputs ? Relation::before : Relation::negative;
  const Word x = column(c)[rows / 2];
  for (int other = 0; other < c; ++other) {
    if (moves_[at(other)] == 0) continue;
    for (const Relation relation : {Relation::same, kOther}) {
      const Probe& probe = probes_[at(other)];
      const Word y = relation == Relation::same ? probe.same : probe.other;
      if (static_cast<Word>(x - y + kNear) > 2 * kNear) continue;
      const Choice choice{0, relation, other, 0};
      if (!similar(c, choice, rows)) continue;
      try_orders(choice, c, rows, best);
      if (best.reference == other) return best;
    }
  }
  return best;
}

template <typename Word>
void ColumnCodec<Word>::remember(int rows) noexcept {
  for (int c = 0; c < columns_; ++c) {
    std::array<Word, kHistory> newest{};
    for (int back = 1; back <= kHistory; ++back) {
      newest[at(back - 1)] = word_at(c, rows - back);
    }
    for (int back = 1; back <= kHistory; ++back) before(c, back) = newest[at(back - 1)];
  }
  seen_ = std::min(kHistory, seen_ + rows);
}

template <typename Word>
std::uint8_t* ColumnCodec<Word>::encode(int rows, bool continues, std::uint8_t* out) noexcept {
  if (!continues) seen_ = 0;
  order_words(rows);
  if (rows > 0) take_probes(rows);
  std::uint8_t* head = out;
  // Headers first, because they hardly change between blocks. Their length is not known yet.
  std::uint8_t* planes = out + 4 * (columns_ - known_);
  std::uint8_t* const planes_begin = planes;
  for (int c = known_; c < columns_; ++c) {
    const Choice choice = choose(c, rows);
    if (rows > 0 && rests(c)) {
      *head++ = static_cast<std::uint8_t>(choice.order);
      *head++ = 0;
      continue;
    }
    difference(choice, c, rows);
    const Word* d = difference_.data() + kHistory;
    Word all = 0;
    for (int k = 0; k < rows; ++k) {
      residual_[at(k)] = zigzag<Word>(d[k] - predicted(d + k, std::min(choice.order, k + seen_)));
      all |= residual_[at(k)];
    }
    *head++ =
        static_cast<std::uint8_t>(choice.order | static_cast<int>(choice.relation) << kOrderBits);
    std::uint8_t& mask = *head++;
    mask = 0;
    for (std::size_t b = 0; b < sizeof(Word); ++b) {
      if ((all >> (8 * b) & 0xFFU) == 0) continue;
      mask = static_cast<std::uint8_t>(mask | 1U << b);
      for (int k = 0; k < rows; ++k)
        *planes++ = static_cast<std::uint8_t>(residual_[at(k)] >> (8 * b));
    }
    if (choice.relation != Relation::none) {
      *head++ = static_cast<std::uint8_t>(choice.reference);
      *head++ = static_cast<std::uint8_t>(choice.reference >> 8);
    }
  }
  remember(rows);
  std::memmove(head, planes_begin, static_cast<std::size_t>(planes - planes_begin));
  return head + (planes - planes_begin);
}

template <typename Word>
bool ColumnCodec<Word>::decode(std::span<const std::uint8_t> bytes, int rows,
                               bool continues) noexcept {
  if (rows < 0 || rows > max_rows_) return false;
  if (!continues) seen_ = 0;
  for (int c = 0; c < known_; ++c) {
    for (int k = 0; k < rows; ++k) column(c)[k] = ordered_bits(column(c)[k]);
  }
  // The planes begin after all headers.
  std::size_t head = 0, plane = 0;
  for (int c = known_; c < columns_; ++c) {
    if (plane + 2 > bytes.size()) return false;
    plane += bytes[plane] >> kOrderBits != 0 ? 4 : 2;
  }
  if (plane > bytes.size()) return false;
  for (int c = known_; c < columns_; ++c) {
    const std::uint8_t first = bytes[head], mask = bytes[head + 1];
    Choice choice{first & kOrderMask, static_cast<Relation>(first >> kOrderBits), -1, 0};
    head += 2;
    if (choice.relation != Relation::none) {
      choice.reference = bytes[head] | bytes[head + 1] << 8;
      const int last = choice.reference + (choice.relation == Relation::unit ? 2 : 0);
      if (last >= c || choice.relation > Relation::unit) return false;
      head += 2;
    }
    std::fill_n(residual_.begin(), rows, Word{0});
    for (std::size_t b = 0; b < sizeof(Word); ++b) {
      if ((mask >> b & 1U) == 0) continue;
      if (plane + at(rows) > bytes.size()) return false;
      for (int k = 0; k < rows; ++k)
        residual_[at(k)] |= static_cast<Word>(bytes[plane++]) << (8 * b);
    }
    difference(choice, c, 0);  // preceding values
    Word* d = difference_.data() + kHistory;
    for (int k = 0; k < rows; ++k) {
      d[k] = unzigzag(residual_[at(k)]) + predicted(d + k, std::min(choice.order, k + seen_));
      column(c)[k] = d[k] + expected(choice, c, k);
    }
  }
  remember(rows);
  for (int c = 0; c < columns_; ++c) {
    for (int k = 0; k < rows; ++k) column(c)[k] = plain_bits(column(c)[k]);
  }
  return plane == bytes.size();
}

template class ColumnCodec<std::uint32_t>;
template class ColumnCodec<std::uint64_t>;

}  // namespace footfall::engine
