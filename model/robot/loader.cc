// Reads a `robot: 1` file into a RobotDescription and checks it; see description.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <utility>

#include "core/capacities.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/yaml/glob.h"
#include "core/yaml/layers.h"
#include "core/yaml/value_reader.h"
#include "model/robot/description.h"
#include "model/robot/drives.h"
#include "model/robot/fault_rules.h"
#include "model/robot/keys.h"
#include "model/source/mjcf_source.h"

namespace footfall::model {

namespace {

using core::Diagnostics;
using core::YamlEntry;
using core::YamlNode;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTiny = 1e-9;  // least value of what must be above zero, in SI

// One function a section of the file; each reports its own problems and the next one goes on.
class RobotLoader {
 public:
  RobotLoader(const std::string& path, Diagnostics& diagnostics) : diagnostics_(diagnostics) {
    robot_.path = path;
    set_default_reactions();
  }

  RobotDescription load(const YamlNode& root) {
    if (!core::check_kind(root, "robot", 1, diagnostics_)) return std::move(robot_);
    core::check_keys(root, kRobotKeys, diagnostics_);
    read_head(root);
    if (const YamlNode* node = core::require_key(root, "joints", diagnostics_)) read_joints(*node);
    if (const YamlNode* node = root.find("drives")) read_drives(*node, robot_, diagnostics_);
    if (const YamlNode* node = root.find("posture")) read_posture(*node);
    if (const YamlNode* node = root.find("groups")) read_groups(*node);
    if (const YamlNode* node = root.find("contacts")) read_contacts(*node);
    if (const YamlNode* node = root.find("points")) read_points(*node);
    if (const YamlNode* node = root.find("sensors")) read_sensors(*node);
    if (const YamlNode* node = root.find("symmetry")) read_symmetry(*node);
    if (const YamlNode* node = root.find("limits")) read_limits(*node);
    if (const YamlNode* node = root.find("faults")) read_reactions(*node, robot_, diagnostics_);
    return std::move(robot_);
  }

 private:
  void set_default_reactions() {
    for (const FaultRule& rule : fault_rules()) {
      robot_.reactions[static_cast<std::size_t>(rule.fault)] = rule.otherwise;
    }
  }

  void read_head(const YamlNode& root) {
    namespace fs = std::filesystem;
    robot_.name = fs::absolute(robot_.path).parent_path().filename().string();
    if (const YamlNode* node = root.find("name")) {
      if (const auto name = core::read_name(*node, diagnostics_, "the robot's name")) {
        robot_.name = *name;
      }
    }
    if (const YamlNode* node = core::require_key(root, "model", diagnostics_)) read_model(*node);
    if (const YamlNode* node = core::require_key(root, "floating_base", diagnostics_)) {
      robot_.floating_base =
          core::read_text(*node, diagnostics_, "the name of a body").value_or("");
    }
    if (const YamlNode* node = root.find("rate")) {
      robot_.rate_mhz = core::read_millihertz(*node, diagnostics_).value_or(robot_.rate_mhz);
    }
    read_positive(root, "standing_height", core::kLength, robot_.standing_height);
  }

  void read_model(const YamlNode& node) {
    namespace fs = std::filesystem;
    const auto model = core::read_text(node, diagnostics_, "the path of an MJCF file");
    if (!model) return;
    // Beside the file that says so, which may be the base of this one.
    const fs::path folder = fs::path(diagnostics_.file(node.mark.file)).parent_path();
    const fs::path path = fs::absolute(folder / *model).lexically_normal();
    std::error_code error;
    if (!fs::is_regular_file(path, error)) {
      diagnostics_.error(node.mark, "model", fmt::format("no model file '{}'", path.string()));
      return;
    }
    robot_.model_path = path.string();
    const MjcfSource source(robot_.model_path);
    if (source.roots().empty() || source.roots().front()->tag != "robot") return;
    diagnostics_.error(node.mark, "model",
                       fmt::format("'{}' is a URDF file, which this version does not read; "
                                   "expected MJCF with a free joint, motors and sites",
                                   *model));
  }

  void read_positive(const YamlNode& map, std::string_view key, core::Dimension dimension,
                     double& out) {
    model::read_positive(map, key, dimension, out, diagnostics_);
  }

  void read_joints(const YamlNode& node) {
    if (!core::expect_map(node, "a map of joints by name", diagnostics_)) return;
    if (node.entries.empty() || node.entries.size() > core::kMaxJoints) {
      diagnostics_.error(
          node.mark, "size",
          fmt::format("expected 1 to {} joints, got {}", core::kMaxJoints, node.entries.size()));
      return;
    }
    for (const YamlEntry& entry : node.entries) {
      JointDescription joint;
      joint.name = entry.key;
      joint.mark = entry.key_mark;
      core::check_name(entry, diagnostics_, "a joint's name");
      if (core::expect_map(entry.value, "a joint: {position: [MIN, MAX], torque: MAX}",
                           diagnostics_)) {
        read_joint(entry.value, joint);
      }
      // Also after an error: other sections may name it.
      joint_names_.push_back(joint.name);
      robot_.joints.push_back(std::move(joint));
    }
  }

  void read_joint(const YamlNode& node, JointDescription& joint) {
    core::check_keys(node, kJointKeys, diagnostics_);
    if (const YamlNode* position = core::require_key(node, "position", diagnostics_)) {
      const auto range = core::read_range(*position, core::kNone, diagnostics_, "an angle");
      // Without limits the posture is not judged by them.
      joint.position_min = range ? (*range)[0] : -kInfinity;
      joint.position_max = range ? (*range)[1] : kInfinity;
    }
    if (core::require_key(node, "torque", diagnostics_) != nullptr) {
      read_positive(node, "torque", core::kTorque, joint.torque_limit);
    }
    if (const YamlNode* const sea = node.find("sea")) read_actuator(*sea, joint, diagnostics_);
  }

  void read_posture(const YamlNode& node) {
    const auto entries = core::match_names(node, joint_names_, "joint", diagnostics_);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (entries[i] == nullptr) continue;
      const YamlNode& value = entries[i]->value;
      const auto angle = core::read_quantity(value, core::kNone, diagnostics_, "an angle");
      if (!angle) continue;
      JointDescription& joint = robot_.joints[i];
      joint.posture = *angle;
      if (*angle < joint.position_min || *angle > joint.position_max) {
        constexpr double kDegree = std::numbers::pi / 180.0;
        diagnostics_.error(value.mark, "out-of-range",
                           fmt::format("{} is outside the limits of '{}' ({:.4g} to {:.4g} deg)",
                                       core::describe(value), joint.name,
                                       joint.position_min / kDegree, joint.position_max / kDegree));
      }
    }
  }

  void read_groups(const YamlNode& node) {
    if (!core::expect_map(node, "a map of joint lists by name", diagnostics_)) return;
    for (const YamlEntry& entry : node.entries) {
      core::check_name(entry, diagnostics_, "a group's name");
      if (entry.value.is_sequence() && entry.value.items.empty()) {
        diagnostics_.error(entry.value.mark, "empty-value", "a group needs at least one joint");
      }
      robot_.groups.push_back(
          {entry.key, core::expand_names(entry.value, joint_names_, "joint", diagnostics_)});
    }
  }

  void read_contacts(const YamlNode& node) {
    if (!core::expect_map(node, "a map of contacts by name", diagnostics_)) return;
    if (node.entries.size() > core::kMaxContacts) {
      diagnostics_.error(node.mark, "size",
                         fmt::format("expected at most {} contacts, got {}", core::kMaxContacts,
                                     node.entries.size()));
      return;
    }
    for (const YamlEntry& entry : node.entries) {
      ContactDescription contact;
      contact.name = entry.key;
      core::check_name(entry, diagnostics_, "a contact's name");
      if (core::expect_map(entry.value, "a contact: {site: NAME, type: point}", diagnostics_)) {
        read_contact(entry.value, contact);
      }
      contact_names_.push_back(contact.name);
      robot_.contacts.push_back(std::move(contact));
    }
  }

  void read_contact(const YamlNode& node, ContactDescription& contact) {
    core::check_keys(node, kContactKeys, diagnostics_);
    contact.site = read_site(node);
    if (const YamlNode* type = node.find("type")) {
      const auto choice =
          core::read_choice(*type, kContactTypes, diagnostics_, "a type of contact");
      if (choice) contact.type = static_cast<ContactType>(*choice);
      contact.type_mark = type->mark;
    }
    if (const YamlNode* radius = node.find("radius")) {
      contact.radius =
          core::read_bounded(*radius, core::kLength, 0.0, kInfinity, diagnostics_).value_or(0.0);
    }
    read_positive(node, "friction", core::kNone, contact.friction);
    const YamlNode* const group = node.find("group");
    if (group == nullptr) return;
    contact.group = core::read_text(*group, diagnostics_, "a group's name").value_or("");
    if (!contact.group.empty() && robot_.find_group(contact.group) < 0) {
      report_unknown(*group, "group", names_of(robot_.groups));
    }
  }

  std::string read_site(const YamlNode& node) {
    const YamlNode* const site = core::require_key(node, "site", diagnostics_);
    if (site == nullptr) return {};
    return core::read_text(*site, diagnostics_, "a site's name").value_or("");
  }

  void read_points(const YamlNode& node) {
    if (!core::expect_map(node, "a map of points by name", diagnostics_)) return;
    for (const YamlEntry& entry : node.entries) {
      core::check_name(entry, diagnostics_, "a point's name");
      if (robot_.find_contact(entry.key) >= 0) {
        diagnostics_.error(
            entry.key_mark, "duplicate",
            fmt::format("'{}' is a contact already, and a contact is a point", entry.key));
      }
      PointDescription point{entry.key, {}, {}};
      if (core::expect_map(entry.value, "a point: {site: NAME} or {body: NAME}", diagnostics_)) {
        read_point(entry.value, point);
      }
      robot_.points.push_back(std::move(point));
    }
  }

  void read_point(const YamlNode& node, PointDescription& point) {
    core::check_keys(node, kPointKeys, diagnostics_);
    const YamlNode* const body = node.find("body");
    if (body == nullptr) {
      point.site = read_site(node);
      return;
    }
    point.body = core::read_text(*body, diagnostics_, "a body's name").value_or("");
    if (const YamlNode* const site = node.find("site")) {
      diagnostics_.error(site->mark, "misplaced-key",
                         "a point is at a site or at a body, not both");
    }
  }

  void read_sensors(const YamlNode& node) {
    if (!core::expect_map(node, "a map of sensors", diagnostics_)) return;
    core::check_keys(node, kSensorsKeys, diagnostics_);
    if (const YamlNode* imu = node.find("imu")) {
      if (core::expect_map(*imu, "{site: NAME}", diagnostics_)) {
        core::check_keys(*imu, kImuKeys, diagnostics_);
        robot_.sensors.imu_site = read_site(*imu);
      }
    }
    if (const YamlNode* mocap = node.find("mocap")) {
      if (core::expect_map(*mocap, "{sites: [NAMES]}", diagnostics_)) {
        core::check_keys(*mocap, kMocapKeys, diagnostics_);
        if (const YamlNode* sites = core::require_key(*mocap, "sites", diagnostics_)) {
          robot_.sensors.mocap_sites = core::read_texts(*sites, diagnostics_, "a site's name")
                                           .value_or(std::vector<std::string>());
        }
      }
    }
    if (const YamlNode* switches = node.find("switches")) {
      robot_.sensors.switches =
          core::expand_names(*switches, contact_names_, "contact", diagnostics_);
    }
  }

  void read_symmetry(const YamlNode& node) {
    if (!core::expect_map(node, "{swap: [[A, B], ...]}", diagnostics_)) return;
    core::check_keys(node, kSymmetryKeys, diagnostics_);
    const YamlNode* const swap = core::require_key(node, "swap", diagnostics_);
    if (swap == nullptr || !core::expect_sequence(*swap, "a list of pairs [A, B]", diagnostics_)) {
      return;
    }
    std::vector<std::string> known = contact_names_;
    for (const std::string& name : names_of(robot_.groups)) known.push_back(name);
    for (const std::string& name : names_of(robot_.points)) known.push_back(name);
    for (const std::string& name : joint_names_) known.push_back(name);
    std::vector<std::string> used;
    for (const YamlNode& pair : swap->items) {
      if (!pair.is_sequence() || pair.items.size() != 2) {
        core::report_expected(pair, "a pair [A, B]", diagnostics_);
        continue;
      }
      std::array<std::string, 2> names;
      for (std::size_t i = 0; i < 2; ++i) names[i] = read_swapped(pair.items[i], known, used);
      robot_.symmetry.push_back(names);
    }
  }

  // One name of a pair; it must exist and may change places only once.
  std::string read_swapped(const YamlNode& node, const std::vector<std::string>& known,
                           std::vector<std::string>& used) {
    const auto name = core::read_text(node, diagnostics_, "a contact, group, point or joint");
    if (!name) return {};
    if (std::find(known.begin(), known.end(), *name) == known.end()) {
      report_unknown(node, "contact, group, point or joint", known);
    } else if (std::find(used.begin(), used.end(), *name) != used.end()) {
      diagnostics_.error(node.mark, "duplicate", fmt::format("'{}' changes places twice", *name));
    }
    used.push_back(*name);
    return *name;
  }

  void read_limits(const YamlNode& node) {
    if (!core::expect_map(node, "a map of limits", diagnostics_)) return;
    core::check_keys(node, kLimitsKeys, diagnostics_);
    const auto read = [&](std::string_view key, core::Dimension dimension, double maximum,
                          std::string_view what, double& out) {
      const YamlNode* const value = node.find(key);
      if (value == nullptr) return;
      out = core::read_bounded(*value, dimension, 0.0, maximum, diagnostics_, what).value_or(out);
    };
    read("tilt", core::kNone, std::numbers::pi, "an angle", robot_.tilt_limit);
    read("height", core::kNone, 1.0, "a part of the standing height", robot_.height_limit);
    read("torque_step", core::kTorque, kInfinity, {}, robot_.torque_step_limit);
    read("imu_age", core::kTime, 60.0, "a time of at most 60 s", robot_.imu_age);
    read("mocap_age", core::kTime, 60.0, "a time of at most 60 s", robot_.mocap_age);
    read("edit_ramp", core::kTime, 10.0, "a time of at most 10 s", robot_.edit_ramp);
    if (const YamlNode* const overruns = node.find("overruns")) {
      const auto count = core::read_integer(*overruns, 1, 1'000'000, diagnostics_);
      robot_.overruns = static_cast<int>(count.value_or(robot_.overruns));
    }
    if (const YamlNode* const swing = node.find("swing")) {
      robot_.swing_limit = core::read_bounded(*swing, core::kTime, kTiny, 60.0, diagnostics_,
                                              "a time above zero and at most 60 s")
                               .value_or(robot_.swing_limit);
    }
    if (const YamlNode* const slip = node.find("slip")) {
      robot_.slip_limit = core::read_bounded(*slip, core::kLength, kTiny, kInfinity, diagnostics_,
                                             "a length above zero")
                              .value_or(robot_.slip_limit);
    }
    if (const YamlNode* const condition = node.find("condition")) {
      robot_.condition_limit = core::read_bounded(*condition, core::kNone, 1.0, kInfinity,
                                                  diagnostics_, "a ratio of at least 1")
                                   .value_or(robot_.condition_limit);
    }
    read("reload_watch", core::kTime, 60.0, "a time of at most 60 s", robot_.reload_watch);
  }

  void report_unknown(const YamlNode& node, std::string_view what,
                      const std::vector<std::string>& known) {
    diagnostics_.error(node.mark, "unknown-name",
                       fmt::format("no {} {}{}", what, core::describe(node),
                                   core::did_you_mean(node.scalar, known)));
  }

  template <typename Named>
  static std::vector<std::string> names_of(const std::vector<Named>& list) {
    std::vector<std::string> names;
    for (const Named& item : list) names.push_back(item.name);
    return names;
  }

  Diagnostics& diagnostics_;
  RobotDescription robot_;
  std::vector<std::string> joint_names_;
  std::vector<std::string> contact_names_;
};

}  // namespace

RobotDescription load_robot(const std::string& path, Diagnostics& diagnostics) {
  return core::load_over_base(path, false, diagnostics,
                              [&](const YamlNode& root, Diagnostics& problems) {
                                return RobotLoader(path, problems).load(root);
                              });
}

}  // namespace footfall::model
