// Model of `footfall tune` as plain data: parameters with their values, the log of all users'
// edits, the signals' history. No terminal, no network: messages in, requests out.
#pragma once

#include <cstdint>
#include <deque>
#include <footfall_lcm/answer_t.hpp>
#include <footfall_lcm/catalogue_t.hpp>
#include <footfall_lcm/request_t.hpp>
#include <footfall_lcm/telemetry_t.hpp>
#include <footfall_lcm/values_t.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/tune/model/quantity.h"
#include "apps/tune/model/signal_history.h"

namespace footfall::apps {

// A live parameter or gain, and its display format.
struct TuneParameter {
  std::string name;
  int first = 0, size = 1;  // range of slots in the value arrays
  core::Dimension dimension;
  DisplayUnit unit;
  double min = 0.0, max = 0.0;  // SI; equal: no limits
  bool gain = false;
  std::vector<std::string> axes;  // names of the values; none: x, y, z
  std::string doc;

  bool has_range() const { return min < max; }
};

// One value that keys can step: a scalar parameter, or a component of another one.
struct TuneEntry {
  std::string name;  // `lift_time`, `goal.x`, `gains.single.attitude.kp.pitch`
  int parameter = 0;
  int component = -1;  // -1 for a scalar
  int slot = 0;        // index into the value arrays
  double step = 0.0;   // in the display unit
};

// Result of a request by any user.
struct TuneNote {
  double time = 0.0;  // s, time of the run
  std::string who, text;
  bool accepted = false, own = false;
};

struct TuneModel {
  footfall_lcm::catalogue_t catalogue{};
  footfall_lcm::values_t values{};
  footfall_lcm::telemetry_t telemetry{};
  bool telemetry_heard = false;
  std::vector<TuneParameter> parameters;  // parameters, then gains, by name
  std::vector<TuneEntry> entries;         // in the same order
  std::deque<TuneNote> notes;             // newest last
  SignalHistory history;
  std::vector<double> file_values;  // the file's values; initially those at the start of the engine
  std::int64_t files_changed = 0;   // us since 1970, newest change of the files that were read

  double value_now(int slot) const;
  // The value in the tick of the newest telemetry; kNoValue (NaN) if the newest values are later,
  // or do not prove it: they are of another revision, or earlier and on a ramp.
  double value_in_telemetry(int slot) const;
  double value_target(int slot) const;
  double value_of_file(int slot) const;
};

// Applies a message; a catalogue of another session or generation resets the model.
void take_catalogue(TuneModel& model, const footfall_lcm::catalogue_t& catalogue);
void take_values(TuneModel& model, const footfall_lcm::values_t& values);
void take_telemetry(TuneModel& model, const footfall_lcm::telemetry_t& telemetry);
void take_answer(TuneModel& model, const footfall_lcm::answer_t& answer, std::int64_t client);

// Sets the file's values, by slot, after the file was read again.
void take_file_values(TuneModel& model, std::vector<double> values);

// Current values, target values (of ramps) and file values of one parameter, SI.
std::span<const double> now_of(const TuneModel& model, const TuneParameter& parameter);
std::span<const double> target_of(const TuneModel& model, const TuneParameter& parameter);
std::span<const double> file_of(const TuneModel& model, const TuneParameter& parameter);
bool differs_from_file(const TuneModel& model, const TuneParameter& parameter);
// `80 to 400 ms`; empty if unlimited.
std::string range_text(const TuneParameter& parameter);

// Whether a name contains the filter text, or matches it if it is a pattern; true without a filter.
bool passes_filter(std::string_view name, std::string_view filter);
// Indices into model.parameters of a name, or of all matches of a pattern; empty, with a problem as
// text, if there is none.
std::vector<int> find_parameters(const TuneModel& model, std::string_view name,
                                 std::string& problem);

// Parses `NAME=VALUE` texts; every problem is one line of text. NAME may be one component:
// `goal.x`, `gains.single.attitude.kp.pitch` (or `kp[0]`). One number for several values is for
// gains only.
std::vector<footfall_lcm::change_t> read_changes(const TuneModel& model,
                                                 const std::vector<std::string>& texts,
                                                 std::vector<std::string>& problems);
// Checks that the events are in the catalogue; every problem is one line of text.
void check_events(const TuneModel& model, const std::vector<std::string>& events,
                  std::vector<std::string>& problems);
// The change of one entry to a value.
footfall_lcm::change_t change_of(const TuneModel& model, const TuneEntry& entry, double value);
// All changes needed to restore the file's values.
std::vector<footfall_lcm::change_t> changes_to_file(const TuneModel& model);

// A request with these changes, to be applied completely or not at all.
footfall_lcm::request_t edit_request(std::vector<footfall_lcm::change_t> changes,
                                     std::vector<std::string> events, double over,
                                     std::int64_t revision);
footfall_lcm::request_t undo_request(bool redo);
// True if the engine refused the request because of a concurrent change by another user.
bool is_conflict(const footfall_lcm::request_t& request, const footfall_lcm::answer_t& answer);

// A signal's newest value; NaN if absent.
double signal_value(const TuneModel& model, std::string_view name);
// Its unit; empty if none.
std::string signal_unit(const TuneModel& model, std::string_view name);
int find_signal(const TuneModel& model, std::string_view name);  // -1 if absent

}  // namespace footfall::apps
