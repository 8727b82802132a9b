// `footfall identify`: series-elastic actuators from the log of an excitation.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "apps/shared/log_argument.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/text/json_text.h"
#include "core/yaml/glob.h"
#include "lab/identify/logged.h"

namespace footfall::apps {
namespace {

using lab::Estimate;
using lab::Richness;

struct IdentifyArguments {
  std::string log;
  std::vector<std::string> joints;
  bool json = false;
};

bool has_numbers(Richness richness) {
  return richness == Richness::good || richness == Richness::poor;
}

// One sentence.
std::string verdict(const lab::ActuatorEstimate& found) {
  switch (found.richness) {
    case Richness::good:
      return "rich enough";
    case Richness::poor:
      return fmt::format(
          "NOT RICH ENOUGH: condition number {:.0f}, expected {:.0f} or less; the parameters' "
          "effects resemble each other",
          found.condition, lab::kLargestCondition);
    case Richness::too_slow:
      return fmt::format(
          "NOT IDENTIFIED: the motor moves in one direction for long enough during {:.2f} s only",
          found.used);
    case Richness::absurd:
      return "NOT IDENTIFIED: a parameter is negative; the log does not fit the model of a motor "
             "on a spring, or its encoders are too coarse";
    case Richness::still:
      return fmt::format("NOT IDENTIFIED: the motor did not move (by {:.2g} rad)", found.travel);
  }
  return {};
}

// Digits after the point with which an error has two significant ones.
int digits_for(double error) {
  if (!(error > 0.0)) return 6;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 9);
}

// `nominal`: of the robot file; 0: it has none.
std::string line_of(const char* name, const Estimate& found, const char* unit, double nominal) {
  const int digits = digits_for(found.error);
  std::string line = fmt::format("  {:<9} {:>12.{}f} ± {:.{}f} {}", name, found.value, digits,
                                 found.error, digits, unit);
  if (nominal > 0.0) {
    line += fmt::format("  (robot file {:g}: {:+.2f} %)", nominal,
                        100.0 * (found.value / nominal - 1.0));
  }
  return line + "\n";
}

std::string text_of(const lab::LoggedActuator& logged, const lab::IdentifiedActuator& found) {
  const lab::ActuatorEstimate& a = found.actuator;
  std::string text = fmt::format("{}: {}\n", logged.joint, verdict(a));
  if (!has_numbers(a.richness)) return text;
  text += line_of("spring", a.spring, "Nm/rad", logged.spring);
  text += line_of("rotor", a.rotor, "kg m^2", logged.rotor);
  text += line_of("viscous", a.viscous, "Nm s/rad", 0.0);
  text += line_of("coulomb", a.coulomb, "Nm", 0.0);
  text += line_of("offset", a.offset, "Nm", 0.0);
  if (found.no_delay.empty()) {
    const double ms = 1e3;
    const Estimate delay{ms * found.delay.delay.value, ms * found.delay.delay.error};
    text += line_of("delay", delay, "ms", 0.0);
    text.insert(text.size() - 1, fmt::format("  ({:.3f} ticks; the loop's law explains {:.1f} %)",
                                             found.delay.delay.value / logged.record.period,
                                             100.0 * found.delay.explained));
  } else {
    text += fmt::format(
        "  delay     not known: {}; without it the values above may be wrong by 1 % more than "
        "their errors\n",
        found.no_delay);
  }
  return text + fmt::format(
                    "  {} equations from {:.2f} s, condition {:.1f}, residual {:.2g} Nm rms, motor "
                    "moved by {:.3g} rad\n",
                    a.equations, a.used, a.condition, a.residual, a.travel);
}

nlohmann::ordered_json json_of(const Estimate& found, double nominal = 0.0) {
  nlohmann::ordered_json out = {{"value", found.value}, {"error", found.error}};
  if (nominal > 0.0) {
    out["nominal"] = nominal;
    out["difference"] = found.value / nominal - 1.0;
  }
  return out;
}

nlohmann::ordered_json json_of(const lab::LoggedActuator& logged,
                               const lab::IdentifiedActuator& found) {
  const lab::ActuatorEstimate& a = found.actuator;
  nlohmann::ordered_json out = {{"joint", logged.joint},
                                {"richness", lab::name_of(a.richness)},
                                {"verdict", verdict(a)},
                                {"travel_rad", a.travel},
                                {"used_s", a.used}};
  if (!has_numbers(a.richness)) return out;
  out.update({{"equations", a.equations},
              {"condition", a.condition},
              {"residual_Nm", a.residual},
              {"spring_Nm_per_rad", json_of(a.spring, logged.spring)},
              {"rotor_kgm2", json_of(a.rotor, logged.rotor)},
              {"viscous_Nms_per_rad", json_of(a.viscous)},
              {"coulomb_Nm", json_of(a.coulomb)},
              {"offset_Nm", json_of(a.offset)}});
  if (found.no_delay.empty()) {
    out["delay_s"] = json_of(found.delay.delay);
    out["explained"] = found.delay.explained;
  } else {
    out["no_delay"] = found.no_delay;
  }
  return out;
}

// Those that --joint names, all without it.
std::vector<lab::LoggedActuator> asked_for(const IdentifyArguments& arguments,
                                           std::vector<lab::LoggedActuator> all) {
  if (arguments.joints.empty()) return all;
  std::vector<std::string> names;
  for (const lab::LoggedActuator& one : all) names.push_back(one.joint);
  std::vector<bool> wanted(all.size(), false);
  for (const std::string& pattern : arguments.joints) {
    bool any = false;
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (!core::glob_matches(pattern, names[j])) continue;
      wanted[j] = any = true;
    }
    if (any) continue;
    throw std::runtime_error(fmt::format("--joint: error: no joint '{}' with a spring in the log{}",
                                         pattern, core::did_you_mean_or_list(pattern, names)));
  }
  std::vector<lab::LoggedActuator> out;
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (wanted[j]) out.push_back(std::move(all[j]));
  }
  return out;
}

int run_identify(const IdentifyArguments& arguments) {
  const lab::Log log = read_whole_log(arguments.log);
  const auto logged = asked_for(arguments, lab::logged_actuators(log));
  bool good = true;
  nlohmann::ordered_json joints = nlohmann::ordered_json::array();
  for (const lab::LoggedActuator& one : logged) {
    const lab::IdentifiedActuator found = lab::identify(one);
    good = good && found.actuator.richness == Richness::good;
    if (arguments.json) {
      joints.push_back(json_of(one, found));
    } else {
      fmt::print("{}", text_of(one, found));
    }
  }
  if (arguments.json) {
    fmt::print("{}\n", core::json_text(nlohmann::ordered_json{{"good", good}, {"joints", joints}}));
  }
  return good ? kGood : kRobotFailed;
}

}  // namespace

void add_identify_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<IdentifyArguments>();
  CLI::App* command = app.add_subcommand(
      "identify",
      "Identifies series-elastic actuators from the log of a run that moves all joints");
  command->add_option("LOG", arguments->log, "log.mcap, or the folder it is in")->required();
  command->add_option("--joint", arguments->joints, "Only these: names or globs, e.g. \"*knee\"")
      ->delimiter(',');
  command->add_flag("--json", arguments->json, "One JSON object");
  command->footer(
      "Example: footfall identify out/run --joint \"*knee\"\n"
      "A log for it: footfall run excite --world sea_hoist");
  command->callback(
      [arguments, &exit_code] { exit_code = guarded([&] { return run_identify(*arguments); }); });
}

}  // namespace footfall::apps
