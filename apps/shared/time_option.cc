// Parses a time; see time_option.h.
#include "apps/shared/time_option.h"

#include <fmt/format.h>

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

}  // namespace footfall::apps
