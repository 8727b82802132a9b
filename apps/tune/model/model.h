// What a person who tunes sees and asks for, as plain data: parameters with their values, the log
// of everybody's edits, the signals' past. No terminal, no network: messages in, requests out.
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

// A live parameter or gain, and how it is shown.
struct TuneParameter {
  std::string name;
  int first = 0, size = 1;  // of its values
  core::Dimension dimension;
  DisplayUnit unit;
  double min = 0.0, max = 0.0;  // SI; equal: no range
  bool gain = false;
  std::string doc;

  bool has_range() const { return min < max; }
};

// One value that keys step: a parameter, or one of its components.
struct TuneEntry {
  std::string name;  // `lift_time`, `goal.x`, `gains.single.swing.kp[1]`
  int parameter = 0;
  int component = -1;  // -1: it has no others
  int slot = 0;        // of the values
  double step = 0.0;   // in the display unit
};

// What became of somebody's request.
struct TuneNote {
  double time = 0.0;  // s of the run
  std::string who, text;
  bool accepted = false, own = false;
};

struct TuneModel {
  footfall_lcm::catalogue_t catalogue{};
  footfall_lcm::values_t values{};
  footfall_lcm::telemetry_t telemetry{};
  bool telemetry_heard = false;
  std::vector<TuneParameter> parameters;  // parameters, then gains, by name
  std::vector<TuneEntry> entries;         // likewise
  std::deque<TuneNote> notes;             // the newest last
  SignalHistory history;
  std::vector<double> file_values;  // as the file has them; at first what the engine began with

  double value_now(int slot) const;
  double value_target(int slot) const;
  double value_of_file(int slot) const;
};

// Takes over a message; a catalogue of another session or generation empties what was known.
void take_catalogue(TuneModel& model, const footfall_lcm::catalogue_t& catalogue);
void take_values(TuneModel& model, const footfall_lcm::values_t& values);
void take_telemetry(TuneModel& model, const footfall_lcm::telemetry_t& telemetry);
void take_answer(TuneModel& model, const footfall_lcm::answer_t& answer, std::int64_t client);

// The file was read again: its values, by slot.
void take_file_values(TuneModel& model, std::vector<double> values);

// What is in force, where it goes, what the file says: all of one parameter, SI.
std::span<const double> now_of(const TuneModel& model, const TuneParameter& parameter);
std::span<const double> target_of(const TuneModel& model, const TuneParameter& parameter);
std::span<const double> file_of(const TuneModel& model, const TuneParameter& parameter);
bool differs_from_file(const TuneModel& model, const TuneParameter& parameter);
// `80 to 400 ms`; empty: no range.
std::string range_text(const TuneParameter& parameter);

// True if a name holds the filter's text, or matches it where it is a pattern; without a filter
// too.
bool passes_filter(std::string_view name, std::string_view filter);
// Indices into model.parameters of a name, or of all that match a pattern; empty, with a problem
// for people, if there is none.
std::vector<int> find_parameters(const TuneModel& model, std::string_view name,
                                 std::string& problem);

// `NAME=VALUE` texts as changes; every problem a line for people. NAME may be one component:
// `goal.x`, `gains.single.swing.kp[1]`.
std::vector<footfall_lcm::change_t> read_changes(const TuneModel& model,
                                                 const std::vector<std::string>& texts,
                                                 std::vector<std::string>& problems);
// Events of the catalogue; every problem a line for people.
void check_events(const TuneModel& model, const std::vector<std::string>& events,
                  std::vector<std::string>& problems);
// One value of an entry as a change.
footfall_lcm::change_t change_of(const TuneModel& model, const TuneEntry& entry, double value);
// All that makes the values again those of the file.
std::vector<footfall_lcm::change_t> changes_to_file(const TuneModel& model);

// The request for that: applied whole or not at all.
footfall_lcm::request_t edit_request(std::vector<footfall_lcm::change_t> changes,
                                     std::vector<std::string> events, double over,
                                     std::int64_t revision);
footfall_lcm::request_t undo_request(bool redo);
// True if the engine refused it because somebody changed something in between.
bool is_conflict(const footfall_lcm::request_t& request, const footfall_lcm::answer_t& answer);

// A signal's newest value; NaN: none.
double signal_value(const TuneModel& model, std::string_view name);
// Its unit; empty: none.
std::string signal_unit(const TuneModel& model, std::string_view name);
int find_signal(const TuneModel& model, std::string_view name);  // -1: no such name

}  // namespace footfall::apps
