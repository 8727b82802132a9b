// Recursive descent parser for expressions: converts tokens directly to postfix code, with the
// dimension of every part. A number without a unit is SI and adopts the dimension of the operand
// that it is added to or compared with.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/expression/expression.h"
#include "behaviors/expression/tokens.h"

namespace footfall::behaviors {

// Properties of a part of an expression.
struct Operand {
  core::Dimension dimension;
  bool bare = false;     // adopts a dimension
  bool literal = false;  // a literal number, stored in `value`
  double value = 0.0;
};

// Thrown inside the compiler only, after the error was recorded.
struct Failure {};

struct FunctionInfo;

// One pass over the tokens; throws Failure after recording the error.
class ExpressionParser {
 public:
  ExpressionParser(const ExpressionScope& scope, const std::vector<Token>& tokens,
                   ExpressionError& error)
      : scope_(scope), tokens_(tokens), error_(error) {}

  Operand compile();

  std::vector<Instruction> code;
  bool constant = true;

 private:
  const Token& peek() const { return tokens_[at_]; }
  const Token& take() { return tokens_[at_ + 1 < tokens_.size() ? at_++ : at_]; }
  bool is(std::string_view symbol) const {
    return peek().kind == Token::Kind::symbol && peek().text == symbol;
  }
  bool is_word(std::string_view word) const {
    return peek().kind == Token::Kind::name && peek().text == word;
  }
  static std::string describe(const Token& token);
  std::string hint() const;
  [[noreturn]] void fail(const Token& token, std::string id, std::string text);
  void expect(std::string_view symbol);
  void emit(Op op, int index = 0, double value = 0.0);
  // dimensions.cc. The common dimension of two operands.
  Operand unify(const Operand& a, const Operand& b, const Token& at, const std::string& what);
  // The dimension of a product or quotient; an error if its exponents are out of range.
  core::Dimension combine(core::Dimension a, core::Dimension b, bool times, const Token& at);
  // A power: the exponent of a quantity with a unit is a whole number.
  Operand raise(const Operand& base, const Operand& exponent, const Token& at);
  void require_plain(const Operand& a, const Token& at, const std::string& what);
  Operand parse_choice();
  Operand parse_or();
  Operand parse_and();
  Operand parse_not();
  static std::optional<Op> comparison(const Token& token);
  Operand parse_comparison();
  Operand parse_sum();
  Operand parse_product();
  Operand parse_sign();
  Operand parse_power();
  Operand parse_primary();
  Operand parse_call(const Token& name);
  Operand parse_in();
  std::optional<Operand> parse_statistic(const Token& name);
  Operand parse_function(const Token& name, const FunctionInfo& function);
  Operand result_of(const FunctionInfo& function, const Token& name, Operand argument);
  Operand parse_parameter(const Token& token);
  Operand parse_entry(const Token& token);
  Operand parse_name(const Token& token);
  [[noreturn]] void unknown_name(const Token& token);

  const ExpressionScope& scope_;
  const std::vector<Token>& tokens_;
  ExpressionError& error_;
  std::size_t at_ = 0;
  int depth_ = 0;
  int nesting_ = 0;
};

}  // namespace footfall::behaviors
