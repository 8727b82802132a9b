// Output of the sub-commands of `footfall tune`: tables as text, and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/tune/model/model.h"

namespace footfall::apps {

// One line a parameter: name, value (and target of a ramp), the file's value if different, range,
// doc.
std::string list_text(const TuneModel& model, const std::vector<int>& parameters);
// `lift_time=150 ms`, one line each, exact: valid input of `set`.
std::string get_text(const TuneModel& model, const std::vector<int>& parameters);
// Those of the parameters that differ from the file: name, the file's value, the current value.
std::string difference_text(const TuneModel& model, const std::vector<int>& parameters);
// Names alone, one a line.
std::string names_text(const TuneModel& model, const std::vector<int>& parameters);
// As JSON; a scalar parameter is a number, others are lists. Values are SI.
nlohmann::ordered_json list_json(const TuneModel& model, const std::vector<int>& parameters);

// `accepted at tick 5120, revision 3: lift_time = 150 ms over 100 ms`.
std::string answer_text(const footfall_lcm::answer_t& answer);
nlohmann::ordered_json answer_json(const footfall_lcm::answer_t& answer);

// A column of `watch`: a signal, or a value of a parameter.
struct WatchColumn {
  std::string name, unit;
  int signal = -1;  // index into the catalogue's signals
  int slot = -1;    // index into the values
  int width = 0;
};
// The columns for names and patterns; every problem is one line of text.
std::vector<WatchColumn> watch_columns(const TuneModel& model,
                                       const std::vector<std::string>& names,
                                       std::vector<std::string>& problems);
std::string watch_head(const std::vector<WatchColumn>& columns);
// One sample: time, values, active states; `-` for absent values.
std::string watch_line(const TuneModel& model, const std::vector<WatchColumn>& columns);
nlohmann::ordered_json watch_json(const TuneModel& model, const std::vector<WatchColumn>& columns);
std::string note_line(const TuneNote& note);
nlohmann::ordered_json note_json(const TuneNote& note);

}  // namespace footfall::apps
