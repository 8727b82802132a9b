// PhysicsFindings of the physics checks, gathered over postures and configurations before they
// become diagnostics: a deficiency in all postures is as bad as it can be, in some it is a warning.
// Load time only.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.h"

namespace footfall::behaviors {

class PhysicsFindings {
 public:
  // In the posture being judged. `subject` tells apart findings of one id at one place.
  void add(core::Severity worst, core::Mark mark, std::string_view id, std::string_view subject,
           std::string text);
  // Ends a configuration that was judged in this many postures.
  void settle(int postures);
  // Each finding once, with the severity of the worst configuration.
  void report(core::Diagnostics& diagnostics) const;

 private:
  struct Finding {
    core::Severity severity = core::Severity::error;
    core::Mark mark;
    std::string id, subject, text;
    int hits = 0;
  };
  static Finding* find(std::vector<Finding>& list, const Finding& like);

  std::vector<Finding> open_;  // of the present configuration
  std::vector<Finding> settled_;
};

}  // namespace footfall::behaviors
