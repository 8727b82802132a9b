// Operators of expressions, from lowest to highest precedence; see parser.h.
#include "behaviors/expression/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/diagnostics/diagnostics.h"
#include "core/diagnostics/quantity_hint.h"

namespace footfall::behaviors {

Operand ExpressionParser::compile() {
  const Operand result = parse_choice();
  if (peek().kind != Token::Kind::end) {
    fail(peek(), "bad-expression", "expected an operator, got " + describe(peek()) + hint());
  }
  return result;
}

std::string ExpressionParser::describe(const Token& token) {
  switch (token.kind) {
    case Token::Kind::end:
      return "end of expression";
    case Token::Kind::number:
      return "a number";
    case Token::Kind::parameter:
      return fmt::format("'${}'", token.text);
    default:
      return fmt::format("'{}'", token.text);
  }
}

// What was probably meant where a number goes on in a way that it cannot: `3,5`, `3 CM`.
std::string ExpressionParser::hint() const {
  if (at_ == 0 || tokens_[at_ - 1].kind != Token::Kind::number) return {};
  const bool number_behind =
      at_ + 1 < tokens_.size() && tokens_[at_ + 1].kind == Token::Kind::number;
  if (is(",") && number_behind) return ": a decimal point, not a comma";
  if (peek().kind != Token::Kind::name) return {};
  std::string unit = core::quantity_hint("1 " + peek().text);
  const std::size_t one = unit.find("'1 ");
  if (one != std::string::npos) unit.erase(one + 1, 2);
  return unit;
}

void ExpressionParser::fail(const Token& token, std::string id, std::string text) {
  error_ = {token.offset, std::move(id), std::move(text)};
  throw Failure{};
}

void ExpressionParser::expect(std::string_view symbol) {
  if (!is(symbol)) {
    fail(peek(), "bad-expression",
         fmt::format("expected '{}', got {}{}", symbol, describe(peek()), hint()));
  }
  take();
}

void ExpressionParser::emit(Op op, int index, double value) {
  if (op <= Op::entry) {
    if (++depth_ > kExpressionStack) fail(peek(), "too-deep", "expression is nested too deeply");
    if (op != Op::constant) constant = false;
  } else if (op == Op::select || op == Op::clamp) {
    depth_ -= 2;
  } else if (op != Op::negate && op != Op::logical_not && op < Op::absolute) {
    --depth_;
  } else if (op == Op::minimum || op == Op::maximum || op == Op::arctangent2 ||
             op == Op::hypotenuse) {
    --depth_;
  }
  code.push_back({op, index, value});
}

Operand ExpressionParser::parse_choice() {
  if (++nesting_ > 64) fail(peek(), "too-deep", "expression is nested too deeply");
  const Token& start = peek();
  Operand condition = parse_or();
  if (is("?")) {
    require_plain(condition, start, "'?'");
    take();
    const Operand yes = parse_choice();
    expect(":");
    const Token& at = peek();
    const Operand no = parse_choice();
    condition = unify(yes, no, at, "choose between");
    emit(Op::select);
  }
  --nesting_;
  return condition;
}

Operand ExpressionParser::parse_or() {
  const Token& start = peek();
  Operand left = parse_and();
  while (is_word("or")) {
    require_plain(left, start, "'or'");
    take();
    const Token& at = peek();
    require_plain(parse_and(), at, "'or'");
    emit(Op::logical_or);
    left = {};
  }
  return left;
}

Operand ExpressionParser::parse_and() {
  const Token& start = peek();
  Operand left = parse_not();
  while (is_word("and")) {
    require_plain(left, start, "'and'");
    take();
    const Token& at = peek();
    require_plain(parse_not(), at, "'and'");
    emit(Op::logical_and);
    left = {};
  }
  return left;
}

Operand ExpressionParser::parse_not() {
  if (!is_word("not")) return parse_comparison();
  if (++nesting_ > 64) fail(peek(), "too-deep", "expression is nested too deeply");
  take();
  const Token& at = peek();
  require_plain(parse_not(), at, "'not'");
  emit(Op::logical_not);
  --nesting_;
  return {};
}

std::optional<Op> ExpressionParser::comparison(const Token& token) {
  if (token.kind != Token::Kind::symbol) return std::nullopt;
  if (token.text == "<") return Op::less;
  if (token.text == "<=") return Op::less_equal;
  if (token.text == ">") return Op::greater;
  if (token.text == ">=") return Op::greater_equal;
  if (token.text == "==") return Op::equal;
  if (token.text == "!=") return Op::not_equal;
  return std::nullopt;
}

Operand ExpressionParser::parse_comparison() {
  const Operand left = parse_sum();
  const auto op = comparison(peek());
  if (!op) return left;
  take();
  const Token& at = peek();
  unify(left, parse_sum(), at, "compare");
  emit(*op);
  if (comparison(peek())) {
    fail(peek(), "bad-expression", "comparisons do not chain: write 'a < b and b < c'");
  }
  return {};
}

Operand ExpressionParser::parse_sum() {
  Operand left = parse_product();
  while (is("+") || is("-")) {
    const bool plus = take().text == "+";
    const Token& at = peek();
    left = unify(left, parse_product(), at, plus ? "add" : "subtract");
    emit(plus ? Op::add : Op::subtract);
  }
  return left;
}

Operand ExpressionParser::parse_product() {
  Operand left = parse_sign();
  while (is("*") || is("/")) {
    const bool times = take().text == "*";
    const Token& at = peek();
    const std::size_t before = code.size();
    const Operand right = parse_sign();
    const bool by_zero = !times && code.size() == before + 1 && code.back().op == Op::constant &&
                         code.back().value == 0.0;
    if (by_zero) error_ = {at.offset, "no-value", "a division by 0 has no value"};
    left = {combine(left.dimension, right.dimension, times, at), left.bare && right.bare, false,
            0.0};
    emit(times ? Op::multiply : Op::divide);
  }
  return left;
}

Operand ExpressionParser::parse_sign() {
  if (is("-") || is("+")) {
    if (++nesting_ > 64) fail(peek(), "too-deep", "expression is nested too deeply");
    const bool minus = take().text == "-";
    Operand operand = parse_sign();
    if (minus) emit(Op::negate);
    operand.value = minus ? -operand.value : operand.value;
    --nesting_;
    return operand;
  }
  return parse_power();
}

Operand ExpressionParser::parse_power() {
  const Operand base = parse_primary();
  if (!is("^")) return base;
  take();
  const Token& at = peek();
  const Operand exponent = parse_sign();  // right-associative: 2^3^2 = 2^9
  require_plain(exponent, at, "an exponent");
  emit(Op::power);
  return raise(base, exponent, at);
}

int compile_expression(std::string_view text, const ExpressionScope& scope,
                       std::optional<core::Dimension> expected, ExpressionPool& pool,
                       ExpressionError& error) {
  const auto tokens = tokenize(text, error);
  if (!tokens) return -1;
  static const std::vector<ParameterInfo> no_parameters;
  ExpressionScope names = scope;
  if (names.parameters == nullptr) names.parameters = &no_parameters;
  ExpressionParser parser(names, *tokens, error);
  Operand result;
  try {
    result = parser.compile();
  } catch (const Failure&) {
    return -1;
  }
  if (parser.code.size() > kMaxSteps) {
    error = {tokens->front().offset, "too-large",
             fmt::format("expression of more than {} values and operations", kMaxSteps)};
    return -1;
  }
  if (expected && !result.bare && !(result.dimension == *expected)) {
    error = {tokens->front().offset, "dimension",
             fmt::format("expected {}, got {}", core::dimension_name(*expected),
                         core::dimension_name(result.dimension))};
    return -1;
  }
  return pool.add(std::move(parser.code), result.bare && expected ? *expected : result.dimension,
                  result.bare, parser.constant);
}

}  // namespace footfall::behaviors
