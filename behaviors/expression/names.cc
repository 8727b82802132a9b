// Parses operands: numbers, names, functions.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "behaviors/expression/parser.h"
#include "behaviors/expression/statistics.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {

struct FunctionInfo {
  std::string_view name;
  Op op;
  int arguments;
  enum class Rule { same, none, half, angle, length } rule;  // rule for dimensions
};

using Rule = FunctionInfo::Rule;
constexpr std::array<FunctionInfo, 11> kFunctions = {{
    {"abs", Op::absolute, 1, Rule::same},
    {"min", Op::minimum, 2, Rule::same},
    {"max", Op::maximum, 2, Rule::same},
    {"clamp", Op::clamp, 3, Rule::same},
    {"sqrt", Op::square_root, 1, Rule::half},
    {"sin", Op::sine, 1, Rule::none},
    {"cos", Op::cosine, 1, Rule::none},
    {"atan2", Op::arctangent2, 2, Rule::angle},
    {"hypot", Op::hypotenuse, 2, Rule::same},
    {"exp", Op::exponential, 1, Rule::none},
    {"log", Op::logarithm, 1, Rule::none},
}};

Operand ExpressionParser::parse_primary() {
  const Token& token = peek();
  if (token.kind == Token::Kind::number) {
    take();
    emit(Op::constant, 0, token.quantity.value);
    return {token.quantity.dimension, token.quantity.bare, true, token.quantity.value};
  }
  if (token.kind == Token::Kind::parameter) return parse_parameter(take());
  if (is("(")) {
    take();
    const Operand inner = parse_choice();
    expect(")");
    return inner;
  }
  if (token.kind == Token::Kind::name) {
    take();
    return is("(") ? parse_call(token) : parse_name(token);
  }
  fail(token, "bad-expression", "expected a value, got " + describe(token));
}

Operand ExpressionParser::parse_call(const Token& name) {
  if (name.text == "in") return parse_in();
  if (const auto statistic = parse_statistic(name)) return *statistic;
  for (const FunctionInfo& function : kFunctions) {
    if (function.name == name.text) return parse_function(name, function);
  }
  std::vector<std::string> names = {"in"};
  for (const FunctionInfo& function : kFunctions) names.emplace_back(function.name);
  fail(name, "unknown-function",
       fmt::format("unknown function '{}'{}", name.text, core::did_you_mean(name.text, names)));
}

// `rms(task.height.error)`, `max(abs(base.rpy.pitch))`: a statistic of a single signal or of its
// magnitude.
std::optional<Operand> ExpressionParser::parse_statistic(const Token& name) {
  const Statistic* statistic = find_statistic(name.text);
  if (!scope_.find_statistic || at_ + 2 >= tokens_.size() || scope_.signals == nullptr ||
      statistic == nullptr) {
    return std::nullopt;
  }
  const auto text = [this](std::size_t ahead) {
    const std::size_t k = at_ + ahead;
    return k < tokens_.size() ? std::string_view(tokens_[k].text) : std::string_view();
  };
  const bool magnitude = text(1) == "abs" && text(2) == "(" && text(4) == ")" && text(5) == ")";
  const Token& of = tokens_[at_ + (magnitude ? 3U : 1U)];
  const int signal = of.kind == Token::Kind::name ? scope_.signals->find(of.text) : -1;
  if (signal < 0 || (!magnitude && text(2) != ")")) return std::nullopt;
  const int index = scope_.find_statistic(*statistic, magnitude, signal);
  if (index < 0) fail(name, "unknown-function", fmt::format("no {}() of this signal", name.text));
  at_ += magnitude ? 6 : 3;
  emit(Op::signal, index);
  if (statistic->counts) return Operand{};
  return Operand{scope_.signals->info(signal).dimension, false, false, 0.0};
}

Operand ExpressionParser::parse_in() {
  expect("(");
  const Token& name = peek();
  if (name.kind != Token::Kind::name) {
    fail(name, "bad-expression", "in() expects the name of a state, got " + describe(name));
  }
  take();
  std::string why = "in() is not available here";
  const int state = scope_.find_state ? scope_.find_state(name.text, why) : -1;
  if (state < 0) fail(name, "unknown-state", why);
  expect(")");
  emit(Op::in_state, state);
  return {};
}

Operand ExpressionParser::parse_function(const Token& name, const FunctionInfo& function) {
  expect("(");
  const std::string text(function.name);
  const bool any = function.op == Op::minimum || function.op == Op::maximum;  // 2 or more
  Operand result;
  int count = 0;
  while (!is(")")) {
    if (count > 0) expect(",");
    const Token& at = peek();
    const Operand argument = parse_choice();
    if (function.rule == Rule::none) require_plain(argument, at, text + "()");
    result = count == 0 ? argument : unify(result, argument, at, text + "()");
    ++count;
    if (any && count > 1) emit(function.op);
    if (!any && count > function.arguments) break;
  }
  if (count < function.arguments || !is(")")) {
    fail(name, "bad-expression",
         fmt::format("{}() expects {} argument{}{}", text, function.arguments,
                     function.arguments == 1 ? "" : "s", any ? " or more" : ""));
  }
  take();
  if (!any) emit(function.op);
  return result_of(function, name, result);
}

Operand ExpressionParser::result_of(const FunctionInfo& function, const Token& name,
                                    Operand argument) {
  argument.literal = false;
  if (function.rule == Rule::same) return argument;
  if (function.rule != Rule::half) return {};
  const core::Dimension d = argument.dimension;
  if (d.m % 2 != 0 || d.kg % 2 != 0 || d.s % 2 != 0) {
    fail(name, "dimension", fmt::format("sqrt() of {} has no dimension", core::dimension_name(d)));
  }
  return {{static_cast<std::int8_t>(d.m / 2), static_cast<std::int8_t>(d.kg / 2),
           static_cast<std::int8_t>(d.s / 2)},
          argument.bare,
          false,
          0.0};
}

Operand ExpressionParser::parse_parameter(const Token& token) {
  const std::size_t dot = token.text.rfind('.');
  std::vector<std::string> names;
  for (const ParameterInfo& parameter : *scope_.parameters) {
    int component = parameter.size == 1 ? 0 : -1;
    if (parameter.name != token.text) {
      names.push_back(parameter.name);
      if (dot == std::string::npos || parameter.name != token.text.substr(0, dot)) continue;
      component = component_of(token.text.substr(dot + 1), parameter);
      if (component < 0) {
        fail(token, "unknown-parameter",
             fmt::format("parameter '{}' has no component '{}'", parameter.name,
                         token.text.substr(dot + 1)));
      }
    }
    if (component < 0) {
      fail(token, "size",
           fmt::format("parameter '{}' has {} values: write ${}.x", parameter.name, parameter.size,
                       parameter.name));
    }
    emit(Op::parameter, parameter.slot + component);
    return {parameter.dimension, parameter.bare, false, 0.0};
  }
  fail(token, "unknown-parameter",
       fmt::format("unknown parameter '${}'{}", token.text, core::did_you_mean(token.text, names)));
}

Operand ExpressionParser::parse_entry(const Token& token) {
  if (scope_.entry_axes == nullptr) {
    fail(token, "misplaced-name", "'entry' has a meaning only in a task's reference");
  }
  int axis = scope_.entry_axis;
  if (token.text.size() > 5) {
    const std::string name = token.text.substr(6);
    axis = -1;
    for (std::size_t k = 0; k < scope_.entry_axes->size(); ++k) {
      if ((*scope_.entry_axes)[k] == name) axis = static_cast<int>(k);
    }
    if (axis < 0) {
      fail(token, "unknown-axis",
           fmt::format("the task has no axis '{}'{}", name,
                       core::did_you_mean(name, *scope_.entry_axes)));
    }
  } else if (axis < 0) {
    fail(token, "misplaced-name", "'entry' needs an axis here: write entry.x");
  }
  emit(Op::entry, axis);
  const core::Dimension dimension =
      scope_.entry_dimensions == nullptr
          ? scope_.entry_dimension
          : (*scope_.entry_dimensions)[static_cast<std::size_t>(axis)];
  return {dimension, false, false, 0.0};
}

Operand ExpressionParser::parse_name(const Token& token) {
  const std::string& name = token.text;
  if (name == "true" || name == "false") {
    emit(Op::constant, 0, name == "true" ? 1.0 : 0.0);
    return {};
  }
  if (name == "t") {
    if (scope_.state < 0) fail(token, "misplaced-name", "'t' has a meaning only in a state");
    emit(Op::state_time, scope_.state);
    return {core::kTime, false, false, 0.0};
  }
  if (name == "time") {
    emit(Op::time);
    return {core::kTime, false, false, 0.0};
  }
  if (name == "entry" || name.starts_with("entry.")) return parse_entry(token);
  const int signal = scope_.signals == nullptr ? -1 : scope_.signals->find(name);
  if (signal >= 0) {
    emit(Op::signal, signal);
    return {scope_.signals->info(signal).dimension, false, false, 0.0};
  }
  unknown_name(token);
}

void ExpressionParser::unknown_name(const Token& token) {
  std::vector<std::string> names = {"t", "time", "entry"};
  if (scope_.signals != nullptr) {
    for (const auto& info : scope_.signals->infos()) names.push_back(info.name);
  }
  for (const ParameterInfo& parameter : *scope_.parameters) {
    if (parameter.name == token.text) {
      fail(
          token, "unknown-signal",
          fmt::format("unknown signal '{}': a parameter is written '${}'", token.text, token.text));
    }
  }
  if (core::parse_unit(token.text)) {
    fail(token, "unknown-signal",
         fmt::format("unknown signal '{}': a unit stands right behind its number, as in '2 1/s'",
                     token.text));
  }
  fail(token, "unknown-signal",
       fmt::format("unknown signal '{}'{}", token.text, core::did_you_mean(token.text, names)));
}

}  // namespace footfall::behaviors
