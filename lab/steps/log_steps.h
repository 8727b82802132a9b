// The steps of a run, from its log. Where a simulator told the truth, contacts, feet and the base
// are true: a robot is judged by what it did. What plans and tasks say is in the estimator's frame,
// and compared there.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lab/log/reader.h"
#include "lab/steps/step_table.h"

namespace footfall::lab {

struct RunSteps {
  std::vector<std::string> feet;  // names by StepRow::foot
  std::vector<StepRow> rows;
  bool truth = false;  // false: what the estimator believed; slip paths then contain its noise
};

// Of one log after the other: a run has one for each of its behaviors. Read them with all_rows and
// inputs; a log without inputs, or without a description of its setup, gives no steps.
class LogSteps {
 public:
  LogSteps();
  ~LogSteps();
  // Throws std::runtime_error with one sentence if the log's robot cannot be loaded.
  void add(const Log& log);
  RunSteps steps() const;

 private:
  struct Table;
  std::unique_ptr<Table> table_;
};

RunSteps log_steps(const Log& log);

}  // namespace footfall::lab
