// Reads, merges and prints result databases; see store.h.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "lab/sweep/results/sqlite_statement.h"
#include "lab/sweep/results/store.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;

// The shard files of a folder, sorted by name.
std::vector<std::string> shard_files(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("shard-") && name.ends_with(".sqlite")) {
      files.push_back(entry.path().string());
    }
  }
  std::ranges::sort(files);
  return files;
}

std::string quoted(std::string name) {
  for (std::size_t at = name.find('"'); at != std::string::npos; at = name.find('"', at + 2)) {
    name.insert(at, 1, '"');
  }
  return '"' + name + '"';
}

std::string literal(std::string text) {
  for (std::size_t at = text.find('\''); at != std::string::npos; at = text.find('\'', at + 2)) {
    text.insert(at, 1, '\'');
  }
  return "'" + text + "'";
}

std::set<std::string> names_in(sqlite3* db, const char* table) {
  std::set<std::string> names;
  SqliteStatement statement(db, fmt::format("SELECT DISTINCT name FROM {}", table));
  while (statement.step()) names.insert(statement.text(0));
  return names;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

void SweepStore::make_view() const {
  std::string sql =
      "CREATE VIEW results AS SELECT r.id, r.world, r.fault, r.seed, r.status, r.end, r.wall_s";
  const auto add = [&sql](const std::set<std::string>& names, const char* table) {
    // SQLite allows 2000 columns.
    std::size_t left = 900;
    for (const std::string& name : names) {
      if (left-- == 0) break;
      sql += fmt::format(", (SELECT x.value FROM {} x WHERE x.run = r.run AND x.name = {}) AS {}",
                         table, literal(name), quoted(name));
    }
  };
  add(names_in(db_, "parameters"), "parameters");
  add(names_in(db_, "figures"), "figures");
  SqliteTransaction transaction(db_);
  SqliteStatement(db_, "DROP VIEW IF EXISTS results").run();
  SqliteStatement(db_, sql + " FROM runs r WHERE r.id IS NOT NULL").run();
  transaction.commit();
}

SweepTable SweepStore::read() const {
  SweepTable table;
  table.identity = identity();
  std::map<sqlite3_int64, std::size_t> place;
  SqliteStatement runs(db_,
                       "SELECT run, id, world, fault, seed, command, status, end, why, error_tail, "
                       "exit_code, wall_s, cpu_s FROM runs WHERE id IS NOT NULL ORDER BY id");
  while (runs.step()) {
    place[runs.integer(0)] = table.rows.size();
    SweepRow row;
    row.id = static_cast<std::size_t>(runs.integer(1));
    row.world = runs.text(2), row.fault = runs.text(3);
    row.seed = static_cast<std::uint64_t>(runs.integer(4));
    row.command = runs.text(5);
    row.result.status = sweep_status_of(runs.text(6));
    row.result.end = runs.text(7), row.result.why = runs.text(8);
    row.result.error_tail = runs.text(9);
    row.result.exit_code = static_cast<int>(runs.integer(10));
    row.result.wall_time = runs.number(11), row.result.cpu_time = runs.number(12);
    table.rows.push_back(std::move(row));
  }
  SqliteStatement parameters(db_, "SELECT run, name, value FROM parameters");
  while (parameters.step()) {
    const auto at = place.find(parameters.integer(0));
    if (at != place.end()) table.rows[at->second].values[parameters.text(1)] = parameters.text(2);
  }
  SqliteStatement figures(db_, "SELECT run, name, value FROM figures");
  while (figures.step()) {
    const auto at = place.find(figures.integer(0));
    if (at != place.end()) table.rows[at->second].figures[figures.text(1)] = figures.number(2);
  }
  return table;
}

void SweepStore::merge(const std::string& path) {
  SqliteStatement(db_, "ATTACH ? AS part").bind(path).run();
  const auto meta = [this](const char* schema, const char* key) {
    SqliteStatement statement(db_, fmt::format("SELECT value FROM {}.meta WHERE key = ?", schema));
    statement.bind(key);
    return statement.step() ? statement.text(0) : std::string();
  };
  {
    SqliteTransaction transaction(db_);
    if (empty()) {
      make_tables();
      execute(
          "INSERT INTO meta SELECT key, value FROM part.meta WHERE key NOT IN ('shard', "
          "'shards'); INSERT INTO meta VALUES('shard', '1'), ('shards', '1');");
    }
    for (const char* key : {"plan", "inputs"}) {
      if (meta("main", key) == meta("part", key)) continue;
      throw SweepStoreError(fmt::format("'{}' is of another {} than the shards before it", path,
                                        std::string(key) == "plan" ? "plan" : "behavior"));
    }
    execute(
        "DELETE FROM figures WHERE run IN (SELECT run FROM runs WHERE status = 'pending');"
        "DELETE FROM parameters WHERE run IN (SELECT m.run FROM runs m JOIN part.runs p ON "
        "p.key = m.key WHERE m.status = 'pending');"
        "DELETE FROM runs WHERE status = 'pending' AND key IN (SELECT key FROM part.runs);"
        "INSERT INTO runs SELECT NULL, key, id, world, fault, seed, status, end, why, error_tail, "
        "exit_code, wall_s, cpu_s, command, program, version, host, finished FROM part.runs p "
        "WHERE p.key NOT IN (SELECT key FROM runs);"
        "INSERT OR IGNORE INTO parameters SELECT m.run, p.name, p.value, p.number FROM "
        "part.parameters p JOIN part.runs r ON r.run = p.run JOIN runs m ON m.key = r.key;"
        "INSERT OR IGNORE INTO figures SELECT m.run, f.name, f.value FROM part.figures f "
        "JOIN part.runs r ON r.run = f.run JOIN runs m ON m.key = r.key;");
    transaction.commit();
  }
  SqliteStatement(db_, "DETACH part").run();
  make_view();
}

std::string merge_shards(const std::string& folder) {
  const std::vector<std::string> shards = shard_files(folder);
  const std::string target = store_path(folder, 1, 1);
  std::error_code ignored;
  if (shards.empty() && !fs::exists(target, ignored)) {
    throw SweepStoreError("'" + folder + "' has no shard-*.sqlite and no sweep.sqlite");
  }
  SweepStore store(target);
  for (const std::string& shard : shards) store.merge(shard);
  return target;
}

std::string sweep_csv(const SweepTable& table) {
  std::set<std::string> values, figures;
  for (const SweepRow& row : table.rows) {
    for (const auto& [name, text] : row.values) values.insert(name);
    for (const auto& [name, number] : row.figures) figures.insert(name);
  }
  std::string out = "id,world,fault,seed,status,end,wall_s";
  for (const std::string& name : values) out += "," + csv_cell(name);
  for (const std::string& name : figures) out += "," + csv_cell(name);
  out += "\n";
  for (const SweepRow& row : table.rows) {
    out += fmt::format("{},{},{},{},{},{},{:.3f}", row.id, csv_cell(row.world), csv_cell(row.fault),
                       row.seed, sweep_status_name(row.result.status), csv_cell(row.result.end),
                       row.result.wall_time);
    for (const std::string& name : values) {
      const auto at = row.values.find(name);
      out += "," + (at == row.values.end() ? std::string() : csv_cell(at->second));
    }
    for (const std::string& name : figures) {
      const auto at = row.figures.find(name);
      out += at == row.figures.end() ? std::string(",") : fmt::format(",{:.9g}", at->second);
    }
    out += "\n";
  }
  return out;
}

}  // namespace footfall::lab
