// `footfall tune watch`: prints signals and values as they arrive, and all users' edits.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/shared/commands.h"
#include "apps/tune/model/options.h"
#include "apps/tune/session.h"
#include "apps/tune/view/tables.h"
#include "core/process/standard_streams.h"
#include "core/process/stop_signals.h"
#include "core/text/json_text.h"

namespace footfall::apps {
namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Prints; false if nobody can read it any more.
bool print_out(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
  return !core::standard_output_failed();
}

std::string json_line(const nlohmann::ordered_json& json) { return core::json_text(json) + "\n"; }

struct Watch {
  std::vector<WatchColumn> columns;
  bool json = false;
  double every = 0.0;       // s of run time between lines
  double next_line = -1.0;  // s of run time
  std::int64_t session = 0, generation = 0;
};

// Prints received samples and edits as lines.
bool print_samples(TuneSession& session, Watch& watch) {
  TuneModel& model = session.model;
  const std::size_t notes = model.notes.size();
  session.client.poll(0.1);
  take_catalogue(model, session.client.catalogue());
  take_values(model, session.client.values());
  for (const auto& answer : session.client.take_answers()) {
    take_answer(model, answer, session.client.client());
  }
  bool good = true;
  for (std::size_t k = notes; k < model.notes.size(); ++k) {
    good = good &&
           print_out(watch.json ? json_line(note_json(model.notes[k])) : note_line(model.notes[k]));
  }
  for (const auto& told : session.client.take_telemetry()) {
    take_telemetry(model, told);
    if (told.time < watch.next_line && told.session == watch.session) continue;
    watch.next_line = told.time + watch.every * (1.0 - 1e-9);
    good = good && print_out(watch.json ? json_line(watch_json(model, watch.columns))
                                        : watch_line(model, watch.columns));
  }
  return good;
}

// Sets up the columns from the engine's catalogue; false after an error message about an unknown
// name.
bool begin_columns(const TuneModel& model, const TuneOptions& options, Watch& watch) {
  std::vector<std::string> problems;
  watch.columns = watch_columns(model, options.names, problems);
  for (const std::string& problem : problems) fmt::print(stderr, "error: {}\n", problem);
  watch.session = model.catalogue.session;
  watch.generation = model.catalogue.generation;
  if (problems.empty() && !watch.json) print_out(watch_head(watch.columns));
  return problems.empty();
}

}  // namespace

int tune_watch(const TuneOptions& options) {
  const auto session = open_session(options);
  if (session == nullptr) return kMachineFailed;
  Watch watch;
  watch.json = options.json;
  watch.every = options.every;
  if (!begin_columns(session->model, options, watch)) return kBadInput;
  const std::atomic<bool>& stop = *core::stop_on_signals();
  const double end = seconds_now() + options.duration;
  while (!stop && (options.duration == 0.0 || seconds_now() < end)) {
    if (!print_samples(*session, watch)) return kGood;
    const auto& told = session->model.catalogue;
    const bool other = told.session != watch.session || told.generation != watch.generation;
    if (other) tell_session(told);
    if (other && !begin_columns(session->model, options, watch)) return kBadInput;
    if (session->client.silence() > options.timeout) {
      fmt::print(stderr, "error: {}\n", session->client.why_not());
      return kMachineFailed;
    }
  }
  return kGood;
}

}  // namespace footfall::apps
