// The results of a sweep in SQLite: one file, one row a run, written in one transaction a run, so
// that whatever kills the program loses no run that was done. docs/sweeps.md has the tables.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lab/sweep/plan/sweep.h"

struct sqlite3;

namespace footfall::lab {

// What became of a run. The first two are of the robot, the others of the program or its input.
enum class SweepStatus : std::uint8_t {
  pending,  // not run yet, or not to its end
  passed,
  failed,  // the robot fell, a fault stopped it, an expectation did not hold
  crashed,
  timed_out,
  bad_input,
  bad_output,
  machine,
};
const char* sweep_status_name(SweepStatus status);
SweepStatus sweep_status_of(const std::string& name);  // pending for any other word

struct SweepResult {
  SweepStatus status = SweepStatus::pending;
  std::string end;         // of the run, by its own words: "time", "fall", ...
  std::string why;         // of a failure, a sentence; may be empty
  std::string error_tail;  // last lines of stderr of what did not pass
  int exit_code = -1;
  double wall_time = 0.0, cpu_time = 0.0;               // s
  std::vector<std::pair<std::string, double>> figures;  // "error.pitch.max", SI
};

// A file that is no sweep's, of another plan, or cannot be written: for people.
struct SweepStoreError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// What a file of results is of.
struct SweepIdentity {
  std::string plan, inputs, program;  // digests: of the plan, of the files that run, of footfall
  std::string version, host;
  std::string description;  // JSON: see describe_sweep
  std::size_t runs = 0;     // of the whole sweep, all shards
  int shard = 1, shards = 1;
};
std::string describe_sweep(const SweepDescription& sweep);

// One row, as reports want it.
struct SweepRow {
  std::size_t id = 0;
  std::string world, fault;
  std::uint64_t seed = 0;
  std::string command;
  SweepResult result;  // figures are below
  std::map<std::string, double> figures;
  std::map<std::string, std::string> values;  // of axes, as written
};

struct SweepTable {
  SweepIdentity identity;
  std::vector<SweepRow> rows;  // by id
};

class SweepStore {
 public:
  // Opens or makes the file; one writer at a time, readers beside it. Throws SweepStoreError.
  enum class Access : std::uint8_t { write, read };
  explicit SweepStore(const std::string& path, Access access = Access::write);
  ~SweepStore();
  SweepStore(const SweepStore&) = delete;
  SweepStore& operator=(const SweepStore&) = delete;

  bool empty() const;  // no plan yet
  SweepIdentity identity() const;

  // Adds what the sweep has and the file has not: `ids` are the runs of this shard, `commands` one
  // for each. Runs that are done stay as they are. extend: runs of an earlier plan stay too, those
  // of them that are not in this one outside of it. Throws SweepStoreError if the plan or the files
  // that run are others and `extend` is false.
  void begin(const SweepDescription& sweep, const SweepIdentity& identity,
             const std::vector<std::size_t>& ids, bool extend);
  // Ids of the runs that are to be done, in their order.
  std::vector<std::size_t> pending() const;
  // One transaction.
  void record(std::size_t id, const std::string& command, const SweepResult& result);
  // How many runs of the plan have each status, by SweepStatus.
  std::vector<std::size_t> counts() const;

  SweepTable read() const;
  // All rows of another file of the same plan. Throws SweepStoreError.
  void merge(const std::string& path);
  // Makes the view `results`: a column for each parameter and figure.
  void make_view() const;

 private:
  void execute(const std::string& sql) const;
  void make_tables() const;
  void close();

  std::string path_;
  int lock_ = -1;
  sqlite3* db_ = nullptr;
};

// Folds DIR/shard-*.sqlite (and what DIR/sweep.sqlite has) into DIR/sweep.sqlite; returns its path.
// Throws SweepStoreError.
std::string merge_shards(const std::string& folder);
// DIR/sweep.sqlite, or of a shard DIR/shard-2-of-4.sqlite.
std::string store_path(const std::string& folder, int shard, int shards);
// One line a run, a column for each parameter and figure; SI.
std::string sweep_csv(const SweepTable& table);

}  // namespace footfall::lab
