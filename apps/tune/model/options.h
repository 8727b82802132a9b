// Command-line options of `footfall tune`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace footfall::apps {

struct TuneOptions {
  std::string url;
  std::string prefix = "FOOTFALL";
  std::string key;  // path of the key file; empty: the user's default key
  bool open = false;
  std::string who;
  std::int64_t session = 0;  // of the engine; 0: the only one
  double timeout = 3.0;      // s
  bool json = false;
  // For sub-commands:
  std::vector<std::string> names;  // NAME, GLOB, NAME=VALUE, EVENT
  std::vector<std::string> events;
  double over = 0.0;           // s
  std::int64_t revision = -1;  // -1: the current revision
  int count = 1;               // number of undo or redo steps
  bool only_names = false;
  std::string file;  // key FILE, save --to FILE
  bool yes = false, dry_run = false, into_base = false;
  double duration = 0.0;  // s, of watch; 0: until Ctrl-C
  double every = 0.0;     // s between lines of watch; 0: each sample
};

// Each is a sub-command: does it, prints, returns the exit code.
int tune_list_engines(const TuneOptions& options);
int tune_list(const TuneOptions& options);
int tune_get(const TuneOptions& options);
int tune_diff(const TuneOptions& options);
int tune_set(const TuneOptions& options);
int tune_undo(const TuneOptions& options, bool redo);
int tune_raise(const TuneOptions& options);
int tune_save(const TuneOptions& options);
int tune_watch(const TuneOptions& options);
int tune_key(const TuneOptions& options);
int tune_screen(const TuneOptions& options);

}  // namespace footfall::apps
