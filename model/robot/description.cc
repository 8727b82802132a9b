// Look-ups in a robot's description, and where robots are found; loading is in loader.cc.
#include "model/robot/description.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string_view>

#include "core/text/search_folders.h"

namespace footfall::model {

namespace {

template <typename Named>
int find_named(const std::vector<Named>& list, std::string_view name) {
  const auto found = std::find_if(list.begin(), list.end(),
                                  [name](const Named& item) { return item.name == name; });
  return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

}  // namespace

std::vector<double> RobotDescription::torque_limits() const {
  std::vector<double> limits;
  for (const JointDescription& joint : joints) {
    limits.push_back(joint.torque_limit > 0.0 ? command_limit * joint.torque_limit
                                              : std::numeric_limits<double>::infinity());
  }
  return limits;
}

int RobotDescription::find_joint(std::string_view joint) const { return find_named(joints, joint); }
int RobotDescription::find_contact(std::string_view contact) const {
  return find_named(contacts, contact);
}
int RobotDescription::find_group(std::string_view group) const { return find_named(groups, group); }

std::string find_robot_file(const std::string& name, const std::vector<std::string>& search) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (name.empty()) return {};
  if (core::is_readable_source(name)) return name;
  for (const std::string& folder : search) {
    const fs::path path = fs::path(folder) / "robots" / name / "robot.yaml";
    if (fs::is_regular_file(path, error)) return path.string();
  }
  return {};
}

}  // namespace footfall::model
