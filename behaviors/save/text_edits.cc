// The texts that change, file by file; see parts.h.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "behaviors/save/parts.h"

namespace footfall::behaviors {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

bool may_change(const SavePlanner& planner, core::Mark mark) {
  return planner.only.empty() ||
         (mark.file >= 0 && identity(planner.path_of(mark)) == planner.only);
}

void change_scalar(SavePlanner& planner, const Wanted& wanted, const NodeEdit& edit) {
  const core::YamlNode& node = *edit.node;
  const std::string& name = planner.info(wanted).name;
  const std::string& path = planner.path_of(node.mark);
  SavePlanner::File* file = open_file(planner, path, node.mark, name);
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
      planner.refuse(
          node.mark, name,
          fmt::format("it shares its text with {}, which gets another value", file->owners[k]));
      return;
    }
  }
  planner.plan.places.push_back(
      {name, path, node.mark.line, node.mark.column, old_text, found->text});
  file->edits.push_back(std::move(*found));
  file->owners.push_back(name);
}

void add_entry(SavePlanner& planner, const Wanted& wanted, const std::string& path, core::Mark mark,
               KeyPath keys, const std::string& text) {
  const std::string& name = planner.info(wanted).name;
  SavePlanner::File* file = open_file(planner, path, mark, name);
  if (file == nullptr) return;
  planner.plan.places.push_back({name, file->change.path, 0, 0, "", text});
  file->additions.push_back({std::move(keys), text, name});
}

}  // namespace

void SavePlanner::refuse(core::Mark mark, const std::string& name, const std::string& reason) {
  const std::string place =
      mark.file < 0 ? "" : fmt::format("{}:{}:{}: ", path_of(mark), mark.line, mark.column);
  plan.refusals.push_back(fmt::format("{}{}: {}", place, name, reason));
}

std::string identity(const std::string& path) {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? path : real.string();
}

std::string reason_against_file(const SavePlanner& planner, const std::string& path) {
  const fs::path file = identity(path);
  const auto holds = [&](const std::string& folder) {
    const fs::path inner = file.lexically_relative(identity(folder));
    return !inner.empty() && *inner.begin() != "..";
  };
  if (std::ranges::any_of(planner.installed, holds)) {
    return fmt::format("{} is an installed file, which is never written: --to FILE", path);
  }
  if (file != planner.named && std::ranges::any_of(planner.libraries, holds)) {
    return fmt::format(
        "{} belongs to a library, which other behaviors share: it is written only if it is named "
        "itself (footfall set {})",
        path, file.stem().string());
  }
  return "";
}

SavePlanner::File* open_file(SavePlanner& planner, const std::string& path, core::Mark mark,
                             const std::string& name) {
  SavePlanner::File& file = planner.changes[identity(path)];
  if (!file.change.path.empty()) return &file;
  file.change.path = path;
  if (const std::string reason = reason_against_file(planner, path); !reason.empty()) {
    planner.refuse(mark, name, reason);
    return nullptr;
  }
  auto text = read_file(path);
  if (!text) {
    planner.refuse(mark, name, fmt::format("{} cannot be read", path));
    return nullptr;
  }
  const std::string folder = fs::path(identity(path)).parent_path().string();
  if (::access(path.c_str(), W_OK) != 0 || ::access(folder.c_str(), W_OK) != 0) {
    planner.plan.unwritable = true;
    planner.refuse(
        mark, name,
        fmt::format("{} cannot be written: save into a file on top of it (--to FILE)", path));
    return nullptr;
  }
  file.change.before = file.change.after = std::move(*text);
  return &file;
}

void place_edits(SavePlanner& planner, const Wanted& wanted) {
  const std::string& name = planner.info(wanted).name;
  const ValueHome& home = wanted.home;
  if (home.node == nullptr) {
    planner.refuse({}, name, "where it is written is not known: change the file by hand");
    return;
  }
  const bool of_map = home.node->is_map();
  if (!home.path.empty()) planner.allowed.push_back(home.path);
  const auto edits = edits_in_place(planner.source, wanted);
  for (const NodeEdit& edit : edits) {
    const core::Mark mark = edit.key.empty() ? edit.node->mark : edit.near;
    KeyPath keys = home.path;
    if (!may_change(planner, mark)) {
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
      add_entry(planner, wanted, planner.only, mark, keys,
                of_map ? edit.text : whole_text(planner.source, wanted));
      if (!of_map) return;
      continue;
    }
    if (!edit.key.empty()) {
      keys.push_back(edit.key);
      add_entry(planner, wanted, planner.path_of(mark), mark, keys, edit.text);
      continue;
    }
    // The argument of a template is written elsewhere than the place it is substituted into.
    const auto paths = paths_of(planner.source.context.root, *edit.node);
    const auto in_home = [&](const KeyPath& path) {
      return !home.path.empty() && begins_with(path, home.path);
    };
    if (paths.size() == 1 && !in_home(paths.front())) planner.allowed.push_back(paths.front());
    change_scalar(planner, wanted, edit);
  }
}

bool finish_file(SavePlanner& planner, SavePlanner::File& file) {
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

}  // namespace footfall::behaviors
