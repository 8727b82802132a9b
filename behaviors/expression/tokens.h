// Tokens of the expression language.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/expression/expression.h"
#include "core/units/units.h"

namespace footfall::behaviors {

struct Token {
  enum class Kind { number, name, parameter, symbol, end };
  Kind kind = Kind::end;
  int offset = 0;           // of its first byte in the text
  std::string text;         // name without `$`, or the symbol
  core::Quantity quantity;  // of a number: SI value, dimension, bare
};

// Splits the text; empty and an error for a character that has no place in an expression.
std::optional<std::vector<Token>> tokenize(std::string_view text, ExpressionError& error);

}  // namespace footfall::behaviors
