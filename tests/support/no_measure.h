// A machine without a robot: every task measures zero.
#pragma once

#include "behaviors/machine/machine.h"

namespace footfall::tests {

class NoMeasure final : public behaviors::Measure {
 public:
  double position(tasks::TaskType, int, int) const noexcept override { return 0.0; }
};

}  // namespace footfall::tests
