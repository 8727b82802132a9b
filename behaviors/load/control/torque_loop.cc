// `torque_loop:` tables: gains of the actuators' own torque loops, as slots of the value array, one
// value a joint.
#include "model/robot/torque_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "behaviors/language/language.h"
#include "behaviors/load/context.h"
#include "behaviors/load/control/steps.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/yaml/glob.h"

namespace footfall::behaviors {
namespace {

using LoopType = hal::TorqueLoopGains::Type;
using core::YamlNode;
using model::kTorqueLoopGainKeys;
using model::TorqueLoopKey;

// One gain of a table while it is read, a value a joint.
struct JointGain {
  const TorqueLoopKey& key;
  LoopType type;
  std::optional<std::array<double, 2>> range;
  std::vector<double> values{};
  std::vector<core::Mark> marks{};
};

class TorqueLoopLoader {
 public:
  explicit TorqueLoopLoader(LoadContext& context)
      : context_(context), joints_(context.joint_names()) {}

  void load(const YamlNode& section) {
    ranges_ = section.find("ranges");
    if (ranges_ != nullptr) {
      if (core::expect_map(*ranges_, "ranges of p, i, d", context_.diagnostics)) {
        core::check_keys(*ranges_, kTorqueLoopRangesKeys, context_.diagnostics);
      } else {
        ranges_ = nullptr;
      }
    }
    for (const core::YamlEntry& entry : section.entries) {
      if (entry.key != "ranges") load_table(entry);
    }
    for (const TorqueLoopKey& key : kTorqueLoopGainKeys) {  // those that no table needed
      if (known_[index_of(key)][0].read || known_[index_of(key)][1].read) continue;
      range_of(key, key.of_cascade ? LoopType::cascade : LoopType::direct);
      if (const YamlNode* range = ranges_ == nullptr ? nullptr : ranges_->find(key.name)) {
        context_.absence(range->mark, "unused",
                         fmt::format("the range of '{0}' has no effect: no torque_loop table has "
                                     "'{0}'",
                                     key.name));
      }
    }
  }

 private:
  struct Range {
    bool read = false;
    std::optional<std::array<double, 2>> value;
  };

  static std::size_t index_of(const TorqueLoopKey& key) {
    return static_cast<std::size_t>(&key - kTorqueLoopGainKeys.data());
  }

  // Bounds of a gain, read in the unit of the type that needs them.
  std::optional<std::array<double, 2>> range_of(const TorqueLoopKey& key, LoopType type) {
    const bool one_unit = key.cascade == key.direct;
    Range& known = known_[index_of(key)][one_unit ? 0 : static_cast<std::size_t>(type)];
    const YamlNode* const node = ranges_ == nullptr ? nullptr : ranges_->find(key.name);
    if (known.read || node == nullptr) return known.value;
    known.read = true;
    known.value =
        core::read_range(*node, key.dimension(type), context_.diagnostics, key.noun(type));
    if (!known.value) return std::nullopt;
    const auto [least, most] = *known.value;
    if (least < 0.0) {
      context_.error(node->items[0].mark, "out-of-range",
                     fmt::format("expected 0 or more, got {}: a gain cannot be negative",
                                 core::describe(node->items[0])));
    } else if (least == most) {
      context_.error(node->mark, "range", "a range must not be empty");
    } else {
      return known.value;
    }
    return known.value = std::nullopt;
  }

  void load_table(const core::YamlEntry& entry) {
    const YamlNode& map = entry.value;
    if (!core::check_name(entry, context_.diagnostics, "the name of a torque loop")) return;
    if (!core::expect_map(map, "a map with p, i, d", context_.diagnostics)) return;
    core::check_keys(map, model::kTorqueLoopKeys, context_.diagnostics);
    if (map.entries.empty()) {
      context_.error(map.mark, "missing-key",
                     "expected at least one of p, i, d, or another key of a torque_loop");
    }
    TorqueLoopTable table;
    table.name = entry.key;
    table.mark = entry.key_mark;
    if (const YamlNode* type = map.find("type")) {
      const auto choice = core::read_choice(*type, model::kTorqueLoopTypes, context_.diagnostics);
      if (!choice) return;
      table.type = static_cast<LoopType>(*choice);
    }
    check_type(map, table.type);
    take_from_robot(map, table);
    for (const TorqueLoopKey& key : kTorqueLoopGainKeys) {
      const YamlNode* const node = map.find(key.name);
      if (node != nullptr && key.belongs_to(table.type)) make_slots(key, *node, table);
    }
    context_.behavior.torque_loops.push_back(std::move(table));
  }

  // Reports keys of the other type.
  void check_type(const YamlNode& map, LoopType type) {
    const bool cascade = type == LoopType::cascade;
    std::string own;
    for (const TorqueLoopKey& key : kTorqueLoopGainKeys) {
      if (key.belongs_to(type)) own += fmt::format("{}{}", own.empty() ? "" : ", ", key.name);
    }
    if (!cascade) own += ", damps";
    for (const core::YamlEntry& entry : map.entries) {
      const auto* const key =
          std::ranges::find(kTorqueLoopGainKeys, entry.key, &TorqueLoopKey::name);
      const bool foreign = key == kTorqueLoopGainKeys.end() ? cascade && entry.key == "damps"
                                                            : !key->belongs_to(type);
      if (!foreign) continue;
      context_.error(
          entry.key_mark, "misplaced-key",
          fmt::format("'{}' is of type {}; {} takes {}", entry.key, cascade ? "direct" : "cascade",
                      cascade ? "a cascade" : "a direct one", own));
    }
  }

  // What the table does not name. The robot's p and i mean another thing with another type.
  void take_from_robot(const YamlNode& map, TorqueLoopTable& table) {
    const auto& own = context_.behavior.robot.drives.torque_loop;
    table.unnamed.resize(joints_.size());
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      hal::TorqueLoopGains& gains = table.unnamed[j];
      if (!own.empty()) gains = own[j];
      if (gains.type != table.type) gains.p = gains.i = 0.0;
      gains.type = table.type;
    }
    const YamlNode* const damps = map.find("damps");
    if (damps == nullptr) return;
    const auto choice = core::read_choice(*damps, model::kTorqueLoopDampings, context_.diagnostics);
    for (hal::TorqueLoopGains& gains : table.unnamed) {
      gains.damps = static_cast<hal::TorqueLoopGains::Damping>(choice.value_or(0));
    }
  }

  void make_slots(const TorqueLoopKey& key, const YamlNode& node, TorqueLoopTable& table) {
    Behavior& behavior = context_.behavior;
    JointGain gain = {key, table.type, range_of(key, table.type)};
    for (const hal::TorqueLoopGains& unnamed : table.unnamed) {
      gain.values.push_back(unnamed.*key.member);
    }
    gain.marks.assign(joints_.size(), node.mark);
    read_joints(node, gain);
    ParameterInfo info;
    info.name = fmt::format("torque_loop.{}.{}", table.name, key.name);
    info.dimension = key.dimension(table.type);
    info.slot = static_cast<int>(behavior.values.size());
    info.size = static_cast<int>(joints_.size());
    info.gain = true;
    info.axes = joints_;
    info.mark = node.mark;
    if (gain.range) {
      info.min = (*gain.range)[0];
      info.max = (*gain.range)[1];
      info.live = true;
    }
    apply_settings(info, gain);
    table.slots[index_of(key)] = info.slot;
    table.marks[index_of(key)] = std::move(gain.marks);
    behavior.parameters.push_back(std::move(info));
    behavior.values.insert(behavior.values.end(), gain.values.begin(), gain.values.end());
  }

  // One value; false after an error.
  bool read_value(const YamlNode& node, JointGain& gain, std::size_t joint) {
    const auto value = core::read_bounded(node, gain.key.dimension(gain.type), 0.0, kUnlimited,
                                          context_.diagnostics, gain.key.noun(gain.type));
    if (!value) return false;
    gain.values[joint] = *value;
    gain.marks[joint] = node.mark;
    return is_in_range(gain, joint, core::describe(node));
  }

  bool is_in_range(const JointGain& gain, std::size_t joint, const std::string& written) {
    if (!gain.range) return true;
    const auto [least, most] = *gain.range;
    const double value = gain.values[joint];
    if (value >= least && value <= most) return true;
    context_.error(gain.marks[joint], "out-of-range",
                   fmt::format("{} is outside torque_loop.ranges, {} to {}", written, least, most));
    return false;
  }

  // A number for all joints, or a map by joint; a joint that it does not name keeps its value.
  void read_joints(const YamlNode& node, JointGain& gain) {
    if (!node.is_map()) {
      for (std::size_t j = 0; j < joints_.size() && read_value(node, gain, j); ++j) {
      }
      return;
    }
    const int before = context_.diagnostics.error_count();
    const auto entries = core::match_names(node, joints_, "joint", context_.diagnostics);
    if (context_.diagnostics.error_count() != before) return;
    const core::YamlEntry* refused = nullptr;  // a pattern's value is refused once
    bool good = true;                          // and so are the joints not named
    for (std::size_t j = 0; j < entries.size(); ++j) {
      const core::YamlEntry* const entry = entries[j];
      if (entry == nullptr) {
        good = good && is_in_range(gain, j,
                                   fmt::format("joint '{}', not named here, has {:g}, which",
                                               joints_[j], gain.values[j]));
      } else if (entry != refused && !read_value(entry->value, gain, j)) {
        refused = entry;
      }
    }
  }

  // Values of --set by joint.
  void apply_settings(const ParameterInfo& info, JointGain& gain) {
    for (const GainSetting& setting : context_.gain_settings) {
      if (setting.gain != info.name) continue;
      std::size_t joint = 0;
      const char* const end = setting.axis.data() + setting.axis.size();
      const auto [stop, problem] = std::from_chars(setting.axis.data(), end, joint);
      if (problem != std::errc() || stop != end) {
        joint =
            static_cast<std::size_t>(std::ranges::find(joints_, setting.axis) - joints_.begin());
      }
      if (joint < joints_.size()) {
        read_value(setting.value, gain, joint);
        continue;
      }
      context_.error(setting.value.mark, "unknown-setting",
                     fmt::format("--set {}: there is no joint '{}'{}", setting.name, setting.axis,
                                 core::did_you_mean_or_list(setting.axis, joints_)));
    }
  }

  LoadContext& context_;
  std::vector<std::string> joints_;
  const YamlNode* ranges_ = nullptr;
  std::array<std::array<Range, 2>, kTorqueLoopGainKeys.size()> known_{};  // by gain and type
};

}  // namespace

void load_torque_loops(LoadContext& context) {
  const YamlNode* section = context.section("torque_loop");
  if (section == nullptr || !core::expect_map(*section, "tables by name", context.diagnostics)) {
    return;
  }
  if (!context.behavior.has_robot) {
    context.error(section->mark, "needs-robot",
                  "torque_loop needs a robot: this behavior names none");
    return;
  }
  TorqueLoopLoader(context).load(*section);
}

}  // namespace footfall::behaviors
