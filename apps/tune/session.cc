// A connection to an engine; see session.h.
#include "apps/tune/session.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "apps/shared/live_options.h"
#include "apps/tune/view/tables.h"
#include "core/index.h"
#include "core/process/machine_error.h"
#include "core/text/json_text.h"
#include "core/text/printable.h"

namespace footfall::apps {
namespace {

InputError input_error(const std::string& sentence) {
  return InputError(fmt::format("error: {}\n", sentence));
}

engine::LiveClientSettings settings_of(const TuneOptions& options) {
  engine::LiveClientSettings settings;
  settings.url = options.url;
  settings.prefix = options.prefix;
  settings.who = options.who;
  settings.session = options.session;
  if (options.open) return settings;
  try {
    settings.key = options.key.empty() ? engine::default_key() : engine::read_key(options.key);
  } catch (const core::MachineError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw input_error(error.what());
  }
  return settings;
}

void take_snapshot(TuneSession& session) {
  take_catalogue(session.model, session.client.catalogue());
  take_values(session.model, session.client.values());
}

}  // namespace

namespace {

std::unique_ptr<TuneSession> make_session(const TuneOptions& options) {
  try {
    return std::make_unique<TuneSession>(settings_of(options));
  } catch (const std::invalid_argument& error) {
    throw input_error(error.what());
  }
}

std::string several_text(const std::vector<engine::EngineIdentity>& engines) {
  std::string text =
      fmt::format("error: {} engines are here: choose one with --session N\n", engines.size());
  for (const engine::EngineIdentity& engine : engines) {
    text += fmt::format("  --session {}: {}\n", engine::session_number(engine.session),
                        engine_text(engine));
  }
  return text;
}

nlohmann::ordered_json engine_json(const engine::EngineIdentity& engine) {
  return {{"session", engine::session_number(engine.session)},
          {"behavior", engine.behavior},
          {"robot", engine.robot},
          {"host", engine.host},
          {"pid", engine.pid},
          {"start", static_cast<double>(engine.start) * 1e-6},
          {"usable", engine.usable}};
}

}  // namespace

std::unique_ptr<TuneSession> open_session(const TuneOptions& options, bool silent) {
  std::unique_ptr<TuneSession> session = make_session(options);
  if (!session->client.connect(options.timeout)) {
    fmt::print(stderr, "error: {}\n", session->client.why_not());
    return nullptr;
  }
  const auto engines = session->client.engines();
  if (options.session == 0 && engines.size() > 1) throw SeveralEngines(several_text(engines));
  take_snapshot(*session);
  if (!silent) tell_session(session->model.catalogue);
  return session;
}

void tell_session(const footfall_lcm::catalogue_t& catalogue) {
  fmt::print(stderr, "session {}: {}, pid {} on {}\n", engine::session_number(catalogue.session),
             core::on_one_line(catalogue.behavior), catalogue.pid,
             core::on_one_line(catalogue.host));
}

int tune_list_engines(const TuneOptions& options) {
  constexpr double kLook = 0.5;  // s
  const std::unique_ptr<TuneSession> session = make_session(options);
  const auto engines = session->client.look(std::min(kLook, options.timeout));
  nlohmann::ordered_json json = {{"engines", nlohmann::ordered_json::array()}};
  for (const engine::EngineIdentity& engine : engines)
    json["engines"].push_back(engine_json(engine));
  if (options.json) {
    fmt::print("{}\n", core::json_text(json));
  } else {
    for (const auto& engine : engines) fmt::print("{}\n", engine_text(engine));
  }
  const bool other = session->client.other_version();
  if (engines.empty() || other) {
    fmt::print(
        stderr, "{}: {}\n", engines.empty() ? "error" : "note",
        engines.empty() ? session->client.why_not() : "an engine of another version is here, too");
  }
  return engines.empty() ? kMachineFailed : kGood;
}

std::vector<footfall_lcm::answer_t> take_messages(TuneSession& session, double seconds) {
  session.client.poll(seconds);
  take_snapshot(session);
  for (const footfall_lcm::telemetry_t& told : session.client.take_telemetry()) {
    take_telemetry(session.model, told);
  }
  std::vector<footfall_lcm::answer_t> answers = session.client.take_answers();
  for (const footfall_lcm::answer_t& answer : answers) {
    take_answer(session.model, answer, session.client.client());
  }
  return answers;
}

int send_and_explain(TuneSession& session, const footfall_lcm::request_t& request,
                     const TuneOptions& options) {
  const auto answer = session.client.ask(request, options.timeout);
  if (!answer) {
    fmt::print(stderr,
               "error: no answer within {:g} s ({}); whether it was done is not known, `footfall "
               "tune list` shows it\n",
               options.timeout, session.client.why_not());
    return kMachineFailed;
  }
  if (options.json) {
    fmt::print("{}\n", core::json_text(answer_json(*answer)));
  } else if (answer->accepted != 0) {
    fmt::print("{}\n", answer_text(*answer));
  }
  for (const std::string& reason : answer->reasons) {
    fmt::print(stderr, "refused: {}\n", core::on_one_line(reason));
  }
  return answer->accepted != 0 ? kGood : kRobotFailed;
}

namespace {

// us since 1970. Not the time of the content, which a file that is moved here brings along.
std::int64_t newest_change(const std::vector<std::string>& files) {
  std::int64_t newest = 0;
  for (const std::string& file : files) {
    struct stat facts {};
    if (::stat(file.c_str(), &facts) != 0) continue;
    newest = std::max(
        newest, std::int64_t{facts.st_ctim.tv_sec} * 1'000'000 + facts.st_ctim.tv_nsec / 1000);
  }
  return newest;
}

}  // namespace

bool read_file_values(TuneModel& model) {
  core::Diagnostics diagnostics;
  behaviors::LoadOptions options;
  options.search = search_path();
  const auto behavior = behaviors::load_behavior(model.catalogue.path, options, diagnostics);
  if (behavior == nullptr || diagnostics.has_errors()) return false;
  std::vector<double> values = model.file_values;
  for (const TuneParameter& parameter : model.parameters) {
    const int index = behavior->find_parameter(parameter.name);
    if (index < 0) continue;
    const behaviors::ParameterInfo& info = behavior->parameters[at(index)];
    for (int k = 0; k < std::min(info.size, parameter.size); ++k) {
      values[at(parameter.first + k)] = behavior->values[at(info.slot + k)];
    }
  }
  take_file_values(model, std::move(values));
  model.files_changed = newest_change(behavior->files);
  return true;
}

}  // namespace footfall::apps
