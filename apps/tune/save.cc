// Saves current values to the behavior's file; see save.h.
#include "apps/tune/save.h"

#include <fmt/format.h>

#include <filesystem>
#include <numeric>

#include "apps/shared/commands.h"
#include "apps/shared/save_dialog.h"
#include "apps/tune/model/options.h"
#include "apps/tune/session.h"
#include "core/index.h"

namespace footfall::apps {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

// Whether a save with --to writes the file that runs after all.
bool is_own_file(const std::string& path, const std::string& overlay) {
  std::error_code ignored;
  return overlay.empty() || fs::equivalent(path, overlay, ignored);
}

std::string edited_text(const TuneModel& model, const KnownValues& known,
                        const TuneParameter& parameter) {
  const auto was = std::span(known.values).subspan(at(parameter.first), at(parameter.size));
  return fmt::format(
      "{}: the file was edited {}: it has {} now, had {} then; --to FILE saves elsewhere, names "
      "behind "
      "`save` choose others",
      parameter.name, known.of_files ? "since the last save" : "while the run was on",
      exact_values(file_of(model, parameter), parameter.unit), exact_values(was, parameter.unit));
}

}  // namespace

TuneSave plan_tune_save(TuneModel& model, const std::vector<int>& parameters,
                        const std::string& overlay, bool into_base) {
  TuneSave save;
  const std::string& path = model.catalogue.path;
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) {
    save.problems.push_back(fmt::format(
        "{}: no such file here: save on the host that the engine runs on, or mount it", path));
    return save;
  }
  // An overlay may differ from the file that runs in any value.
  const bool exists = !overlay.empty() && fs::is_regular_file(overlay, ignored);
  const bool own = is_own_file(path, overlay);
  const KnownValues known = known_values(model);
  std::vector<behaviors::NamedValue> values;
  std::vector<int> saved;
  for (const int index : parameters) {
    const TuneParameter& parameter = model.parameters[at(index)];
    const auto target = target_of(model, parameter);
    const bool differs = differs_from_file(model, parameter);
    if (!exists && !differs) continue;
    values.push_back({parameter.name, {target.begin(), target.end()}});
    saved.push_back(index);
    if (own && differs && was_edited(model, known, parameter)) {
      save.problems.push_back(edited_text(model, known, parameter));
    }
  }
  if (values.empty() || !save.problems.empty()) return save;
  if (own) save.known = after_save(model, known, saved);
  core::Diagnostics diagnostics;
  behaviors::LoadOptions options;
  options.search = search_path();
  save.plan = behaviors::plan_save(path, options, values, {overlay, into_base, installed_folders()},
                                   diagnostics);
  save.problems = save.plan.refusals;
  if (diagnostics.has_errors()) {
    for (const std::string& line : lines_of(diagnostics.to_string())) save.problems.push_back(line);
  }
  save.diff = behaviors::unified_diff(save.plan);
  return save;
}

std::vector<std::string> write_tune_save(const TuneModel& model, const TuneSave& save,
                                         std::vector<std::string>& problems) {
  std::vector<std::string> written;
  problems = behaviors::write_saved(save.plan);
  if (!problems.empty()) return written;
  if (save.known) remember(model, *save.known);
  for (const core::FileChange& file : save.plan.files) {
    written.push_back(file.path + ": written");
  }
  return written;
}

int tune_save(const TuneOptions& options) {
  const auto session = open_session(options);
  if (session == nullptr) return kMachineFailed;
  TuneModel& model = session->model;
  std::vector<int> parameters(model.parameters.size());
  std::iota(parameters.begin(), parameters.end(), 0);
  if (!options.names.empty()) {
    parameters.clear();
    for (const std::string& name : options.names) {
      std::string problem;
      for (const int index : find_parameters(model, name, problem)) parameters.push_back(index);
      if (!problem.empty()) throw InputError(fmt::format("error: {}\n", problem));
    }
  }
  read_file_values(model);
  const TuneSave save = plan_tune_save(model, parameters, options.file, options.into_base);
  for (const std::string& problem : save.problems) fmt::print(stderr, "error: {}\n", problem);
  if (!save.problems.empty()) return kBadInput;
  const std::string& name = options.file.empty() ? model.catalogue.path : options.file;
  const int code = show_and_write(save.plan, name, options.dry_run, options.yes);
  if (code == kGood && !options.dry_run && save.known) remember(model, *save.known);
  return code;
}

}  // namespace footfall::apps
