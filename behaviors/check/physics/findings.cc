// Collects findings over postures and configurations; see findings.h.
#include "behaviors/check/physics/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace footfall::behaviors {

PhysicsFindings::Finding* PhysicsFindings::find(std::vector<Finding>& list, const Finding& like) {
  const auto found = std::find_if(list.begin(), list.end(), [&like](const Finding& f) {
    return f.mark.file == like.mark.file && f.mark.line == like.mark.line &&
           f.mark.column == like.mark.column && f.id == like.id && f.subject == like.subject;
  });
  return found == list.end() ? nullptr : &*found;
}

void PhysicsFindings::add(core::Severity worst, core::Mark mark, std::string_view id,
                          std::string_view subject, std::string text) {
  Finding finding = {worst, mark, std::string(id), std::string(subject), std::move(text), 1};
  if (Finding* known = find(open_, finding)) {
    ++known->hits;
  } else {
    open_.push_back(std::move(finding));
  }
}

void PhysicsFindings::settle(int postures) {
  for (Finding& finding : open_) {
    if (finding.hits < postures) {
      finding.severity = core::Severity::warning;
      finding.text +=
          fmt::format(" (in {} of {} postures around the nominal one)", finding.hits, postures);
    }
    Finding* known = find(settled_, finding);
    if (known == nullptr) {
      settled_.push_back(std::move(finding));
    } else if (known->severity == core::Severity::warning &&
               finding.severity == core::Severity::error) {
      *known = std::move(finding);
    }
  }
  open_.clear();
}

void PhysicsFindings::report(core::Diagnostics& diagnostics) const {
  for (const Finding& finding : settled_) {
    if (finding.severity == core::Severity::error) {
      diagnostics.error(finding.mark, finding.id, finding.text);
    } else {
      diagnostics.warning(finding.mark, finding.id, finding.text);
    }
  }
}

}  // namespace footfall::behaviors
