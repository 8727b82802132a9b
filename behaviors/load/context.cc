// Compiles values and resolves names of a behavior file; see context.h.
#include "behaviors/load/context.h"

#include <fmt/format.h>

#include <algorithm>

#include "behaviors/expression/tokens.h"
#include "behaviors/load/substitution.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

// Columns of signs separated from their operand, or doubled: in `= - $x` the left operand is
// missing.
std::vector<int> stray_signs(const std::string& text) {
  std::vector<int> out;
  ExpressionError ignored;
  const auto tokens = tokenize(text, ignored);
  if (!tokens) return out;
  const auto is_sign = [](const Token& token) {
    return token.kind == Token::Kind::symbol && (token.text == "+" || token.text == "-");
  };
  for (std::size_t k = 0; k + 1 < tokens->size(); ++k) {
    const Token& token = (*tokens)[k];
    if (!is_sign(token)) continue;
    const Token* before = k == 0 ? nullptr : &(*tokens)[k - 1];
    const bool operand_before =
        before != nullptr && (before->text == ")" || before->kind == Token::Kind::number ||
                              before->kind == Token::Kind::parameter ||
                              (before->kind == Token::Kind::name && before->text != "and" &&
                               before->text != "or" && before->text != "not"));
    if (operand_before) continue;
    const bool apart = (*tokens)[k + 1].offset > token.offset + 1;
    const bool second = before != nullptr && is_sign(*before);
    if (apart || second) out.push_back(token.offset);
  }
  return out;
}

}  // namespace

void LoadContext::error(core::Mark mark, std::string_view id, std::string text) {
  diagnostics.error(mark, id, std::move(text));
}

void LoadContext::warning(core::Mark mark, std::string_view id, std::string text) {
  diagnostics.warning(mark, id, std::move(text));
}

void LoadContext::absence(core::Mark mark, std::string_view id, std::string text) {
  if (!diagnostics.has_errors()) diagnostics.warning(mark, id, std::move(text));
}

int LoadContext::compile(const core::YamlNode& node, std::string_view text, std::size_t offset,
                         std::optional<core::Dimension> expected, const ValueScope& scope) {
  const MarkedText marked = read_marked(text);
  ExpressionScope names;
  names.signals = &behavior.signals;
  names.parameters = &behavior.parameters;
  names.state = scope.state;
  names.entry_axes = scope.entry_axes;
  names.entry_axis = scope.entry_axis;
  names.entry_dimensions = scope.entry_dimensions;
  names.find_state = [this, &scope](std::string_view name, std::string& why) {
    return find_target(std::max(0, scope.state), name, why);
  };
  ExpressionError problem;
  const int index = compile_expression(marked.text, names, expected, behavior.expressions, problem);
  const auto place = [&](int at) {
    core::Mark mark = node.mark;
    mark.column += static_cast<int>(offset) + (node.quoted ? 1 : 0) + marked.column(at);
    // A name of the template's own text that is unknown is no mistake of an argument.
    if (problem.id != "dimension" && !marked.is_inside(at)) mark.cause = {};
    return mark;
  };
  if (index < 0) {
    if (states_missing && problem.id == "unknown-state") return -1;
    error(place(problem.offset), problem.id, problem.text);
    return -1;
  }
  remember_place(index, place(0));
  const auto value = constant_value(index);
  if (value && !std::isfinite(*value) && problem.id.empty()) {
    problem = {0, "no-value", fmt::format("'{}' has no value", marked.text)};
  }
  if (!problem.id.empty()) warning(place(problem.offset), problem.id, problem.text);
  for (const int sign : stray_signs(marked.text)) {
    warning(place(sign), "stray-sign",
            fmt::format("a '{}' that stands alone: is a value missing before it? Write signs close "
                        "to what they belong to",
                        marked.text[static_cast<std::size_t>(sign)]));
  }
  return index;
}

int LoadContext::compile_value(const core::YamlNode& node, std::optional<core::Dimension> expected,
                               const ValueScope& scope) {
  if (!node.is_scalar() || node.scalar.empty()) {
    core::report_expected(node, expected ? core::dimension_name(*expected) : "a value",
                          diagnostics);
    return -1;
  }
  if (core::is_expression(node)) {
    return compile(node, std::string_view(node.scalar).substr(1), 1, expected, scope);
  }
  if (expected && !node.quoted && (node.scalar == "true" || node.scalar == "false")) {
    core::report_expected(node, core::dimension_name(*expected), diagnostics);
    return -1;
  }
  const char first = node.scalar.front();
  const bool name = (first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z');
  const bool plain = node.scalar.find_first_of(" +-*/^()?:,<>=") == std::string::npos;
  if (first == '$' || (name && plain)) return compile(node, node.scalar, 0, expected, scope);
  if (!expected) {
    const auto any = core::read_any_quantity(node, diagnostics);
    if (!any) return -1;
    return remember_place(behavior.expressions.add_constant(any->value, any->dimension), node.mark);
  }
  const auto value = core::read_quantity(node, *expected, diagnostics);
  if (!value) return -1;
  return remember_place(behavior.expressions.add_constant(*value, *expected), node.mark);
}

int LoadContext::remember_place(int expression, core::Mark mark) {
  auto& places = behavior.expression_places;
  places.resize(std::max(places.size(), static_cast<std::size_t>(expression) + 1));
  places[static_cast<std::size_t>(expression)] = diagnostics.place_text(mark);
  return expression;
}

int LoadContext::compile_condition(const core::YamlNode& node, const ValueScope& scope) {
  if (!node.is_scalar() || node.scalar.empty()) {
    core::report_expected(node, "a condition", diagnostics);
    return -1;
  }
  const std::size_t skip = core::is_expression(node) ? 1 : 0;
  return compile(node, std::string_view(node.scalar).substr(skip), skip, core::kNone, scope);
}

std::optional<double> LoadContext::constant_value(int expression) const {
  if (expression < 0 || !behavior.expressions[expression].constant) return std::nullopt;
  return evaluate(behavior.expressions, expression, {});
}

int LoadContext::compile_time(const core::YamlNode& node, const ValueScope& scope,
                              const TimeRule& rule) {
  const int expression = compile_value(node, core::kTime, scope);
  if (expression < 0) return -1;
  const auto value = constant_value(expression);
  if (!value) {
    behavior.times.push_back({expression, rule.guard, rule.positive, scope.state, node.mark});
  } else if (periods_of(*value, behavior.rate_mhz) < 0) {
    error(node.mark, "out-of-range",
          "expected a time from 0 s to 10^6 s, got " + core::describe(node));
    return -1;
  } else if (rule.positive && *value <= 0.0) {
    error(node.mark, "out-of-range", "expected a time above 0 s");
  }
  return expression;
}

// Searches the state and below, then its parent and below, and so on; the shallowest match wins.
int LoadContext::find_target(int from, std::string_view name, std::string& why) const {
  const auto& states = behavior.states;
  for (int scope = from; scope >= 0; scope = states[static_cast<std::size_t>(scope)].parent) {
    int best = -1, other = -1;
    for (int s = std::max(scope, 1); s < states[static_cast<std::size_t>(scope)].end; ++s) {
      const StateInfo& info = states[static_cast<std::size_t>(s)];
      if (name.empty() || info.path.back() != name.back()) continue;  // most of thousands go here
      const bool fits =
          info.path == name || (info.path.ends_with(name) && info.path.size() > name.size() &&
                                info.path[info.path.size() - name.size() - 1] == '.');
      if (!fits) continue;
      if (best >= 0 && info.depth > states[static_cast<std::size_t>(best)].depth) continue;
      other = best >= 0 && info.depth == states[static_cast<std::size_t>(best)].depth ? best : -1;
      best = s;
    }
    if (other >= 0) {
      why = fmt::format("state '{}' is ambiguous, write more of the path: '{}' or '{}'", name,
                        states[static_cast<std::size_t>(other)].path,
                        states[static_cast<std::size_t>(best)].path);
      return -1;
    }
    if (best >= 0) return best;
  }
  if (name == states[0].path) return 0;
  std::vector<std::string> names;
  // Limit of guesses, because each one compares with every state.
  constexpr int kGuesses = 100;
  if (++state_guesses <= kGuesses) {
    for (const StateInfo& info : states) names.push_back(info.name);
  }
  why = fmt::format("unknown state '{}'{}", name, core::did_you_mean(name, names));
  return -1;
}

int LoadContext::require_target(int from, const core::YamlNode& node) {
  if (!node.is_scalar() || node.scalar.empty()) {
    core::report_expected(node, "the name of a state", diagnostics);
    return -1;
  }
  std::string why;
  const int target = find_target(from, node.scalar, why);
  if (target < 0 && !states_missing) {
    const bool several = why.find("ambiguous") != std::string::npos;
    error(node.mark, several ? "ambiguous-state" : "unknown-state", why);
  }
  return target;
}

int LoadContext::add_event(std::string_view name) {
  const auto [found, fresh] =
      event_ids.try_emplace(std::string(name), static_cast<int>(behavior.events.size()));
  if (fresh) behavior.events.emplace_back(name);
  return found->second;
}

std::vector<std::string> LoadContext::parameter_names() const {
  std::vector<std::string> names;
  for (const ParameterInfo& parameter : behavior.parameters) {
    if (!parameter.gain) names.push_back(parameter.name);
  }
  return names;
}

std::vector<std::string> LoadContext::contact_names() const {
  std::vector<std::string> names;
  for (const auto& contact : behavior.robot.contacts) names.push_back(contact.name);
  return names;
}

std::vector<std::string> LoadContext::joint_names() const {
  std::vector<std::string> names;
  for (const auto& joint : behavior.robot.joints) names.push_back(joint.name);
  return names;
}

int LoadContext::require_contact(const core::YamlNode& node) {
  if (!node.is_scalar() || node.scalar.empty()) {
    core::report_expected(node, "the name of a contact", diagnostics);
    return -1;
  }
  const int contact = behavior.robot.find_contact(node.scalar);
  if (contact < 0) {
    error(node.mark, "unknown-contact",
          fmt::format("unknown contact '{}'{}", node.scalar,
                      core::did_you_mean_or_list(node.scalar, contact_names())));
  }
  return contact;
}

}  // namespace footfall::behaviors
