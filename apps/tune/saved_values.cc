// The values that a run's files are known to have; see saved_values.h.
#include "apps/tune/saved_values.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/index.h"
#include "core/text/json_text.h"
#include "core/text/whole_file.h"
#include "engine/live/key.h"

namespace footfall::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kRuns = 16;  // newest ones that are remembered

std::string place() {
  return (fs::path(engine::default_key_path()).parent_path() / "saved.json").string();
}

// An empty list if there is none, or none that can be read.
Json read_runs() {
  try {
    Json runs = Json::parse(core::read_whole_file(place()));
    return runs.is_array() ? runs : Json::array();
  } catch (const std::exception&) {
    return Json::array();
  }
}

// A reload makes another run of it: its catalogue has the files' values anew.
bool is_of(const Json& run, const TuneModel& model) {
  return run.value("session", std::int64_t{0}) == model.catalogue.session &&
         run.value("generation", std::int64_t{-1}) == model.catalogue.generation &&
         run.value("path", std::string()) == model.catalogue.path;
}

bool same(const TuneParameter& parameter, const std::vector<double>& a,
          const std::vector<double>& b) {
  const auto first = a.begin() + parameter.first;
  return std::equal(first, first + parameter.size, b.begin() + parameter.first);
}

void copy(const TuneParameter& parameter, const std::vector<double>& from,
          std::vector<double>& to) {
  std::copy_n(from.begin() + parameter.first, parameter.size, to.begin() + parameter.first);
}

}  // namespace

KnownValues known_values(const TuneModel& model) {
  KnownValues known{model.catalogue.values, false};
  try {
    for (const Json& run : read_runs()) {
      if (!is_of(run, model)) continue;
      auto values = run.at("values").get<std::vector<double>>();
      if (values.size() == known.values.size()) known = {std::move(values), true};
    }
  } catch (const Json::exception&) {  // written by another version
  }
  return known;
}

bool was_edited(const TuneModel& model, const KnownValues& known, const TuneParameter& parameter) {
  if (same(parameter, model.file_values, known.values)) return false;
  // In files that nobody touched, another value than the run's first one is due to --set.
  return known.of_files || model.files_changed > model.catalogue.start;
}

KnownValues after_save(const TuneModel& model, const KnownValues& known,
                       const std::vector<int>& saved) {
  KnownValues after{known.values, true};
  for (const TuneParameter& parameter : model.parameters) {
    if (!was_edited(model, known, parameter)) copy(parameter, model.file_values, after.values);
  }
  for (const int index : saved) {
    copy(model.parameters[at(index)], model.values.target, after.values);
  }
  return after;
}

void remember(const TuneModel& model, const KnownValues& known) {
  try {
    Json runs = read_runs(), kept = Json::array();
    for (Json& run : runs) {
      if (!run.is_object() || is_of(run, model)) continue;
      if (runs.size() < kRuns || &run != &runs.front()) kept.push_back(std::move(run));
    }
    kept.push_back({{"session", model.catalogue.session},
                    {"generation", model.catalogue.generation},
                    {"path", model.catalogue.path},
                    {"values", known.values}});
    fs::create_directories(fs::path(place()).parent_path());
    core::write_whole_file(place(), kept.dump() + "\n");
  } catch (const std::exception&) {
  }
}

}  // namespace footfall::apps
