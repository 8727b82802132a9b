// What a log's rows say beside its inputs: the first planner's last answer, the references of the
// feet, and the state as the estimator gave it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "lab/log/reader.h"
#include "lab/steps/step_table.h"
#include "model/robot/description.h"
#include "model/state.h"

namespace footfall::lab {

class StepSignals {
 public:
  StepSignals(const Log& log, const model::RobotDescription& robot);

  // The plan, and reference and measured place of each foot that a task moves.
  void plan(std::size_t row, StepSample& out) const;
  // References of roll and pitch, rad; 0 while they are not controlled.
  std::array<double, 2> attitude(std::size_t row) const;
  // As estimated.
  model::State state(std::size_t row) const;

 private:
  using Column = const std::vector<float>*;
  // A task of a point in x, in y or in both.
  struct PointTask {
    std::array<Column, 2> reference{}, measured{};
  };
  void foot(std::size_t row, std::size_t contact, StepSample::Foot& foot) const;

  std::vector<PointTask> tasks_;
  std::vector<std::array<Column, 2>> feet_;  // place as estimated
  std::vector<std::array<Column, 2>> attitudes_;
  std::array<Column, 2> target_{}, predicted_{};
  Column switch_time_ = nullptr, extension_ = nullptr;
  std::array<Column, 3> position_{}, velocity_{}, rpy_{}, angular_{};
  std::vector<std::array<Column, 2>> joints_;  // position and velocity
};

}  // namespace footfall::lab
