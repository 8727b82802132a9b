// Times on the command line.
#pragma once

#include <string>

namespace footfall::apps {

// Seconds of a text such as `2.5s`; a bare number is seconds. Throws std::runtime_error
// (`--from: error: expected a time such as 2.5s, got '2,5s' ...`) that says what is near.
double read_time(const std::string& text, const char* option);
// The same; `otherwise` for an empty text, an option that was not given.
double read_time(const std::string& text, const char* option, double otherwise);

// The part of a run that `--from` and `--to` ask for, s; all of it without them.
struct TimeSpan {
  double from, to;
  bool is_part;
};
// Throws std::runtime_error as read_time() does, and if it ends before it begins.
TimeSpan read_span(const std::string& from, const std::string& to);

}  // namespace footfall::apps
