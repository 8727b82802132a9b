// Parses a time; see time_option.h.
#include "apps/shared/time_option.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "core/diagnostics/quantity_hint.h"
#include "core/units/units.h"

namespace footfall::apps {

double read_time(const std::string& text, const char* option) {
  const auto quantity = core::parse_quantity(text);
  if (quantity && (quantity->bare || quantity->dimension == core::kTime)) return quantity->value;
  throw std::runtime_error(fmt::format("{}: error: expected a time such as 2.5s, got '{}'{}",
                                       option, text, core::quantity_hint(text, core::kTime)));
}

double read_time(const std::string& text, const char* option, double otherwise) {
  return text.empty() ? otherwise : read_time(text, option);
}

TimeSpan read_span(const std::string& from, const std::string& to) {
  constexpr double kEver = std::numeric_limits<double>::infinity();
  const TimeSpan span = {read_time(from, "--from", -kEver), read_time(to, "--to", kEver),
                         !from.empty() || !to.empty()};
  if (span.to < span.from) {
    throw std::runtime_error(
        fmt::format("--from, --to: error: {:g} s is before {:g} s", span.to, span.from));
  }
  return span;
}

}  // namespace footfall::apps
