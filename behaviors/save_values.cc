// Values back into the files that they came from; see save_values.h.
#include "behaviors/save_values.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>

#include "behaviors/load_gains.h"
#include "behaviors/save_parts.h"
#include "core/quantity_text.h"
#include "core/yaml_edit.h"
#include "core/yaml_write.h"

namespace footfall::behaviors {
namespace {

namespace fs = std::filesystem;

std::string identity(const std::string& path) {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? path : real.string();
}

std::optional<std::string> read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

// A plan while it is being made.
struct Planner {
  const SaveSource& source;
  const core::Diagnostics& files;  // names of the source's files
  SavePlan& plan;
  std::string overlay{};  // identity of the only file that may change, if there is one
  std::vector<Wanted> wanted{};
  std::vector<KeyPath> allowed{};  // what may differ in the tree
  struct File {
    core::FileChange change;
    std::vector<core::TextEdit> edits;  // of scalars
    std::vector<std::string> owners;    // of the edits: parameters
    struct Addition {
      KeyPath path;
      std::string text, name;
    };
    std::vector<Addition> additions;
  };
  std::map<std::string, File> changes{};  // by identity

  const std::string& path_of(core::Mark mark) const { return files.file(mark.file); }
  const ParameterInfo& info(const Wanted& value) const {
    return source.behavior.parameters[static_cast<std::size_t>(value.parameter)];
  }
  bool may_change(core::Mark mark) const {
    return overlay.empty() || (mark.file >= 0 && identity(path_of(mark)) == overlay);
  }
  void refuse(core::Mark mark, const std::string& name, const std::string& reason) {
    const std::string place =
        mark.file < 0 ? ""
                      : fmt::format("{}:{}:{}: ", path_of(mark), mark.line, mark.column);
    plan.refusals.push_back(fmt::format("{}{}: {}", place, name, reason));
  }
};

// Why there is no parameter of this name.
std::string unknown_reason(const SaveSource& source, const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot != std::string::npos) {
    const auto entry = source.context.gain_entries.find(name.substr(0, dot));
    const auto gain = std::ranges::find(kGainNames, name.substr(dot + 1));
    if (entry != source.context.gain_entries.end() && gain != kGainNames.end() &&
        entry->second.computed[static_cast<std::size_t>(gain - kGainNames.begin())]) {
      return fmt::format("it is given by an expression, {}: save the parameters in it",
                         core::to_flow_yaml(*entry->second.node->find(*gain)));
    }
  }
  std::vector<std::string> names;
  for (const ParameterInfo& info : source.behavior.parameters) names.push_back(info.name);
  return "there is no such parameter or gain" + core::did_you_mean(name, names);
}

// Why a parameter cannot have these values; empty: it can.
std::string reason_against(const ParameterInfo& info, const std::vector<double>& values) {
  if (info.variable) return "it is a variable, which actions set: it is never saved";
  for (const double value : values) {
    if (!std::isfinite(value)) return fmt::format("{} is not a finite number", value);
    const bool negative_gain = info.gain && value < 0.0;
    if (!negative_gain && (!info.has_range() || (value >= info.min && value <= info.max))) continue;
    const std::string unit = core::unit_text(info.dimension);
    return negative_gain && !info.has_range()
               ? "a gain cannot be negative"
               : fmt::format("{:g} is outside its range, {:g} to {:g}{}{}", value, info.min,
                             info.max, unit.empty() ? "" : " ", unit);
  }
  return "";
}

// The parameters that get other values, from what is asked for by name.
void collect_wanted(Planner& planner, const std::vector<SavedValue>& values) {
  const Behavior& behavior = planner.source.behavior;
  std::map<int, std::vector<std::optional<double>>> asked;  // by parameter, by component
  for (const SavedValue& value : values) {
    const ParameterPart part = behavior.find_parameter_part(value.name);
    if (part.parameter < 0) {
      planner.refuse({}, value.name, unknown_reason(planner.source, value.name));
      continue;
    }
    const ParameterInfo& info = behavior.parameters[static_cast<std::size_t>(part.parameter)];
    const auto size = static_cast<std::size_t>(part.component < 0 ? info.size : 1);
    if (value.values.size() != size) {
      planner.refuse({}, value.name,
                     fmt::format("expected {} values, got {}", size, value.values.size()));
      continue;
    }
    auto& all = asked[part.parameter];
    all.resize(static_cast<std::size_t>(info.size));
    for (std::size_t k = 0; k < size; ++k) {
      auto& one = all[part.component < 0 ? k : static_cast<std::size_t>(part.component)];
      if (one && !same_bits(*one, value.values[k])) {
        planner.refuse({}, value.name, "it is asked for twice, with different values");
      }
      one = value.values[k];
    }
  }
  for (const auto& [parameter, given] : asked) {
    const ParameterInfo& info = behavior.parameters[static_cast<std::size_t>(parameter)];
    Wanted wanted{parameter, {}, {}};
    bool differs = false;
    for (std::size_t k = 0; k < given.size(); ++k) {
      const double old = behavior.values[static_cast<std::size_t>(info.slot) + k];
      wanted.values.push_back(given[k].value_or(old));
      differs = differs || !same_bits(wanted.values.back(), old);
    }
    if (!differs) continue;
    wanted.home = find_home(planner.source, info);
    const core::Mark mark = wanted.home.node == nullptr ? core::Mark{} : wanted.home.node->mark;
    const std::string reason = reason_against(info, wanted.values);
    if (!reason.empty()) planner.refuse(mark, info.name, reason);
    planner.wanted.push_back(std::move(wanted));
  }
}

// The file of a mark, read at its first use; nullptr and a refusal if it cannot be changed.
Planner::File* open_file(Planner& planner, const std::string& path, core::Mark mark,
                         const std::string& name) {
  Planner::File& file = planner.changes[identity(path)];
  if (!file.change.path.empty()) return &file;
  file.change.path = path;
  auto text = read_file(path);
  if (!text) {
    planner.refuse(mark, name, fmt::format("{} cannot be read", path));
    return nullptr;
  }
  const std::string folder = fs::path(identity(path)).parent_path().string();
  if (::access(path.c_str(), W_OK) != 0 || ::access(folder.c_str(), W_OK) != 0) {
    planner.refuse(mark, name,
                   fmt::format("{} cannot be written here: save into a file of your own with "
                               "`base: {}`",
                               path, fs::path(path).filename().string()));
    return nullptr;
  }
  file.change.before = file.change.after = std::move(*text);
  return &file;
}

void change_scalar(Planner& planner, const Wanted& wanted, const NodeEdit& edit) {
  const core::YamlNode& node = *edit.node;
  const std::string& name = planner.info(wanted).name;
  const std::string& path = planner.path_of(node.mark);
  Planner::File* file = open_file(planner, path, node.mark, name);
  if (file == nullptr) return;
  auto found = core::find_scalar(file->change.before, node.mark);
  const auto unquoted = [](const std::string& text) {
    const bool quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'');
    return quoted ? text.substr(1, text.size() - 2) : text;
  };
  if (!found || unquoted(found->text) != node.scalar) {
    planner.refuse(node.mark, name,
                   "how it is written there is not understood: change the file by hand");
    return;
  }
  const std::string old_text = found->text;
  const bool quoted = old_text != node.scalar;
  const bool list = edit.text.front() == '[' || edit.text.front() == '{';
  found->text = quoted && !list ? old_text.front() + edit.text + old_text.back() : edit.text;
  for (std::size_t k = 0; k < file->edits.size(); ++k) {
    if (file->edits[k].begin == found->begin && file->edits[k].text != found->text) {
      planner.refuse(node.mark, name,
                     fmt::format("it shares its text with {}, which gets another value",
                                 file->owners[k]));
      return;
    }
  }
  planner.plan.places.push_back(
      {name, path, node.mark.line, node.mark.column, old_text, found->text});
  file->edits.push_back(std::move(*found));
  file->owners.push_back(name);
}

void add_entry(Planner& planner, const Wanted& wanted, const std::string& path, core::Mark mark,
               KeyPath keys, const std::string& text) {
  const std::string& name = planner.info(wanted).name;
  Planner::File* file = open_file(planner, path, mark, name);
  if (file == nullptr) return;
  planner.plan.places.push_back({name, file->change.path, 0, 0, "", text});
  file->additions.push_back({std::move(keys), text, name});
}

// The texts that change for one parameter, each in the file that it belongs to.
void place(Planner& planner, const Wanted& wanted) {
  const std::string& name = planner.info(wanted).name;
  const ValueHome& home = wanted.home;
  const bool of_map = home.node->is_map();
  if (!home.path.empty()) planner.allowed.push_back(home.path);
  const auto edits = edits_in_place(planner.source, wanted);
  for (const NodeEdit& edit : edits) {
    const core::Mark mark = edit.key.empty() ? edit.node->mark : edit.near;
    KeyPath keys = home.path;
    if (!planner.may_change(mark)) {
      if (keys.empty()) {
        planner.refuse(mark, name, "an alias stands there: what to put over it is not clear");
        return;
      }
      if (of_map) {
        for (const core::YamlEntry& entry : home.node->entries) {
          if (&entry.value == edit.node) keys.push_back(entry.key);
        }
        if (!edit.key.empty()) keys.push_back(edit.key);
      }
      add_entry(planner, wanted, planner.overlay, mark, keys,
                of_map ? edit.text : whole_text(planner.source, wanted));
      if (!of_map) return;
      continue;
    }
    if (!edit.key.empty()) {
      keys.push_back(edit.key);
      add_entry(planner, wanted, planner.path_of(mark), mark, keys, edit.text);
      continue;
    }
    // An argument of a template stands elsewhere than what it is put into.
    const auto paths = paths_of(planner.source.context.root, *edit.node);
    const auto in_home = [&](const KeyPath& path) {
      return !home.path.empty() && begins_with(path, home.path);
    };
    if (paths.size() == 1 && !in_home(paths.front())) planner.allowed.push_back(paths.front());
    change_scalar(planner, wanted, edit);
  }
}

// The changed text of a file; false and refusals if it cannot be made.
bool finish_file(Planner& planner, Planner::File& file) {
  auto text = core::apply_edits(file.change.after, file.edits);
  if (!text) {
    planner.plan.refusals.push_back(file.change.path + ": two values would change the same text");
    return false;
  }
  for (const auto& addition : file.additions) {
    core::Diagnostics ignored;
    const core::YamlNode root = core::load_yaml_text(*text, file.change.path, ignored);
    const auto edit = core::add_value(*text, root, addition.path, addition.text);
    if (!edit) {
      planner.plan.refusals.push_back(
          fmt::format("{}: {}: there is no good place for {}: change the file by hand",
                      file.change.path, addition.name, fmt::join(addition.path, ".")));
      return false;
    }
    text = core::apply_edits(*text, {*edit});
  }
  file.change.after = std::move(*text);
  return true;
}

// How `overlay` names its base: beside it, in a library by its name, else by a path from its folder.
std::string base_text(const std::string& overlay, const std::string& base,
                      const LoadOptions& options) {
  const fs::path folder = fs::path(identity(overlay)).parent_path();
  const fs::path real = identity(base);
  std::string text = real.lexically_relative(folder).string();
  for (const std::string& library : library_folders(options.search)) {
    std::error_code error;
    const fs::path file = fs::path(library) / real.filename();
    if (folder == real.parent_path() || !fs::is_regular_file(file, error)) continue;
    const fs::path beside = folder / real.filename();
    if (identity(file.string()) == real.string() && !fs::exists(beside, error)) {
      text = real.stem().string();
    }
    break;
  }
  core::YamlNode node;
  node.kind = core::YamlNode::Kind::scalar;
  node.scalar = text.empty() ? real.string() : text;
  return core::to_flow_yaml(node);
}

// The behavior as `path` has it; false and errors if it does not load.
bool load_source(SaveSource& source, const std::string& path, core::Diagnostics& diagnostics) {
  core::YamlNode root = load_tree(path, source.context.options, diagnostics);
  return compile_behavior(source.context, std::move(root), path);
}

// Whether a file is among those that a load has read.
bool was_read(const core::Diagnostics& files, const std::string& path) {
  for (int k = 0; k < files.file_count(); ++k) {
    if (identity(files.file(k)) == identity(path)) return true;
  }
  return false;
}

void note_bases(Planner& planner, const std::string& path) {
  for (const core::FileChange& change : planner.plan.files) {
    if (change.is_new || identity(change.path) == identity(path)) continue;
    planner.plan.notes.push_back(
        fmt::format("{} is a base of {}: what is written there holds for every behavior on it",
                    change.path, path));
  }
}

void make_plan(Planner& planner, const std::string& path, const std::string& overlay) {
  const auto place_of = [](const SavedPlace& place) {
    return std::tie(place.file, place.line, place.column);
  };
  for (const Wanted& wanted : planner.wanted) {
    if (!planner.plan.refused()) place(planner, wanted);
  }
  std::ranges::stable_sort(planner.plan.places, [&](const auto& a, const auto& b) {
    return place_of(a) < place_of(b);
  });
  for (auto& [id, file] : planner.changes) {
    if (planner.plan.refused() || !finish_file(planner, file)) return;
    if (file.change.before != file.change.after) planner.plan.files.push_back(file.change);
  }
  if (planner.plan.refused() || planner.plan.files.empty()) return;
  planner.plan.refusals = reasons_against_result(
      planner.source, overlay.empty() ? path : overlay, planner.plan.files, planner.wanted,
      planner.allowed);
  note_bases(planner, overlay.empty() ? path : overlay);
}

}  // namespace

SavePlan plan_save(const std::string& path, const LoadOptions& options,
                   const std::vector<SavedValue>& values, const std::string& overlay,
                   core::Diagnostics& diagnostics) {
  SavePlan plan;
  LoadOptions own = options;
  own.set.clear();
  std::error_code error;
  const bool new_overlay =
      !overlay.empty() && !fs::exists(fs::symlink_status(overlay, error));
  const std::string from = overlay.empty() || new_overlay ? path : overlay;
  core::Diagnostics problems;
  SaveSource source(own, problems);
  if (!load_source(source, from, problems)) {
    diagnostics = std::move(problems);
    plan.refusals.push_back(from + ": it does not load");
    return plan;
  }
  if (!overlay.empty() && !new_overlay && !was_read(problems, path)) {
    plan.refusals.push_back(
        fmt::format("{}: it is there already and {} is not among its bases", overlay, path));
    return plan;
  }
  Planner planner{source, problems, plan};
  if (!overlay.empty()) planner.overlay = identity(overlay);
  collect_wanted(planner, values);
  if (plan.refused() || planner.wanted.empty()) return plan;
  if (new_overlay) {
    const std::string head =
        fmt::format("behavior: 1\nbase: {}\n", base_text(overlay, path, options));
    planner.changes[planner.overlay].change = {overlay, "", head, true};
  } else if (!overlay.empty()) {
    open_file(planner, overlay, {}, overlay);
  }
  make_plan(planner, path, overlay);
  if (plan.refused()) plan.files.clear();
  return plan;
}

std::string unified_diff(const SavePlan& plan) {
  std::string out;
  for (const core::FileChange& change : plan.files) {
    out += core::unified_diff(change.path, change.before, change.after, change.is_new);
  }
  return out;
}

std::vector<std::string> write_saved(const SavePlan& plan) {
  if (plan.refused()) return plan.refusals;
  return core::write_changes(plan.files);
}

}  // namespace footfall::behaviors
