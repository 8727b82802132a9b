// Converts numbers to quantity text; see quantity_text.h.
#include "core/units/quantity_text.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/units/units.h"

namespace footfall::core {
namespace {

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

// The part of a quantity behind its number: blanks and unit.
std::string_view tail_of(std::string_view quantity) {
  while (!quantity.empty() && (is_blank(quantity.front()) || quantity.front() == '+')) {
    quantity.remove_prefix(1);
  }
  double ignored = 0.0;
  const char* const end = quantity.data() + quantity.size();
  const auto [stop, error] = std::from_chars(quantity.data(), end, ignored);
  return error == std::errc() ? quantity.substr(static_cast<std::size_t>(stop - quantity.data()))
                              : std::string_view();
}

std::string_view unit_of(std::string_view tail) {
  while (!tail.empty() && is_blank(tail.front())) tail.remove_prefix(1);
  return tail;
}

// The shortest number that, followed by `tail`, reads as `value`; nullopt if there is none.
std::optional<std::string> in_unit(double value, std::string_view tail, Dimension dimension) {
  const auto unit = parse_unit(unit_of(tail));
  if (!unit) return std::nullopt;
  // Number of doubles to try on either side of the quotient. Its two roundings and those of reading
  // are off by less than one unit in the last place each.
  constexpr int kNeighbours = 8;
  double number = value / unit->value;
  if (!std::isfinite(number)) return std::nullopt;
  for (int k = 0; k < kNeighbours; ++k) number = std::nextafter(number, -HUGE_VAL);
  std::optional<std::string> best;
  for (int k = -kNeighbours; k <= kNeighbours; ++k) {
    const std::string text = fmt::format("{}", number);
    const auto read = parse_quantity(text + std::string(tail));
    const bool good = read && same_bits(read->value, value) && read->dimension == dimension;
    if (good && (!best || text.size() < best->size())) best = text;
    number = std::nextafter(number, HUGE_VAL);
  }
  return best ? std::optional(*best + std::string(tail)) : std::nullopt;
}

}  // namespace

std::string quantity_text(double value, std::string_view like) {
  const auto old = parse_quantity(like);
  const std::string bare = fmt::format("{}", value);
  if (!old || old->bare) return bare;
  const std::string_view tail = tail_of(like);
  if (auto text = in_unit(value, tail, old->dimension)) return *text;
  const bool angle = old->dimension == kNone && unit_of(tail).find('%') == std::string_view::npos;
  const std::string unit = angle ? "rad" : unit_text(old->dimension);
  if (unit.empty()) return bare;
  std::string si = bare;
  if (unit_of(tail).data() != tail.data() || unit.front() == '1') si += ' ';
  si += unit;
  const auto read = parse_quantity(si);
  return read && same_bits(read->value, value) && read->dimension == old->dimension ? si : bare;
}

}  // namespace footfall::core
