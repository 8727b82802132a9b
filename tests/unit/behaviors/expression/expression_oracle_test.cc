// Random expressions against two oracles: a walk over the tree that follows the language's rules
// word for word, and, where no part is infinite or not a number, muParser. All three compute with
// the same functions in the same order, so they agree to the last bit; only powers 2 and 3, which
// the language multiplies out, are given to muParser as functions (and compared in a test of their
// own). FOOTFALL_EXPRESSIONS sets how many there are.
#include <gtest/gtest.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "behaviors/expression/expression.h"

namespace footfall::tests {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kNames = 8;
// Signals, two of them contacts, then parameters, then in(walk).
constexpr const char* kOurNames[kNames] = {"p", "q.x", "r", "k", "l", "$v", "$w.y", "in(walk)"};
constexpr const char* kTheirNames[kNames] = {"p", "qx", "r", "k", "l", "v", "wy", "walk"};

// An operation of the language: how it is written, and how strongly it binds.
struct Operation {
  const char* ours;
  const char* theirs;
  int operands;
  int strength;  // 0 choice, 1 or, 2 and, 3 not, 4 comparison, 5 sum, 6 product, 7 sign, 8 power
};
constexpr int kPrimary = 9;
constexpr Operation kOperations[] = {
    {"?", "?", 3, 0},         {"or", "||", 2, 1},   {"and", "&&", 2, 2},  {"not", "not", 1, 3},
    {"<", "<", 2, 4},         {"<=", "<=", 2, 4},   {">", ">", 2, 4},     {">=", ">=", 2, 4},
    {"==", "==", 2, 4},       {"!=", "!=", 2, 4},   {"+", "+", 2, 5},     {"-", "-", 2, 5},
    {"*", "*", 2, 6},         {"/", "/", 2, 6},     {"-", "-", 1, 7},     {"^", "^", 2, 8},
    {"abs", "abs", 1, 9},     {"min", "min", 2, 9}, {"max", "max", 2, 9}, {"clamp", "clamp", 3, 9},
    {"sqrt", "sqrt", 1, 9},   {"sin", "sin", 1, 9}, {"cos", "cos", 1, 9}, {"atan2", "atan2", 2, 9},
    {"hypot", "hypot", 2, 9}, {"exp", "exp", 1, 9}, {"log", "ln", 1, 9},
};

struct Node {
  const Operation* operation = nullptr;
  int name = -1;       // of a name
  std::string number;  // of a number
  double value = 0.0;  // of the number
  std::vector<Node> operands;
};

using Random = std::mt19937;

int below(Random& random, int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }

Node random_node(Random& random, int depth) {
  Node node;
  if (depth == 0 || below(random, 6) == 0) {
    if (below(random, 3) > 0) {
      node.name = below(random, kNames);
    } else {
      constexpr const char* kNumbers[] = {"0", "1", "2", "3", "0.5", "1.5", "7e-3", "12.25", "100"};
      node.number = kNumbers[below(random, 9)];
      node.value = std::strtod(node.number.c_str(), nullptr);
    }
    return node;
  }
  node.operation = &kOperations[below(random, static_cast<int>(std::size(kOperations)))];
  for (int k = 0; k < node.operation->operands; ++k) {
    node.operands.push_back(random_node(random, depth - 1));
  }
  return node;
}

// 2 or 3 if it is a power that the language multiplies out.
int small_power(const Node& node) {
  if (node.operation == nullptr || std::string(node.operation->ours) != "^") return 0;
  const Node& exponent = node.operands[1];
  const bool small = exponent.number == "2" || exponent.number == "3";
  return small ? static_cast<int>(exponent.value) : 0;
}

std::string text_of(const Node& node, bool ours);

// In brackets if it binds weaker than `strength`.
std::string operand(const Node& node, int strength, bool ours) {
  const int own = node.operation == nullptr ? kPrimary : node.operation->strength;
  return own < strength ? "(" + text_of(node, ours) + ")" : text_of(node, ours);
}

std::string function_text(const Node& node, const std::string& name, bool ours) {
  std::string text = name + "(";
  for (std::size_t k = 0; k < node.operands.size(); ++k) {
    text += (k > 0 ? ", " : "") + text_of(node.operands[k], ours);
  }
  return text + ")";
}

std::string text_of(const Node& node, bool ours) {
  if (!node.number.empty()) return node.number;
  if (node.name >= 0) return (ours ? kOurNames : kTheirNames)[node.name];
  const Operation& operation = *node.operation;
  const std::string name = ours ? operation.ours : operation.theirs;
  const auto& o = node.operands;
  const int s = operation.strength;
  if (s == kPrimary) return function_text(node, name, ours);
  if (!ours && small_power(node) == 2) return "square(" + text_of(o[0], ours) + ")";
  if (!ours && small_power(node) == 3) return "cube(" + text_of(o[0], ours) + ")";
  if (s == 0) {
    return operand(o[0], 1, ours) + " ? " + text_of(o[1], ours) + " : " + text_of(o[2], ours);
  }
  if (s == 3) {
    return ours ? "not " + operand(o[0], 3, ours) : "(" + operand(o[0], 5, ours) + " == 0)";
  }
  if (s == 7) return "-" + operand(o[0], 8, ours);
  if (s == 8) return operand(o[0], 9, ours) + "^" + operand(o[1], 8, ours);
  // Left to right; a comparison does not chain.
  return operand(o[0], s == 4 ? 5 : s, ours) + " " + name + " " + operand(o[1], s + 1, ours);
}

// The language's rules. `finite` becomes false if any part, counting or not, is not finite.
struct Walk {
  const double* names;
  bool finite = true;

  double value(const Node& node) {
    const double result = value_of(node);
    finite = finite && std::isfinite(result);
    return result;
  }

  double value_of(const Node& node) {
    if (node.name >= 0) return names[node.name];
    if (node.operation == nullptr) return node.value;
    double v[3] = {0.0, 0.0, 0.0};
    for (std::size_t k = 0; k < node.operands.size(); ++k) v[k] = value(node.operands[k]);
    const std::string name = node.operation->ours;
    const double a = v[0], b = v[1], c = v[2];
    if (name == "?") return !std::isfinite(a) ? kNaN : a != 0.0 ? b : c;
    if (name == "or" || name == "and") {
      if (!std::isfinite(a)) return kNaN;
      if ((a != 0.0) == (name == "or")) return a != 0.0 ? 1.0 : 0.0;
      return std::isfinite(b) ? (b != 0.0 ? 1.0 : 0.0) : kNaN;
    }
    if (name == "not") return std::isfinite(a) ? (a == 0.0 ? 1.0 : 0.0) : kNaN;
    if (node.operation->strength == 4) return comparison(name, a, b);
    if (small_power(node) == 2) return a * a;
    if (small_power(node) == 3) return a * a * a;
    return arithmetic(name, node.operands.size() == 1, a, b, c);
  }

  static double comparison(const std::string& name, double a, double b) {
    if (!std::isfinite(a) || !std::isfinite(b)) return kNaN;
    if (name == "<") return a < b ? 1.0 : 0.0;
    if (name == "<=") return a <= b ? 1.0 : 0.0;
    if (name == ">") return a > b ? 1.0 : 0.0;
    if (name == ">=") return a >= b ? 1.0 : 0.0;
    return (a == b) == (name == "==") ? 1.0 : 0.0;
  }

  static double arithmetic(const std::string& name, bool single, double a, double b, double c) {
    if (name == "+") return a + b;
    if (name == "-") return single ? -a : a - b;
    if (name == "*") return a * b;
    if (name == "/") return b == 0.0 ? kNaN : a / b;
    if (name == "^") return std::pow(a, b);
    if (name == "abs") return std::abs(a);
    if (name == "min") return std::isnan(a) || std::isnan(b) ? kNaN : std::min(a, b);
    if (name == "max") return std::isnan(a) || std::isnan(b) ? kNaN : std::max(a, b);
    if (name == "clamp") return b <= c && !std::isnan(a) ? std::min(std::max(a, b), c) : kNaN;
    if (name == "sqrt") return std::sqrt(a);
    if (name == "sin") return std::sin(a);
    if (name == "cos") return std::cos(a);
    if (name == "atan2") return std::atan2(a, b);
    if (name == "hypot") return std::hypot(a, b);
    return name == "exp" ? std::exp(a) : std::log(a);
  }
};

double square(double x) { return x * x; }
double cube(double x) { return x * x * x; }
double clamp(double x, double low, double high) { return std::min(std::max(x, low), high); }
double hypotenuse(double x, double y) { return std::hypot(x, y); }

// The same values for both.
class Oracles : public testing::Test {
 protected:
  Oracles() {
    for (int k = 0; k < 5; ++k) signals_.add(kOurNames[k], core::kNone, "");
    add_parameter("v", 0, 1);
    add_parameter("w", 1, 2);
    scope_.signals = &signals_;
    scope_.parameters = &parameters_;
    scope_.find_state = [](std::string_view, std::string&) { return 0; };
    context_.signals = signals_.values();
    context_.parameters = parameter_values_;
    context_.active = &active_;
    for (int k = 0; k < kNames; ++k) parser_.DefineVar(kTheirNames[k], &names_[k]);
    parser_.DefineFun("square", square);
    parser_.DefineFun("cube", cube);
    parser_.DefineFun("clamp", clamp);
    parser_.DefineFun("hypot", hypotenuse);
    parser_.EnableOptimizer(false);  // it reorders sums
  }
  void add_parameter(const char* name, int slot, int size) {
    behaviors::ParameterInfo info;
    info.name = name;
    info.slot = slot;
    info.size = size;
    info.bare = true;
    parameters_.push_back(info);
  }
  void set_names(Random& random) {
    for (int k = 0; k < kNames; ++k) {
      const bool condition = k == 3 || k == 4 || k == 7;
      names_[k] = condition ? below(random, 2) : 0.25 * (below(random, 25) - 12);
      if (!condition && below(random, 2) == 0) names_[k] += 1e-3 * below(random, 1000);
    }
    for (int k = 0; k < 5; ++k) signals_[k] = names_[k];
    parameter_values_[0] = names_[5];
    parameter_values_[2] = names_[6];
    active_ = names_[7] != 0.0 ? 1 : 0;
  }
  // NaN and a failure if it does not compile.
  double ours(const std::string& text) {
    pool_ = {};
    behaviors::ExpressionError error;
    const int index = compile_expression(text, scope_, std::nullopt, pool_, error);
    EXPECT_GE(index, 0) << text << ": " << error.text << " at " << error.offset;
    return index < 0 ? kNaN : evaluate(pool_, index, context_);
  }
  double theirs(const std::string& text) {
    try {
      parser_.SetExpr(text);
      return parser_.Eval();
    } catch (const mu::Parser::exception_type& error) {
      ADD_FAILURE() << text << ": " << error.GetMsg();
      return kNaN;
    }
  }

  core::SignalTable signals_;
  std::vector<behaviors::ParameterInfo> parameters_;
  double parameter_values_[3] = {};
  std::uint8_t active_ = 0;
  double names_[kNames] = {};
  behaviors::ExpressionScope scope_;
  behaviors::ExpressionPool pool_;
  behaviors::EvaluationContext context_;
  mu::Parser parser_;
};

TEST_F(Oracles, RandomExpressionsHaveTheSameValueToTheLastBit) {
  const char* wanted = std::getenv("FOOTFALL_EXPRESSIONS");
  const int count = wanted == nullptr ? 20000 : std::atoi(wanted);
  Random random(20160806);
  int finite = 0;
  for (int k = 0; k < count && !HasFailure(); ++k) {
    Node node = random_node(random, 1 + below(random, 5));
    set_names(random);
    Walk walk{names_};
    const double expected = walk.value(node);
    const std::string text = text_of(node, true);
    const double value = ours(text);
    EXPECT_TRUE(value == expected || (std::isnan(value) && std::isnan(expected)))
        << text << ": " << value << ", expected " << expected;
    if (!walk.finite) continue;
    ++finite;
    const std::string their_text = text_of(node, false);
    EXPECT_EQ(value, theirs(their_text)) << text << " and " << their_text;
  }
  RecordProperty("expressions", count);
  RecordProperty("with_muparser", finite);
  std::printf("%d expressions equal to the walk, %d of them to muParser\n", count, finite);
  EXPECT_GT(finite, count / 2);
}

// What an author expects, and muParser agrees: powers before signs, from right to left.
TEST_F(Oracles, SignsAndPowersBindAsInMathematics) {
  for (const char* text : {"-2^2", "2^3^2", "2^-1", "-2^-2", "3*-2", "2 - -3", "-3^2*2", "8/2/2"}) {
    EXPECT_EQ(ours(text), theirs(text)) << text;
  }
  EXPECT_EQ(ours("-2^2"), -4.0);
  EXPECT_EQ(ours("2^3^2"), 512.0);
  EXPECT_EQ(ours("-2^-2"), -0.25);
}

// x*x is rounded once and pow to less than one unit in the last place, so they differ by one at
// most; x*x*x is rounded twice, the first time magnified by nothing: two and a half, so three.
TEST_F(Oracles, MultipliedOutPowersAreWithinTheirRoundingOfPow) {
  Random random(3);
  for (int k = 0; k < 1000; ++k) {
    set_names(random);
    const double ulp = std::numeric_limits<double>::epsilon();
    EXPECT_NEAR(ours("p^2"), theirs("p^2"), ulp * std::abs(theirs("p^2")));
    EXPECT_NEAR(ours("p^3"), theirs("p^3"), 3 * ulp * std::abs(theirs("p^3")));
  }
}

}  // namespace
}  // namespace footfall::tests
