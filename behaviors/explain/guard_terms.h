// The terms of a guard and their values: for explanations after a run, never in a tick.
#pragma once

#include <string>
#include <vector>

#include "behaviors/compiled/behavior.h"

namespace footfall::behaviors {

// An operand of `and`, `or` or `not` in a guard.
struct GuardTerm {
  std::string text;  // with its values: `contact.left_foot false`, `t 0.081 s < 0.145 s`
  bool holds = false;
};

// The terms of an expression in their written order, evaluated in `context`.
std::vector<GuardTerm> guard_terms(const Behavior& behavior, int expression,
                                   const EvaluationContext& context);

}  // namespace footfall::behaviors
