// Sub-commands of `footfall tune` that perform one action and exit.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/shared/commands.h"
#include "apps/tune/model/options.h"
#include "apps/tune/session.h"
#include "apps/tune/view/tables.h"
#include "core/diagnostics/diagnostics.h"
#include "core/index.h"
#include "core/process/machine_error.h"
#include "core/text/json_text.h"
#include "core/yaml/glob.h"

namespace footfall::apps {
namespace {

std::vector<int> all_parameters(const TuneModel& model) {
  std::vector<int> all(model.parameters.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  return all;
}

void print_json(const nlohmann::ordered_json& json) { fmt::print("{}\n", core::json_text(json)); }

int explain(const std::vector<std::string>& problems) {
  for (const std::string& problem : problems) fmt::print(stderr, "error: {}\n", problem);
  return kBadInput;
}

// Indices of the parameters that match `names`, each once, in order; false after an error message.
bool find_named(const TuneModel& model, const std::vector<std::string>& names,
                std::vector<int>& found) {
  std::vector<std::string> problems;
  for (const std::string& name : names) {
    std::string problem;
    for (const int index : find_parameters(model, name, problem)) {
      if (std::ranges::find(found, index) == found.end()) found.push_back(index);
    }
    if (!problem.empty()) problems.push_back(problem);
  }
  explain(problems);
  return problems.empty();
}

}  // namespace

int tune_list(const TuneOptions& options) {
  const auto session = open_session(options, options.only_names);
  if (session == nullptr) return kMachineFailed;
  const TuneModel& model = session->model;
  std::vector<int> shown;
  for (const int index : all_parameters(model)) {
    const auto passes = [&](const std::string& filter) {
      return passes_filter(model.parameters[at(index)].name, filter);
    };
    if (options.names.empty() || std::ranges::any_of(options.names, passes)) shown.push_back(index);
  }
  if (shown.empty() && !options.names.empty()) {
    return explain(
        {fmt::format("no live parameter or gain matches '{}'", fmt::join(options.names, "', '"))});
  }
  if (options.json)
    print_json(list_json(model, shown));
  else if (options.only_names)
    fmt::print("{}", names_text(model, shown));
  else
    fmt::print("{}", list_text(model, shown));
  return kGood;
}

int tune_get(const TuneOptions& options) {
  const auto session = open_session(options);
  if (session == nullptr) return kMachineFailed;
  std::vector<int> found;
  if (!find_named(session->model, options.names, found)) return kBadInput;
  if (options.json)
    print_json(list_json(session->model, found));
  else
    fmt::print("{}", get_text(session->model, found));
  return kGood;
}

int tune_diff(const TuneOptions& options) {
  const auto session = open_session(options);
  if (session == nullptr) return kMachineFailed;
  TuneModel& model = session->model;
  if (!read_file_values(model)) {
    fmt::print(stderr, "note: {} cannot be read here; compared with what the run began with\n",
               model.catalogue.path);
  }
  std::vector<int> different;
  for (const int index : all_parameters(model)) {
    if (differs_from_file(model, model.parameters[at(index)])) different.push_back(index);
  }
  if (options.json)
    print_json(list_json(model, different));
  else
    fmt::print("{}", difference_text(model, different));
  return kGood;
}

int tune_set(const TuneOptions& options) {
  const auto session = open_session(options);
  if (session == nullptr) return kMachineFailed;
  std::vector<std::string> problems;
  auto changes = read_changes(session->model, options.names, problems);
  check_events(session->model, options.events, problems);
  if (!problems.empty()) return explain(problems);
  return send_and_explain(
      *session, edit_request(std::move(changes), options.events, options.over, options.revision),
      options);
}

int tune_undo(const TuneOptions& options, bool redo) {
  const auto session = open_session(options);
  if (session == nullptr) return kMachineFailed;
  for (int k = 0; k < options.count; ++k) {
    footfall_lcm::request_t request = undo_request(redo);
    request.over = options.over;
    const int code = send_and_explain(*session, request, options);
    if (code != kGood) return code;
  }
  return kGood;
}

int tune_raise(const TuneOptions& options) {
  const auto session = open_session(options);
  if (session == nullptr) return kMachineFailed;
  std::vector<std::string> problems;
  check_events(session->model, options.names, problems);
  if (!problems.empty()) return explain(problems);
  return send_and_explain(*session, edit_request({}, options.names, 0.0, -1), options);
}

int tune_key(const TuneOptions& options) {
  try {
    engine::make_key(options.file);
  } catch (const core::MachineError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(fmt::format("error: {}\n", error.what()));
  }
  fmt::print(
      "{0}: a new key. Copy it to who shall tune, and to nobody else (scp -p {0} HOST:). Then:\n"
      "  footfall run BEHAVIOR --realtime --lcm URL --lcm-key {0}\n"
      "  footfall tune --url URL --key {0}\n",
      options.file);
  return kGood;
}

}  // namespace footfall::apps
