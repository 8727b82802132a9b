// Findings of the physics checks, collected over postures and configurations before they become
// diagnostics: a deficiency in all postures has its full severity, in some it is a warning. Load
// time only.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.h"

namespace footfall::behaviors {

class PhysicsFindings {
 public:
  // Adds a finding in the current posture. `subject` distinguishes findings of one id at one place.
  void add(core::Severity worst, core::Mark mark, std::string_view id, std::string_view subject,
           std::string text);
  // Ends a configuration that was evaluated in this many postures.
  void settle(int postures);
  // Reports each finding once, with the severity of the worst configuration.
  void report(core::Diagnostics& diagnostics) const;

 private:
  struct Finding {
    core::Severity severity = core::Severity::error;
    core::Mark mark;
    std::string id, subject, text;
    int hits = 0;
  };
  static Finding* find(std::vector<Finding>& list, const Finding& like);

  std::vector<Finding> open_;  // of the current configuration
  std::vector<Finding> settled_;
};

}  // namespace footfall::behaviors
