// Locations of values, and the edits that change them; see parts.h.
#include <algorithm>
#include <cstdint>

#include "behaviors/load/control/gains.h"
#include "behaviors/save/parts.h"
#include "core/same_bits.h"
#include "core/text/dotted_name.h"
#include "core/units/quantity_text.h"
#include "core/yaml/glob.h"
#include "core/yaml_text/write.h"

namespace footfall::behaviors {
namespace {

bool same_place(core::Mark a, core::Mark b) {
  return a.file == b.file && a.line == b.line && a.column == b.column;
}

void collect_paths(const core::YamlNode& tree, const core::YamlNode& node, KeyPath& path,
                   std::vector<KeyPath>& out) {
  if (tree.kind == node.kind && same_place(tree.mark, node.mark)) out.push_back(path);
  for (const core::YamlEntry& entry : tree.entries) {
    path.push_back(entry.key);
    collect_paths(entry.value, node, path, out);
    path.pop_back();
  }
  for (std::size_t k = 0; k < tree.items.size(); ++k) {
    path.push_back(std::to_string(k));
    collect_paths(tree.items[k], node, path, out);
    path.pop_back();
  }
}

const core::YamlNode* node_at(const core::YamlNode& root, const KeyPath& path) {
  const core::YamlNode* node = &root;
  for (const std::string& key : path) {
    node = node == nullptr ? nullptr : node->find(key);
  }
  return node;
}

ValueHome home_of_parameter(const SaveSource& source, const std::string& name) {
  ValueHome home;
  home.path = {"parameters", name};
  home.node = node_at(source.context.root, home.path);
  if (home.node != nullptr && home.node->is_map()) {
    home.path.emplace_back("value");
    home.node = home.node->find("value");
  }
  return home;
}

// Names of tables and gains have no dots.
ValueHome home_of_torque_loop(const SaveSource& source, const ParameterInfo& info) {
  ValueHome home;
  home.path = core::split_dots(info.name);
  home.node = node_at(source.context.root, home.path);
  home.axes = info.axes;
  return home;
}

// A parameter that the file does not name has its section as home, as a new key of a map has.
ValueHome home_of_estimator(const SaveSource& source, const ParameterInfo& info) {
  ValueHome home;
  home.path = core::split_dots(info.name);
  home.node = node_at(source.context.root, home.path);
  if (home.node != nullptr) return home;
  home.axes = {home.path.back()};
  home.path.pop_back();
  home.node = node_at(source.context.root, home.path);
  return home;
}

// The values of a map by name: the entry that applies to each, nullptr if none.
std::vector<const core::YamlEntry*> entries_of(const ValueHome& home) {
  core::Diagnostics ignored;  // the file was loaded without error before
  return core::match_names(*home.node, home.axes, "axis", ignored);
}

bool are_joints(const SaveSource& source, const std::vector<std::string>& names) {
  return !names.empty() && std::ranges::all_of(names, [&](const std::string& name) {
    return source.behavior.robot.find_joint(name) >= 0;
  });
}

std::string key_and_value(const std::string& key, const std::string& value) {
  core::YamlNode node;
  node.kind = core::YamlNode::Kind::scalar;
  node.scalar = key;
  return core::to_flow_yaml(node) + ": " + value;
}

// Replaces a number shared by all axes by one for each: a list; for joints a map whose `*` keeps
// it.
std::string spread_text(const SaveSource& source, const Wanted& wanted, const std::string& like) {
  const double old = source.behavior.values[static_cast<std::size_t>(
      source.behavior.parameters[static_cast<std::size_t>(wanted.parameter)].slot)];
  const bool joints = are_joints(source, wanted.home.axes);
  const bool some_stay =
      std::ranges::any_of(wanted.values, [&](double value) { return core::same_bits(value, old); });
  std::string out = joints && some_stay ? key_and_value("*", like) : "";
  for (std::size_t k = 0; k < wanted.values.size(); ++k) {
    if (joints && some_stay && core::same_bits(wanted.values[k], old)) continue;
    const std::string text = core::quantity_text(wanted.values[k], like);
    out += out.empty() ? "" : ", ";
    out += joints ? key_and_value(wanted.home.axes[k], text) : text;
  }
  return joints ? "{" + out + "}" : "[" + out + "]";
}

// An entry that applies to several joints keeps its number as long as one of them needs it; the
// others get their own entries, in the unit of the text `unit` where there is none to follow.
void edit_map(const Wanted& wanted, const double* old, const std::string& unit,
              std::vector<NodeEdit>& edits) {
  const core::YamlNode& node = *wanted.home.node;
  const auto entries = entries_of(wanted.home);
  const auto add = [&](std::size_t k, const std::string& like, core::Mark near) {
    edits.push_back(
        {&node, wanted.home.axes[k], near, core::quantity_text(wanted.values[k], like)});
  };
  for (std::size_t k = 0; k < entries.size(); ++k) {
    if (entries[k] == nullptr && !core::same_bits(wanted.values[k], old[k]))
      add(k, unit, node.mark);
  }
  for (const core::YamlEntry& entry : node.entries) {
    std::vector<std::size_t> served;
    for (std::size_t k = 0; k < entries.size(); ++k) {
      if (entries[k] == &entry) served.push_back(k);
    }
    if (served.empty()) continue;
    const auto stays = [&](std::size_t k) { return core::same_bits(wanted.values[k], old[k]); };
    const bool some_stay = std::ranges::any_of(served, stays);
    const double common = wanted.values[served.front()];
    if (!some_stay) {
      edits.push_back({&entry.value, "", {}, core::quantity_text(common, entry.value.scalar)});
    }
    for (const std::size_t k : served) {
      const bool covered = some_stay ? stays(k) : core::same_bits(wanted.values[k], common);
      if (!covered) add(k, entry.value.scalar, entry.key_mark);
    }
  }
}

}  // namespace

bool begins_with(const KeyPath& path, const KeyPath& head) {
  return path.size() >= head.size() && std::equal(head.begin(), head.end(), path.begin());
}

std::vector<KeyPath> paths_of(const core::YamlNode& root, const core::YamlNode& node) {
  std::vector<KeyPath> out;
  KeyPath path;
  collect_paths(root, node, path, out);
  return out;
}

ValueHome find_home(const SaveSource& source, const ParameterInfo& info) {
  if (!info.gain) return home_of_parameter(source, info.name);
  if (info.of_torque_loop()) return home_of_torque_loop(source, info);
  if (info.of_estimator()) return home_of_estimator(source, info);
  ValueHome home;
  const std::size_t dot = info.name.rfind('.');
  const auto found = source.context.gain_entries.find(info.name.substr(0, dot));
  if (found == source.context.gain_entries.end()) return home;
  const GainEntry& entry = found->second;
  home.node = entry.node->find(info.name.substr(dot + 1));
  home.axes = entry.axes;
  if (home.node == nullptr) return home;
  // Gains of a table are found by name, gains written in a task by position.
  const std::string& name = found->first;
  const std::size_t table = name.find('.') + 1, task = name.find('.', table) + 1;
  const KeyPath in_table = {"gains", name.substr(table, task - 1 - table), name.substr(task),
                            info.name.substr(dot + 1)};
  if (node_at(source.context.root, in_table) == home.node) {
    home.path = in_table;
  } else if (const auto paths = paths_of(source.context.root, *home.node); paths.size() == 1) {
    home.path = paths.front();
  }
  return home;
}

std::vector<NodeEdit> edits_in_place(const SaveSource& source, const Wanted& wanted) {
  const ParameterInfo& info =
      source.behavior.parameters[static_cast<std::size_t>(wanted.parameter)];
  const double* const old = source.behavior.values.data() + info.slot;
  const core::YamlNode& node = *wanted.home.node;
  std::vector<NodeEdit> edits;
  if (node.is_map()) {
    // A gain's unit depends on its table's type: such a number stays bare.
    edit_map(wanted, old, info.of_estimator() ? "1 " + core::unit_text(info.dimension) : "", edits);
  } else if (node.is_sequence()) {
    for (std::size_t k = 0; k < wanted.values.size() && k < node.items.size(); ++k) {
      const core::YamlNode& item = node.items[k];
      if (!core::same_bits(wanted.values[k], old[k])) {
        edits.push_back({&item, "", {}, core::quantity_text(wanted.values[k], item.scalar)});
      }
    }
  } else {
    const bool one = std::ranges::all_of(
        wanted.values, [&](double value) { return core::same_bits(value, wanted.values.front()); });
    edits.push_back({&node,
                     "",
                     {},
                     one ? core::quantity_text(wanted.values.front(), node.scalar)
                         : spread_text(source, wanted, node.scalar)});
  }
  return edits;
}

std::string whole_text(const SaveSource& source, const Wanted& wanted) {
  const core::YamlNode& node = *wanted.home.node;
  if (!node.is_sequence()) return edits_in_place(source, wanted).front().text;
  const ParameterInfo& info =
      source.behavior.parameters[static_cast<std::size_t>(wanted.parameter)];
  std::string out;
  for (std::size_t k = 0; k < node.items.size(); ++k) {
    const double old = source.behavior.values[static_cast<std::size_t>(info.slot) + k];
    const std::string& written = node.items[k].scalar;
    out += out.empty() ? "" : ", ";
    out += core::same_bits(wanted.values[k], old) ? written
                                                  : core::quantity_text(wanted.values[k], written);
  }
  return "[" + out + "]";
}

}  // namespace footfall::behaviors
