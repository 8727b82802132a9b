// Loading and checking beside the run; see reload_candidate.h.
#include "lab/run/reload_candidate.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "behaviors/check/physics/check.h"
#include "behaviors/loader.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;

constexpr int kMostAttempts = 10;

// As `footfall check` does.
std::shared_ptr<const behaviors::Behavior> load_checked(const std::string& path,
                                                        const behaviors::LoadOptions& options,
                                                        const behaviors::PhysicsWorld& world,
                                                        core::Diagnostics& diagnostics) {
  behaviors::LoadOptions with = options;
  with.check = behaviors::physics_check(world);
  return behaviors::load_behavior(path, with, diagnostics);
}

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A file that is saved again while it is read is read again: half of it is nobody's mistake.
std::shared_ptr<const behaviors::Behavior> load_settled(const std::string& path,
                                                        const behaviors::LoadOptions& options,
                                                        const behaviors::PhysicsWorld& world,
                                                        core::Diagnostics& diagnostics) {
  for (int attempt = 1;; ++attempt) {
    core::Diagnostics found;
    const std::string before = text_of(path);
    auto behavior = load_checked(path, options, world, found);
    if (attempt < kMostAttempts && text_of(path) != before) continue;
    diagnostics = std::move(found);
    return behavior;
  }
}

// The first file of the robot that is not as it was.
std::string changed_file(const FileDigests& before, const FileDigests& now) {
  for (const auto& [path, digest] : now) {
    const auto found = before.find(path);
    if (found == before.end() || found->second != digest) return path;
  }
  return "";
}

}  // namespace

RunOutputs::~RunOutputs() {
  try {
    close();
  } catch (const std::exception&) {
    // Errors are only reported by an explicit close().
  }
}

void RunOutputs::open(const std::string& path, const core::SignalTable& signals,
                      const engine::LogHeader& header) {
  fs::create_directories(fs::path(path).parent_path());
  writer_ = std::make_unique<engine::LogWriter>(path + ".part", signals, header);
  path_ = path;
}

void RunOutputs::name() {
  if (path_.empty() || named_ || !used) return;
  named_ = true;
  std::error_code gone;  // the log goes on under the name that it has
  fs::rename(path_ + ".part", path_, gone);
}

void RunOutputs::close() {
  if (writer_ == nullptr) return;
  name();
  const std::unique_ptr<engine::LogWriter> writer = std::move(writer_);
  if (used) {
    writer->close();
    return;
  }
  std::error_code ignored;
  fs::remove(path_ + ".part", ignored);
  fs::remove(fs::path(path_).parent_path(), ignored);  // unless it contains other files
}

std::string reload_log(const std::string& folder, int number) {
  return fmt::format("{}/reload-{}/log.mcap", folder, number);
}

std::unique_ptr<RunOutputs> open_outputs(ReloadCandidate& stage, const LogContinuation& continues,
                                         const ReloadSetup& setup) {
  auto outputs = std::make_unique<RunOutputs>();
  if (!setup.folder.empty()) {
    engine::LogHeader header = stage.header;
    header.setup = setup_text(stage.header.setup, continues);
    try {
      outputs->open(reload_log(setup.folder, continues.number), stage.behavior->signals, header);
    } catch (const std::exception& problem) {
      if (setup.tell) {
        setup.tell(fmt::format("the run would go on without a log: {}", problem.what()));
      }
    }
  }
  outputs->log = std::make_unique<RunLog>(*stage.loop, outputs->writer(), setup.said);
  if (setup.live != nullptr) outputs->live = setup.live->prepare(*stage.loop);
  return outputs;
}

FileDigests robot_files(const behaviors::Behavior& behavior) {
  FileDigests digests;
  behaviors::Behavior robot_alone;
  robot_alone.robot.path = behavior.robot.path;
  robot_alone.robot.model_path = behavior.robot.model_path;
  for (const engine::LogFile& file : source_files(robot_alone, "")) {
    digests[file.path] = std::hash<std::string>{}(file.content);
  }
  return digests;
}

ReloadCandidate prepare_reload(const std::string& path,
                               std::shared_ptr<const behaviors::Behavior> from,
                               const FileDigests& robot, const ReloadSetup& setup) {
  ReloadCandidate candidate;
  candidate.path = path;
  core::Diagnostics diagnostics;
  candidate.behavior = load_settled(path, setup.load, setup.world, diagnostics);
  for (int k = 0; k < diagnostics.file_count(); ++k) candidate.files.push_back(diagnostics.file(k));
  if (setup.print && !diagnostics.all().empty()) setup.print(diagnostics);
  if (diagnostics.has_errors() || candidate.behavior == nullptr) {
    candidate.reasons.push_back(fmt::format("it has {} error{}", diagnostics.error_count(),
                                            diagnostics.error_count() == 1 ? "" : "s"));
    return candidate;
  }
  const behaviors::Behavior& behavior = *candidate.behavior;
  for (const behaviors::ScriptFile& script : behavior.scripts)
    candidate.files.push_back(script.path);
  aim_reload(candidate, std::move(from));
  const std::string changed = changed_file(robot, robot_files(behavior));
  if (candidate.reasons.empty() && !changed.empty()) {
    candidate.reasons.push_back(fmt::format(
        "the robot's '{}' has changed: a reload changes the behavior alone, start anew for this",
        changed));
  }
  if (!candidate.reasons.empty()) return candidate;
  try {
    candidate.own =
        std::make_unique<engine::ControlLoop>(behavior, *setup.hardware, setup.source.settings);
    candidate.loop = candidate.own.get();
  } catch (const std::exception& error) {
    candidate.reasons.emplace_back(error.what());
    return candidate;
  }
  if (!setup.folder.empty()) candidate.header = make_log_header(behavior, setup.source);
  return candidate;
}

void aim_reload(ReloadCandidate& candidate, std::shared_ptr<const behaviors::Behavior> from) {
  candidate.there = behaviors::map_take_over(*from, *candidate.behavior);
  candidate.back = behaviors::map_take_over(*candidate.behavior, *from);
  candidate.reasons =
      behaviors::reasons_against_take_over(*from, *candidate.behavior, candidate.there);
  candidate.from = std::move(from);
}

}  // namespace footfall::lab
