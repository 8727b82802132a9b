// `estimator:` as a type and slots of the flat value array, one a parameter.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "behaviors/language/estimators.h"
#include "behaviors/language/language.h"
#include "behaviors/load/context.h"
#include "behaviors/load/steps.h"
#include "model/sensor_mounts.h"

namespace footfall::behaviors {
namespace {

constexpr std::size_t kFewestMarkers = 3;  // fewer do not tell an attitude

class EstimatorLoader {
 public:
  EstimatorLoader(LoadContext& context, const core::YamlNode& section)
      : context_(context), section_(section), spec_(context.behavior.estimator) {}

  void load() {
    core::check_keys(section_, kEstimatorKeys, context_.diagnostics);
    spec_.mark = section_.mark;
    const core::YamlNode* const type = section_.find("type");
    if (type != nullptr) {
      const auto choice = core::read_choice(*type, kEstimatorTypes, context_.diagnostics);
      if (!choice) return;
      spec_.type = static_cast<EstimatorType>(*choice);
      spec_.mark = type->mark;
    }
    if (const core::YamlNode* const contact = section_.find("contact")) {
      const auto choice = core::read_choice(*contact, kContactSources, context_.diagnostics);
      if (choice) spec_.contact = static_cast<ContactSource>(*choice);
    }
    refuse_keys_of_other_types();
    check_sensors();
    spec_.first_slot = static_cast<int>(context_.behavior.values.size());
    for (const EstimatorParameter& parameter : info().parameters) make_slot(parameter);
    spec_.slots = static_cast<int>(info().parameters.size());
  }

 private:
  const EstimatorInfo& info() const { return estimator_info(spec_.type); }

  void refuse_keys_of_other_types() {
    for (const core::YamlEntry& entry : section_.entries) {
      const core::KeySpec* const key = core::find_key(kEstimatorKeys, entry.key);
      if (key == nullptr || core::belongs_to(*key, info().name)) continue;
      std::vector<std::string> own = core::key_names(kEstimatorKeys, info().name);
      std::erase(own, "type");
      const std::string takes =
          own.empty() ? "no parameters" : fmt::format("{}", fmt::join(own, ", "));
      const bool of_another_file =
          spec_.mark.file >= 0 && entry.key_mark.file != spec_.mark.file;  // a base's
      context_.error(
          entry.key_mark, "misplaced-key",
          fmt::format("'{}' is no parameter of the estimator {}, which takes {}{}", entry.key,
                      info().name, takes,
                      of_another_file
                          ? fmt::format("; `{}: off` removes what a base gives", entry.key)
                          : ""));
    }
  }

  void lacks(core::Mark mark, const std::string& what) {
    context_.error(mark, "missing-sensor",
                   fmt::format("the estimator {} needs {}", info().name, what));
  }

  void check_sensors() {
    const model::RobotDescription& robot = context_.behavior.robot;
    if (info().needs_imu && robot.sensors.imu_site.empty()) {
      lacks(spec_.mark,
            fmt::format("an IMU: robot '{}' has no `sensors: {{imu: {{site: ...}}}}`", robot.name));
    }
    if (info().needs_mocap && robot.sensors.mocap_sites.empty()) {
      lacks(spec_.mark,
            fmt::format("motion capture: robot '{}' has no `sensors: {{mocap: ...}}`", robot.name));
    } else if (info().needs_imu || info().needs_mocap) {
      check_mounts();
    }
    if (info().needs_contacts) check_contacts();
  }

  // What only the model file tells: how many sites the patterns mean, and of which body they are.
  void check_mounts() {
    const model::RobotDescription& robot = context_.behavior.robot;
    try {
      const std::size_t markers = model::sensor_mounts(robot).markers.size();
      if (!info().needs_mocap || markers >= kFewestMarkers) return;
      lacks(spec_.mark, fmt::format("{} motion-capture markers or more: `sensors: {{mocap: ...}}` "
                                    "of robot '{}' means {}",
                                    kFewestMarkers, robot.name, markers));
    } catch (const std::runtime_error& problem) {
      lacks(spec_.mark, fmt::format("its sensors' places: {}", problem.what()));
    }
  }

  // What tells the contacts, for every contact of the robot.
  void check_contacts() {
    const model::RobotDescription& robot = context_.behavior.robot;
    const core::YamlNode* const written = section_.find("contact");
    const core::Mark mark = written == nullptr ? spec_.mark : written->mark;
    if (robot.contacts.empty()) return lacks(mark, "contacts: robot '" + robot.name + "' has none");
    for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
      const model::ContactDescription& contact = robot.contacts[c];
      const bool has_switch = std::ranges::find(robot.sensors.switches, static_cast<int>(c)) !=
                              robot.sensors.switches.end();
      if (spec_.contact != ContactSource::torque && !has_switch) {
        return lacks(mark,
                     fmt::format("a switch at contact '{}', or `contact: torque`: "
                                 "`sensors: {{switches: ...}}` of robot '{}' does not name it",
                                 contact.name, robot.name));
      }
      if (spec_.contact != ContactSource::switches && contact.group.empty()) {
        return lacks(
            mark,
            fmt::format("the leg of contact '{}' for `contact: {}`: robot '{}' gives "
                        "it no `group`",
                        contact.name, kContactSources[static_cast<std::size_t>(spec_.contact)].word,
                        robot.name));
      }
    }
  }

  void make_slot(const EstimatorParameter& parameter) {
    Behavior& behavior = context_.behavior;
    const core::YamlNode* const node = section_.find(parameter.name);
    ParameterInfo slot;
    slot.name = fmt::format("estimator.{}", parameter.name);
    slot.dimension = parameter.dimension;
    slot.slot = static_cast<int>(behavior.values.size());
    slot.min = parameter.least;
    slot.max = parameter.most;
    slot.at_start = parameter.at_start;
    slot.live = !parameter.at_start;
    slot.gain = true;
    slot.doc = parameter.doc;
    slot.mark = node == nullptr ? spec_.mark : node->mark;
    double value = parameter.value;
    if (node != nullptr) {
      value = core::read_bounded(*node, parameter.dimension, parameter.least, parameter.most,
                                 context_.diagnostics)
                  .value_or(value);
    }
    behavior.parameters.push_back(std::move(slot));
    behavior.values.push_back(value);
  }

  LoadContext& context_;
  const core::YamlNode& section_;
  EstimatorSpec& spec_;
};

}  // namespace

void load_estimator(LoadContext& context) {
  const core::YamlNode* const section = context.section("estimator");
  if (section == nullptr ||
      !core::expect_map(*section, "a map with the estimator's `type`", context.diagnostics)) {
    return;
  }
  if (!context.behavior.has_robot) {
    context.error(section->mark, "needs-robot",
                  "an estimator needs a robot: this behavior names none");
    return;
  }
  EstimatorLoader(context, *section).load();
}

}  // namespace footfall::behaviors
