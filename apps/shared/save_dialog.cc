// Shows, confirms and writes changed values; see save_dialog.h.
#include "apps/shared/save_dialog.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "apps/shared/commands.h"

namespace footfall::apps {

bool confirmed(const char* question) {
  if (::isatty(STDIN_FILENO) == 0) {
    throw InputError("error: nothing was done: this is no terminal to ask on (--yes does it)\n");
  }
  fmt::print("{} [y/N] ", question);
  std::fflush(stdout);
  std::string answer;
  return std::getline(std::cin, answer) && (answer == "y" || answer == "yes");
}

int show_and_write(const behaviors::SavePlan& plan, const std::string& name, bool dry_run,
                   bool yes) {
  fmt::print("{}", behaviors::unified_diff(plan));
  std::fflush(stdout);
  for (const std::string& note : plan.notes) fmt::print(stderr, "note: {}\n", note);
  if (plan.files.empty()) fmt::print("{} has these values already\n", name);
  if (plan.files.empty() || dry_run) return kGood;
  if (!yes && !confirmed("Write?")) {
    fmt::print("nothing was written\n");
    return kRobotFailed;
  }
  const auto reasons = behaviors::write_saved(plan);
  for (const std::string& reason : reasons) fmt::print(stderr, "error: {}\n", reason);
  if (!reasons.empty()) return kMachineFailed;
  for (const auto& file : plan.files) fmt::print("{}: written\n", file.path);
  return kGood;
}

}  // namespace footfall::apps
