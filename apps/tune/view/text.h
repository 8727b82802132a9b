// What the sub-commands of `footfall tune` print: tables for people, JSON for scripts.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/tune/model/model.h"

namespace footfall::apps {

// One line a parameter: name, value (and where it goes), the file's where it differs, range, doc.
std::string list_text(const TuneModel& model, const std::vector<int>& parameters);
// `lift_time=150 ms`, one line each, exact: `set` takes it back.
std::string get_text(const TuneModel& model, const std::vector<int>& parameters);
// The parameters among these that differ from the file: name, the file's value, the one in force.
std::string difference_text(const TuneModel& model, const std::vector<int>& parameters);
// Names alone, one a line.
std::string names_text(const TuneModel& model, const std::vector<int>& parameters);
// The same for scripts; what has one value is a number, else a list. Values are SI.
nlohmann::ordered_json list_json(const TuneModel& model, const std::vector<int>& parameters);

// `accepted at tick 5120, revision 3: lift_time = 150 ms over 100 ms`.
std::string answer_text(const footfall_lcm::answer_t& answer);
nlohmann::ordered_json answer_json(const footfall_lcm::answer_t& answer);

// A column of `watch`: a signal, or a value of a parameter.
struct WatchColumn {
  std::string name, unit;
  int signal = -1;  // into the catalogue's signals
  int slot = -1;    // of the values
  int width = 0;
};
// The columns of names and patterns; every problem a line for people.
std::vector<WatchColumn> watch_columns(const TuneModel& model,
                                       const std::vector<std::string>& names,
                                       std::vector<std::string>& problems);
std::string watch_head(const std::vector<WatchColumn>& columns);
// One sample: time, values, active states; `-` for what has no value.
std::string watch_line(const TuneModel& model, const std::vector<WatchColumn>& columns);
nlohmann::ordered_json watch_json(const TuneModel& model, const std::vector<WatchColumn>& columns);
std::string note_line(const TuneNote& note);
nlohmann::ordered_json note_json(const TuneNote& note);

}  // namespace footfall::apps
