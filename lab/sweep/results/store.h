// The results of a sweep in an SQLite file with one row and one transaction a run, so that a kill
// loses no completed run. docs/sweeps.md describes the tables.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/process/file_lock.h"
#include "lab/sweep/plan/sweep.h"

struct sqlite3;

namespace footfall::lab {

// Outcome of a run. `passed` and `failed` are results of the robot, the others of the program or
// its input.
enum class SweepStatus : std::uint8_t {
  pending,  // not run, or interrupted
  passed,
  failed,  // fall, stop by a fault, or failed expectation
  crashed,
  timed_out,
  bad_input,
  bad_output,
  machine,
};
const char* sweep_status_name(SweepStatus status);
SweepStatus sweep_status_of(const std::string& name);  // pending for unknown words

struct SweepResult {
  SweepStatus status = SweepStatus::pending;
  std::string end;         // reason for the end of the run, as reported by it: "time", "fall", ...
  std::string why;         // reason for a failure, a sentence; may be empty
  std::string error_tail;  // last lines of stderr, for runs that did not pass
  int exit_code = -1;
  double wall_time = 0.0, cpu_time = 0.0;               // s
  std::vector<std::pair<std::string, double>> figures;  // "error.pitch.max", SI
};

// The file is not a result database, belongs to another plan, or cannot be written. Its text is the
// user's message.
struct SweepStoreError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Identity of a result database.
struct SweepIdentity {
  std::string plan, inputs, program;  // digests: of the plan, of the input files, of footfall
  std::string version, host;
  std::string description;  // JSON: see describe_sweep
  std::size_t runs = 0;     // number of runs in the whole sweep, all shards
  int shard = 1, shards = 1;
};
std::string describe_sweep(const SweepDescription& sweep);

// One row, as used by reports.
struct SweepRow {
  std::size_t id = 0;
  std::string world, fault;
  std::uint64_t seed = 0;
  std::string command;
  SweepResult result;  // without figures, which are below
  std::map<std::string, double> figures;
  std::map<std::string, std::string> values;  // axis values, as written
};

struct SweepTable {
  SweepIdentity identity;
  std::vector<SweepRow> rows;  // sorted by id
};

class SweepStore {
 public:
  // Opens or creates the file; one writer at a time, concurrent readers. Throws SweepStoreError.
  enum class Access : std::uint8_t { write, read };
  explicit SweepStore(const std::string& path, Access access = Access::write);
  ~SweepStore();
  SweepStore(const SweepStore&) = delete;
  SweepStore& operator=(const SweepStore&) = delete;

  bool empty() const;  // contains no plan yet
  SweepIdentity identity() const;

  // Adds missing runs of the sweep: `ids` are the runs of this shard, `commands` one for each.
  // Completed runs are kept. extend: runs of an earlier plan are kept, too; those that are not in
  // the new plan are marked as outside of it. Throws SweepStoreError if plan or input files differ
  // and `extend` is false.
  void begin(const SweepDescription& sweep, const SweepIdentity& identity,
             const std::vector<std::size_t>& ids, bool extend);
  // Ids of the pending runs, in order.
  std::vector<std::size_t> pending() const;
  // Stores a result in one transaction.
  void record(std::size_t id, const std::string& command, const SweepResult& result);
  // Number of the plan's runs by SweepStatus.
  std::vector<std::size_t> counts() const;

  SweepTable read() const;
  // Adds all rows of another file of the same plan. Throws SweepStoreError.
  void merge(const std::string& path);
  // Creates the view `results`: a column for each parameter and figure.
  void make_view() const;

 private:
  void execute(const std::string& sql) const;
  void make_tables() const;

  std::string path_;
  core::FileLock lock_;  // released after the database was closed
  sqlite3* db_ = nullptr;
};

// Merges DIR/shard-*.sqlite (and an existing DIR/sweep.sqlite) into DIR/sweep.sqlite; returns its
// path. Throws SweepStoreError.
std::string merge_shards(const std::string& folder);
// DIR/sweep.sqlite, or for a shard DIR/shard-2-of-4.sqlite.
std::string store_path(const std::string& folder, int shard, int shards);
// CSV with one line a run, a column for each parameter and figure; SI.
std::string sweep_csv(const SweepTable& table);

}  // namespace footfall::lab
