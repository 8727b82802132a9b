// Creates, fills and resumes a result database; see store.h.
#include "lab/sweep/results/store.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/process/machine_error.h"
#include "core/text/json_text.h"
#include "lab/run/utc_time.h"
#include "lab/sweep/results/sqlite_statement.h"

namespace footfall::lab {
namespace {

constexpr std::array<const char*, 8> kStatusNames = {
    "pending", "passed", "failed", "crashed", "timed_out", "bad_input", "bad_output", "machine"};

constexpr const char* kTables = R"(
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE runs(run INTEGER PRIMARY KEY, key TEXT NOT NULL UNIQUE, id INTEGER UNIQUE,
  world TEXT, fault TEXT, seed INTEGER, status TEXT NOT NULL DEFAULT 'pending', end TEXT, why TEXT,
  error_tail TEXT, exit_code INTEGER, wall_s REAL, cpu_s REAL, command TEXT, program TEXT,
  version TEXT, host TEXT, finished TEXT);
CREATE TABLE parameters(run INTEGER NOT NULL REFERENCES runs, name TEXT NOT NULL,
  value TEXT NOT NULL, number REAL, PRIMARY KEY(run, name)) WITHOUT ROWID;
CREATE TABLE figures(run INTEGER NOT NULL REFERENCES runs, name TEXT NOT NULL, value REAL,
  PRIMARY KEY(run, name)) WITHOUT ROWID;
CREATE INDEX runs_by_status ON runs(status);
)";

void put_meta(sqlite3* db, const char* key, const std::string& value) {
  SqliteStatement(db, "INSERT OR REPLACE INTO meta VALUES(?, ?)").bind(key).bind(value).run();
}

std::string get_meta(sqlite3* db, const char* key) {
  SqliteStatement statement(db, "SELECT value FROM meta WHERE key = ?");
  statement.bind(key);
  return statement.step() ? statement.text(0) : std::string();
}

core::FileLock take_lock(const std::string& path) {
  try {
    core::FileLock lock(path + ".lock");
    if (lock.held()) return lock;
  } catch (const std::runtime_error& error) {
    throw SweepStoreError(error.what());
  }
  throw SweepStoreError("another sweep is writing to '" + path + "'");
}

void put_parameters(SqliteStatement& put, sqlite3_int64 row, const SweepDescription& sweep,
                    const SweepRun& run) {
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    const SweepValue& value = sweep.axes[a].values[run.values[a]];
    put.bind(row).bind(sweep.axes[a].name).bind(value.text);
    value.number ? put.bind(*value.number) : put.bind_null();
    put.run();
  }
}

// Adds rows for the plan's runs; existing rows get their position in the plan.
void put_runs(sqlite3* db, const SweepDescription& sweep, const std::vector<std::size_t>& ids) {
  SqliteStatement(db, "UPDATE runs SET id = NULL").run();
  SqliteStatement place(db, "UPDATE runs SET id = ? WHERE key = ?");
  SqliteStatement add(db, "INSERT INTO runs(key, id, world, fault, seed) VALUES(?, ?, ?, ?, ?)");
  SqliteStatement parameter(db, "INSERT INTO parameters VALUES(?, ?, ?, ?)");
  for (const std::size_t id : ids) {
    const SweepRun run = run_of(sweep, id);
    const std::string key = key_of(sweep, run);
    place.bind(static_cast<sqlite3_int64>(id)).bind(key).run();
    if (sqlite3_changes(db) > 0) continue;
    add.bind(key).bind(static_cast<sqlite3_int64>(id)).bind(world_of(sweep, run));
    add.bind(sweep.faults[run.fault].label).bind(static_cast<sqlite3_int64>(run.seed)).run();
    put_parameters(parameter, sqlite3_last_insert_rowid(db), sweep, run);
  }
  SqliteStatement(db,
                  "DELETE FROM parameters WHERE run IN "
                  "(SELECT run FROM runs WHERE id IS NULL AND status = 'pending')")
      .run();
  SqliteStatement(db, "DELETE FROM runs WHERE id IS NULL AND status = 'pending'").run();
}

void refuse_others(const SweepIdentity& have, const SweepIdentity& want, const std::string& path,
                   bool extend) {
  if (have.inputs != want.inputs) {
    throw SweepStoreError(
        fmt::format("'{}' has results of other files: the behavior, scenario, robot or world has "
                    "changed since; "
                    "give another --out for what it is now",
                    path));
  }
  if (have.shard != want.shard || have.shards != want.shards) {
    throw SweepStoreError(fmt::format("'{}' is shard {}/{}, not {}/{}", path, have.shard,
                                      have.shards, want.shard, want.shards));
  }
  if (have.plan != want.plan && !extend) {
    throw SweepStoreError(
        fmt::format("'{}' has results of another plan: give --extend to keep those that this plan "
                    "has, too, and add the rest, or another --out",
                    path));
  }
}

}  // namespace

const char* sweep_status_name(SweepStatus status) {
  return kStatusNames[static_cast<std::size_t>(status)];
}

SweepStatus sweep_status_of(const std::string& name) {
  for (std::size_t k = 0; k < kStatusNames.size(); ++k) {
    if (name == kStatusNames[k]) return static_cast<SweepStatus>(k);
  }
  return SweepStatus::pending;
}

std::string describe_sweep(const SweepDescription& sweep) {
  nlohmann::ordered_json json = {
      {"name", sweep.name},         {"doc", sweep.doc},     {"behavior", sweep.behavior},
      {"scenario", sweep.scenario}, {"robot", sweep.robot}, {"for", sweep.duration},
      {"worlds", sweep.worlds},     {"seeds", sweep.seeds}, {"figures", sweep.figures}};
  for (const SweepFault& fault : sweep.faults) json["faults"].push_back(fault.label);
  json["axes"] = nlohmann::ordered_json::array();
  for (const SweepAxis& axis : sweep.axes) {
    auto values = nlohmann::ordered_json::array();
    for (const SweepValue& value : axis.values) values.push_back(value.text);
    json["axes"].push_back({{"name", axis.name}, {"unit", axis.unit}, {"values", values}});
  }
  for (const SweepGroup& group : sweep.groups) json["groups"].push_back(group.axes);
  return core::json_text(json);
}

std::string store_path(const std::string& folder, int shard, int shards) {
  if (shards == 1) return folder + "/sweep.sqlite";
  return fmt::format("{}/shard-{}-of-{}.sqlite", folder, shard, shards);
}

SweepStore::SweepStore(const std::string& path, Access access)
    : path_(path), lock_(access == Access::write ? take_lock(path) : core::FileLock()) {
  const int flags = access == Access::write ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE
                                            : SQLITE_OPEN_READWRITE;  // to recover after a kill
  try {
    if (sqlite3_open_v2(path.c_str(), &db_, flags, nullptr) != SQLITE_OK) {
      throw SqliteError(sqlite3_errmsg(db_));
    }
    sqlite3_busy_timeout(db_, 10'000);  // ms; another program may be reading
    // A commit survives a kill of the program. A power failure may undo the last ones, whose runs
    // are then repeated; that is preferable to waiting for the disk after each run.
    if (access == Access::write) {
      execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;");
    }
    if (!empty() && get_meta(db_, "format") != "1") {
      throw SqliteError("made by a newer version of this program");
    }
  } catch (const SqliteError& error) {
    const std::string why = error.what();
    const int code = sqlite3_errcode(db_) & 0xff;  // without the extended part
    sqlite3_close(db_);
    const bool refused = code == SQLITE_CANTOPEN && access == Access::write;
    if (code == SQLITE_IOERR || code == SQLITE_FULL || refused) {
      throw core::MachineError(fmt::format("{}: {}", path, why));
    }
    throw SweepStoreError(fmt::format("'{}' is no file of results: {}", path, why));
  }
}

SweepStore::~SweepStore() { sqlite3_close(db_); }

void SweepStore::execute(const std::string& sql) const {
  if (sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw SqliteError(sqlite3_errmsg(db_));
  }
}

void SweepStore::make_tables() const { execute(kTables); }

bool SweepStore::empty() const {
  SqliteStatement statement(db_, "SELECT count(*) FROM sqlite_master WHERE name = 'meta'");
  statement.step();
  return statement.integer(0) == 0;
}

SweepIdentity SweepStore::identity() const {
  SweepIdentity id;
  id.plan = get_meta(db_, "plan");
  id.inputs = get_meta(db_, "inputs");
  id.program = get_meta(db_, "program");
  id.version = get_meta(db_, "version");
  id.description = get_meta(db_, "description");
  const auto number = [this](const char* key) {
    const std::string text = get_meta(db_, key);
    return text.empty() ? 0 : std::atoi(text.c_str());
  };
  id.runs = static_cast<std::size_t>(number("runs"));
  id.shard = number("shard"), id.shards = number("shards");
  return id;
}

void SweepStore::begin(const SweepDescription& sweep, const SweepIdentity& identity,
                       const std::vector<std::size_t>& ids, bool extend) {
  SqliteTransaction transaction(db_);
  const bool fresh = empty();
  if (fresh) {
    make_tables();
    put_meta(db_, "format", "1");
    put_meta(db_, "created", utc_now());
    put_meta(db_, "shard", std::to_string(identity.shard));
    put_meta(db_, "shards", std::to_string(identity.shards));
  } else {
    refuse_others(this->identity(), identity, path_, extend);
  }
  const bool same_plan = !fresh && get_meta(db_, "plan") == identity.plan;
  put_meta(db_, "plan", identity.plan);
  put_meta(db_, "inputs", identity.inputs);
  put_meta(db_, "program", identity.program);
  put_meta(db_, "version", identity.version);
  put_meta(db_, "host", identity.host);
  put_meta(db_, "description", identity.description);
  put_meta(db_, "runs", std::to_string(identity.runs));
  if (!same_plan) put_runs(db_, sweep, ids);
  transaction.commit();
}

std::vector<std::size_t> SweepStore::pending() const {
  std::vector<std::size_t> ids;
  SqliteStatement statement(
      db_, "SELECT id FROM runs WHERE status = 'pending' AND id IS NOT NULL ORDER BY id");
  while (statement.step()) ids.push_back(static_cast<std::size_t>(statement.integer(0)));
  return ids;
}

void SweepStore::record(std::size_t id, const std::string& command, const SweepResult& result) {
  SqliteTransaction transaction(db_);
  SqliteStatement update(
      db_,
      "UPDATE runs SET status = ?, end = ?, why = ?, error_tail = ?, exit_code = ?, wall_s = ?, "
      "cpu_s = ?, command = ?, program = (SELECT value FROM meta WHERE key = 'program'), "
      "version = (SELECT value FROM meta WHERE key = 'version'), "
      "host = (SELECT value FROM meta WHERE key = 'host'), finished = ? "
      "WHERE id = ? AND status = 'pending'");
  update.bind(sweep_status_name(result.status)).bind(result.end).bind(result.why);
  update.bind(result.error_tail).bind(static_cast<sqlite3_int64>(result.exit_code));
  update.bind(result.wall_time).bind(result.cpu_time).bind(command).bind(utc_now());
  update.bind(static_cast<sqlite3_int64>(id)).run();
  if (sqlite3_changes(db_) != 1) throw SweepStoreError(fmt::format("run {} was done already", id));
  SqliteStatement put(db_,
                      "INSERT OR REPLACE INTO figures SELECT run, ?, ? FROM runs WHERE id = ?");
  for (const auto& [name, value] : result.figures) {
    put.bind(name).bind(value).bind(static_cast<sqlite3_int64>(id)).run();
  }
  transaction.commit();
}

std::vector<std::size_t> SweepStore::counts() const {
  std::vector<std::size_t> counts(kStatusNames.size());
  SqliteStatement statement(
      db_, "SELECT status, count(*) FROM runs WHERE id IS NOT NULL GROUP BY status");
  while (statement.step()) {
    counts[static_cast<std::size_t>(sweep_status_of(statement.text(0)))] +=
        static_cast<std::size_t>(statement.integer(1));
  }
  return counts;
}

}  // namespace footfall::lab
