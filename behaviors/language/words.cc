// Built-in names of expressions and of `on:`; see language.h.
#include "behaviors/language/language.h"

namespace footfall::behaviors {
namespace {

using core::WordSpec;

constexpr WordSpec kFunctionRows[] = {
    {"abs(a)", "absolute value"},
    {"min(a, b, ...)", "minimum; of one dimension"},
    {"max(a, b, ...)", "maximum; of one dimension"},
    {"clamp(a, minimum, maximum)", "a, limited to the range"},
    {"sqrt(a)", "square root; half the dimension"},
    {"sin(a)", "of an angle"},
    {"cos(a)", "of an angle"},
    {"atan2(y, x)", "the angle of the direction (x, y)"},
    {"hypot(a, b)", "the length of the vector (a, b)"},
    {"exp(a)", "exponential of a plain number"},
    {"log(a)", "natural logarithm of a plain number"},
    {"in(STATE)", "whether a state is active; a name as in `to`"},
};

constexpr WordSpec kOperatorRows[] = {
    {"a ? b : c", "b if a is true, else c"},
    {"or", "true if one operand is"},
    {"and", "true if both operands are"},
    {"not", "negation"},
    {"< <= > >= == !=", "comparison of one dimension"},
    {"+ -", "of one dimension"},
    {"* /", "dimensions multiply and divide"},
    {"-a", "negative value"},
    {"^", "power, the exponent a plain number"},
};

constexpr WordSpec kValueNameRows[] = {
    {"$NAME, $NAME.x", "a parameter, or one of its components (x y z are the first three)"},
    {"t", "time since entry of the state that contains it"},
    {"time", "time since the start"},
    {"entry, entry.AXIS", "in a task's reference: value at the task's start"},
    {"true, false", "1, 0"},
    {"SIGNAL", "any signal by its name"},
};

constexpr WordSpec kEventFamilyRows[] = {
    {"contact.CONTACT.touchdown", "its switch has closed"},
    {"contact.CONTACT.liftoff", "its switch has opened"},
    {"planner.NAME.done", "its answer arrived in time"},
    {"planner.NAME.late", "a deadline passed without an answer"},
    {"planner.NAME.failed", "it found no plan"},
    {"parameter.changed.NAME", "a parameter or gain was edited externally"},
    {"done.state.NAME", "a compound state entered a final child, or a parallel one is done"},
    {"fault.NAME", "a run-time fault; the robot file configures the reactions"},
    {"error.execution",
     "an action's value was out of range or not finite, or a tick had too many transitions"},
};

}  // namespace

constinit const std::span<const core::WordSpec> kExpressionFunctions = kFunctionRows;
constinit const std::span<const core::WordSpec> kExpressionOperators = kOperatorRows;
constinit const std::span<const core::WordSpec> kExpressionNames = kValueNameRows;
constinit const std::span<const core::WordSpec> kEventFamilies = kEventFamilyRows;

}  // namespace footfall::behaviors
