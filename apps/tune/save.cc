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
  std::vector<behaviors::NamedValue> values;
  for (const int index : parameters) {
    const TuneParameter& parameter = model.parameters[at(index)];
    const auto target = target_of(model, parameter);
    if (exists || differs_from_file(model, parameter)) {
      values.push_back({parameter.name, {target.begin(), target.end()}});
    }
  }
  if (values.empty()) return save;
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

std::vector<std::string> write_tune_save(const TuneSave& save, std::vector<std::string>& problems) {
  std::vector<std::string> written;
  problems = behaviors::write_saved(save.plan);
  if (!problems.empty()) return written;
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
  return show_and_write(save.plan, name, options.dry_run, options.yes);
}

}  // namespace footfall::apps
