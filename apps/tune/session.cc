// A connection to an engine; see session.h.
#include "apps/tune/session.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "apps/tune/view/tables.h"
#include "core/index.h"
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
  if (options.open) return settings;
  try {
    settings.key = options.key.empty() ? engine::default_key() : engine::read_key(options.key);
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

std::unique_ptr<TuneSession> open_session(const TuneOptions& options) {
  std::unique_ptr<TuneSession> session;
  try {
    session = std::make_unique<TuneSession>(settings_of(options));
  } catch (const std::invalid_argument& error) {
    throw input_error(error.what());
  }
  if (!session->client.connect(options.timeout)) {
    fmt::print(stderr, "error: {}\n", session->client.why_not());
    return nullptr;
  }
  take_snapshot(*session);
  return session;
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
  return true;
}

}  // namespace footfall::apps
