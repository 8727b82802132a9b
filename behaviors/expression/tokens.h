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
  int offset = 0;           // byte offset in the text
  std::string text;         // name without `$`, or the operator
  core::Quantity quantity;  // for numbers: SI value, dimension, bare
};

// Splits the text; nullopt and an error for a character that is not allowed in expressions.
std::optional<std::vector<Token>> tokenize(std::string_view text, ExpressionError& error);

}  // namespace footfall::behaviors
