// `footfall tune watch`: prints signals and values as they arrive, and all users' edits.
#include <fmt/format.h>

#include <algorithm>
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
  // Of the rows: time of the newest one of this session, run time from the first to the newest one,
  // and when that one was received.
  double time = -1.0, spanned = 0.0, received = seconds_now();
};

// Sets up the columns from the engine's catalogue; false after an error message about an unknown
// name.
bool begin_columns(const TuneModel& model, const TuneOptions& options, Watch& watch) {
  std::vector<std::string> problems;
  watch.columns = watch_columns(model, options.names, problems);
  for (const std::string& problem : problems) fmt::print(stderr, "error: {}\n", problem);
  if (model.catalogue.session != watch.session) watch.time = watch.next_line = -1.0;
  watch.session = model.catalogue.session;
  watch.generation = model.catalogue.generation;
  if (problems.empty() && !watch.json) print_out(watch_head(watch.columns));
  return problems.empty();
}

// Prints the received answers to all users' edits; false if nobody can read it any more.
bool print_edits(TuneSession& session, bool json) {
  TuneModel& model = session.model;
  bool good = true;
  for (const auto& answer : session.client.take_answers()) {
    if (answer.session != model.catalogue.session) continue;
    take_answer(model, answer, session.client.client());
    const TuneNote& note = model.notes.back();
    good = good && print_out(json ? json_line(note_json(note)) : note_line(note));
  }
  return good;
}

// Prints the rows of received telemetry until they span `duration` (0: unlimited), each beside the
// values that were in force in its tick.
bool print_rows(TuneSession& session, double duration, Watch& watch) {
  constexpr double kRounding = 1e-9;  // s
  TuneModel& model = session.model;
  const auto values = session.client.take_values();
  std::size_t v = 0;
  bool good = true;
  for (const auto& told : session.client.take_telemetry()) {
    while (v < values.size() && values[v].tick <= told.tick) take_values(model, values[v++]);
    take_telemetry(model, told);
    if (told.condition == footfall_lcm::telemetry_t::ENDED) break;
    watch.spanned += watch.time < 0.0 ? 0.0 : std::max(0.0, told.time - watch.time);
    watch.time = told.time;
    watch.received = seconds_now();
    if (duration > 0.0 && watch.spanned > duration + kRounding) break;
    if (told.time < watch.next_line) continue;
    watch.next_line = told.time + watch.every * (1.0 - kRounding);
    good = good && print_out(watch.json ? json_line(watch_json(model, watch.columns))
                                        : watch_line(model, watch.columns));
  }
  while (v < values.size()) take_values(model, values[v++]);
  return good;
}

// Whether the rows span the duration, or none was received for as long.
bool is_over(const Watch& watch, const TuneOptions& options) {
  if (options.duration == 0.0) return false;
  return watch.spanned >= options.duration ||
         seconds_now() - watch.received >= std::max(options.duration, options.timeout);
}

// An engine that ends says so.
int explain_silence(const TuneSession& session) {
  fmt::print(stderr,
             "error: nothing has been heard from this engine for {:.1f} s: it was killed, or the "
             "network is cut\n",
             session.client.silence());
  return kMachineFailed;
}

bool has_ended(const TuneModel& model) {
  return model.telemetry_heard && model.telemetry.condition == footfall_lcm::telemetry_t::ENDED;
}

}  // namespace

int tune_watch(const TuneOptions& options) {
  const auto session = open_session(options);
  if (session == nullptr) return kMachineFailed;
  Watch watch;
  watch.json = options.json;
  watch.every = options.every;
  if (!begin_columns(session->model, options, watch)) return kBadInput;
  TuneModel& model = session->model;
  session->client.take_telemetry();  // rows from before the watch
  const std::atomic<bool>& stop = *core::stop_on_signals();
  while (!stop && !is_over(watch, options)) {
    session->client.poll(0.1);
    take_catalogue(model, session->client.catalogue());
    const auto& told = model.catalogue;
    const bool other = told.session != watch.session || told.generation != watch.generation;
    if (other) tell_session(told);
    if (other && !begin_columns(model, options, watch)) return kBadInput;
    if (!print_edits(*session, watch.json)) return kGood;
    if (!print_rows(*session, options.duration, watch)) return kGood;
    if (has_ended(model)) {
      fmt::print(stderr, "the run has ended after {:.2f} s\n", model.telemetry.time);
      return kGood;
    }
    if (session->client.silence() > options.timeout) return explain_silence(*session);
  }
  return kGood;
}

}  // namespace footfall::apps
