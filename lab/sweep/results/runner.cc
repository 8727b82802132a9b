// Child processes of a sweep and their results; see runner.h.
#include "lab/sweep/results/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/text/printable.h"
#include "lab/process/result_line.h"
#include "lab/suite/suite.h"
#include "lab/sweep/plan/derived_files.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;

constexpr double kSweepTimeout = 60.0, kSweepTimeoutPerSecond = 3.0;
constexpr std::size_t kTail = 2000;  // bytes of stderr kept

// Collects every number in the object by its dotted path.
void flatten(const nlohmann::json& json, const std::string& name, SweepResult& result) {
  const auto put = [&](double value) {
    if (std::isfinite(value)) result.figures.emplace_back(name, value);
  };
  if (json.is_number()) put(json.get<double>());
  if (json.is_boolean()) put(json.get<bool>() ? 1.0 : 0.0);
  if (!json.is_structured()) return;
  for (const auto& [key, value] : json.items()) {
    if (name.empty() && key == "seed") continue;
    flatten(value, name.empty() ? key : name + "." + key, result);
  }
}

// Why a scenario did not pass: its first failure beside the expectations, else the first failed
// expectation.
std::string reason(const nlohmann::json& outcome) {
  const auto failures = outcome.find("failures");
  if (failures != outcome.end() && failures->is_array() && !failures->empty()) {
    return text_at(failures->front(), "text");
  }
  const auto list = outcome.find("expectations");
  if (list == outcome.end() || !list->is_array()) return "";
  for (const nlohmann::json& one : *list) {
    if (!one.is_object() || one.value("passed", true)) continue;
    return fmt::format("{}: {}", text_at(one, "text"), text_at(one, "why"));
  }
  return "";
}

bool read_output(const std::string& out, int exit_code, SweepResult& result) {
  const nlohmann::json json = result_line(out);
  if (!json.is_object() || !json.contains("end")) return false;
  result.end = text_at(json, "end");
  const bool scenario = json.contains("figures");
  flatten(scenario ? json["figures"] : json, "", result);
  result.status = exit_code == 0 ? SweepStatus::passed : SweepStatus::failed;
  result.why = scenario ? reason(json) : "";
  if (result.status == SweepStatus::failed && result.why.empty()) {
    result.why = "the run ended by " + result.end;
  }
  return true;
}

std::string tail_of(const std::string& err) {
  return core::printable_lines(err.size() > kTail ? err.substr(err.size() - kTail) : err);
}

class SweepSession {
 public:
  SweepSession(const SweepDescription& sweep, SweepStore& store, const SweepSettings& settings)
      : sweep_(sweep),
        store_(store),
        settings_(settings),
        files_(sweep, settings.folder, settings.worlds),
        ids_(store.pending()) {
    progress_.to_do = ids_.size();
    const std::vector<std::size_t> counts = store.counts();
    for (std::size_t k = 1; k < counts.size(); ++k) progress_.before += counts[k];
  }

  SweepProgress run() {
    const double base = sweep_.timeout > 0.0
                            ? sweep_.timeout
                            : kSweepTimeout + kSweepTimeoutPerSecond * sweep_.duration_s;
    std::vector<Command> commands;
    for (const std::size_t id : ids_) commands.push_back({child_command(id), base});
    start_ = std::chrono::steady_clock::now();
    tell();
    PoolSettings pool;
    pool.jobs = settings_.jobs;
    pool.stop = settings_.stop;
    pool.done = [this](std::size_t k, const ProcessResult& process) { done(ids_[k], process); };
    run_processes(commands, pool);
    if (progress_.done > 0) store_.make_view();
    return progress_;
  }

 private:
  std::vector<std::string> command_for(const std::string& program, std::size_t id) {
    const SweepRun run = run_of(sweep_, id);
    return command_of(program, sweep_, run, files_.target(run));
  }

  std::string log_folder(std::size_t id) const {
    return fmt::format("{}/run-{}", settings_.logs, id);
  }

  std::vector<std::string> child_command(std::size_t id) {
    std::vector<std::string> command = command_for(settings_.program, id);
    command.insert(command.end(), {"--json", "--quiet", "--no-report"});
    if (settings_.logs.empty()) {
      command.emplace_back("--no-log");
    } else {
      command.insert(command.end(), {"--log", log_folder(id)});
    }
    return command;
  }

  void done(std::size_t id, const ProcessResult& process) {
    if (process.end == ProcessEnd::not_started) {  // the others could not be started either
      throw std::runtime_error("'" + settings_.program + "' " + describe(process));
    }
    const SweepResult result = read_sweep_result(process);
    // Interrupted runs stay pending: a batch system's signal reaches parent and child at once.
    const bool stopping = settings_.stop != nullptr && settings_.stop->load();
    if (result.status == SweepStatus::pending || (stopping && result.end == "stopped")) return;
    store_.record(id, shell_line(command_for("footfall", id)), result);
    if (!settings_.logs.empty() && result.status == SweepStatus::passed) {
      std::error_code ignored;
      fs::remove_all(log_folder(id), ignored);
    }
    ++progress_.done;
    if (result.status == SweepStatus::failed) ++progress_.failed;
    if (result.status > SweepStatus::failed) ++progress_.broken;
    tell();
  }

  void tell() {
    progress_.elapsed =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const auto done = static_cast<double>(progress_.done);
    const auto left = static_cast<double>(progress_.to_do - progress_.done);
    progress_.left = done > 0.0 ? progress_.elapsed / done * left : 0.0;
    if (settings_.progress) settings_.progress(progress_);
  }

  const SweepDescription& sweep_;
  SweepStore& store_;
  const SweepSettings& settings_;
  SweepFiles files_;
  std::vector<std::size_t> ids_;
  SweepProgress progress_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace

SweepResult read_sweep_result(const ProcessResult& process) {
  SweepResult result;
  result.exit_code = process.exit_code;
  result.wall_time = process.wall_time;
  result.cpu_time = process.cpu_time;
  if (process.end == ProcessEnd::cancelled) return result;
  const int code = process.exit_code;
  if (process.end == ProcessEnd::exited && (code == 0 || code == 1)) {
    if (!read_output(process.out, code, result)) {
      result.status = SweepStatus::bad_output;
      result.why = "no result in its output";
    }
  } else {
    result.status = process.end == ProcessEnd::signalled             ? SweepStatus::crashed
                    : process.end == ProcessEnd::timed_out           ? SweepStatus::timed_out
                    : process.end == ProcessEnd::exited && code == 2 ? SweepStatus::bad_input
                                                                     : SweepStatus::machine;
    result.why = describe(process);
  }
  if (result.status != SweepStatus::passed) result.error_tail = tail_of(process.err);
  return result;
}

std::vector<std::size_t> shard_ids(std::size_t runs, int shard, int shards) {
  std::vector<std::size_t> ids;
  for (auto id = static_cast<std::size_t>(shard - 1); id < runs;
       id += static_cast<std::size_t>(shards)) {
    ids.push_back(id);
  }
  return ids;
}

SweepProgress run_sweep(const SweepDescription& sweep, SweepStore& store,
                        const SweepSettings& settings) {
  return SweepSession(sweep, store, settings).run();
}

}  // namespace footfall::lab
