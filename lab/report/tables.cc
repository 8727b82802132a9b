// Cards and tables of the report: summary, settings, events, timing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/text/json_text.h"
#include "lab/report/sections.h"

namespace footfall::lab {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxEvents = 1000;
constexpr std::size_t kMaxSetting = 300;  // maximum number of characters shown of a setting

std::string card(const std::string& name, const std::string& value, const std::string& note = "",
                 const std::string& kind = "") {
  return fmt::format("<div class=\"card {}\"><b>{}</b><span>{}</span><small>{}</small></div>", kind,
                     escape_html(value), escape_html(name), escape_html(note));
}

std::optional<double> number_at(const json& object, const std::string& pointer) {
  const json::json_pointer at(pointer);
  if (!object.is_object() || !object.contains(at) || !object.at(at).is_number()) return {};
  return object.at(at).get<double>();
}

std::string text_at(const json& object, const char* key) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_string()) return "";
  return object[key].get<std::string>();
}

// A length or an angle with a suitable unit.
std::string measure(double value, const std::string& unit) {
  const auto [scale, name] = display_unit(unit, std::abs(value));
  return fmt::format("{:.3g} {}", value * scale, name);
}

std::string error_card(const json& summary, const std::string& key) {
  const std::string unit = key == "height" ? "m" : "rad";
  const auto rms = number_at(summary, "/error/" + key + "/rms");
  const auto max = number_at(summary, "/error/" + key + "/max");
  if (!rms || !max) return "";
  return card(key + " error, largest", measure(*max, unit), "rms " + measure(*rms, unit));
}

std::string outcome_card(const Log& log, const json& summary) {
  const std::string end = text_at(summary, "end");
  const bool fell = summary.is_object() && summary.value("fell", false);
  const json cause = summary.is_object() ? summary.value("cause", json()) : json();
  const std::string why = text_at(cause, "text");
  if (fell || end == "fall") return card("outcome", "fell", why, "bad");
  if (end == "fault") return card("outcome", "stopped by a fault", why, "bad");
  if (!log.complete) return card("outcome", "cut off", "the log is incomplete", "warn");
  if (end == "finished")
    return card("outcome", "finished", "the behavior reached its final state", "good");
  if (end == "stopped") return card("outcome", "stopped by hand", "", "warn");
  return card("outcome", "no fall", end.empty() ? "" : "end: " + end, "good");
}

void add_number(std::string& out, const json& summary, const char* pointer, const std::string& name,
                const std::string& unit, const std::string& note = "") {
  const auto value = number_at(summary, pointer);
  if (value) out += card(name, measure(*value, unit), note);
}

std::string placement_note(const json& summary) {
  const auto worst = number_at(summary, "/foot_placement_m/max");
  const auto count = number_at(summary, "/foot_placement_m/count");
  std::string note = worst ? "largest " + measure(*worst, "m") : "";
  if (count) note += fmt::format("{}{:.0f} steps", note.empty() ? "" : ", ", *count);
  return note;
}

// ` (worst left_knee 7.2 Nm)` for joint faults.
std::string worst_place(const json& summary, const std::string& fault) {
  const json::json_pointer place = json::json_pointer("/worst_fault") / fault;
  if (!summary.contains(place) || !summary[place].is_object()) return {};
  const json& worst = summary[place];
  for (const char* unit : {"Nm", "rad", "s", "value"}) {
    const auto value = worst.find(unit);
    if (value == worst.end() || !value->is_number()) continue;
    const bool plain = std::string_view(unit) == "value";
    return fmt::format(" (worst {} {:.3g}{}{})", text_at(worst, "joint"), value->get<double>(),
                       plain ? "" : " ", plain ? "" : unit);
  }
  return {};
}

std::string faults_card(const json& summary) {
  std::string names;
  std::int64_t count = 0;
  const json faults =
      summary.is_object() ? summary.value("faults", json::object()) : json::object();
  for (const auto& [name, value] : faults.items()) {
    if (!value.is_number() || value.get<double>() == 0.0) continue;
    count += value.get<std::int64_t>();
    names += (names.empty() ? "" : ", ") + name + " " + core::json_text(value) +
             worst_place(summary, name);
  }
  return card("faults", std::to_string(count), names, count > 0 ? "warn" : "");
}

std::string time_card(const json& summary, const Log& log) {
  const double end = log.time.empty() ? 0.0 : log.time.back();
  const auto factor = number_at(summary, "/real_time_factor");
  return card("simulated", fmt::format("{:.2f} s", number_at(summary, "/time_s").value_or(end)),
              factor ? fmt::format("{:.1f} x real time", *factor) : "");
}

// Adds the leaves of a JSON object as table rows.
void add_rows(const json& value, const std::string& path, std::string& out) {
  if (value.is_object()) {
    for (const auto& [key, item] : value.items()) {
      add_rows(item, path.empty() ? key : path + " " + key, out);
    }
  } else if (!value.is_array() && !value.is_null()) {
    const std::string text = value.is_number_float() ? fmt::format("{:.4g}", value.get<double>())
                             : value.is_string()     ? value.get<std::string>()
                                                     : core::json_text(value);
    out += fmt::format("<tr><th>{}</th><td>{}</td></tr>", escape_html(path), escape_html(text));
  }
}

// {"edges_us": [n+1], "counts": [n]} as a step curve with logarithmic counts, because the few late
// ticks matter most.
std::optional<PlanePlot> histogram(const json& timing) {
  if (!timing.is_object() || !timing.contains("histogram")) return {};
  const json& data = timing["histogram"];
  if (!data.is_object() || !data.contains("edges_us") || !data.contains("counts")) return {};
  const json &edges = data["edges_us"], &counts = data["counts"];
  if (!edges.is_array() || !counts.is_array() || edges.size() != counts.size() + 1) return {};
  PlanePlot plot{"tick-histogram", "Time of a tick", "µs", "ticks, log10(1 + n)", {}, false, 0.1};
  PlaneCurve curve{"", "c0", Mark::line, {}, 1.0};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!edges[i].is_number() || !edges[i + 1].is_number() || !counts[i].is_number()) return {};
    const double height = std::log10(1.0 + counts[i].get<double>());
    curve.points.push_back({edges[i].get<double>(), height});
    curve.points.push_back({edges[i + 1].get<double>(), height});
  }
  plot.curves.push_back(std::move(curve));
  return plot;
}

// [{"part": 0.99, "us": 15.2}, ...] as table rows, and as a curve of the logarithm of time over the
// number of nines, because the last thousandth is many times the median.
std::optional<PlanePlot> percentiles(const json& timing, std::string& rows) {
  if (!timing.contains("percentiles") || !timing["percentiles"].is_array()) return {};
  PlanePlot plot{"tick-percentiles",
                 "Time of a tick",
                 "nines of the ticks (2: 99 %, 3: 99.9 %)",
                 "log10 of µs",
                 {},
                 false,
                 0.5};
  PlaneCurve curve{"", "c0", Mark::line, {}, 1.0}, dots{"", "c0", Mark::dot, {}, 1.0};
  for (const json& item : timing["percentiles"]) {
    const auto part = number_at(item, "/part"), us = number_at(item, "/us");
    if (!part || !us) continue;
    rows += fmt::format("<tr><th>{:.6g} % of the ticks within</th><td>{:.4g} µs</td></tr>",
                        100.0 * *part, *us);
    if (*part >= 1.0 || *us <= 0.0) continue;
    curve.points.push_back({-std::log10(1.0 - *part), std::log10(*us)});
  }
  dots.points = curve.points;
  plot.curves = {std::move(curve), std::move(dots)};
  return plot;
}

}  // namespace

std::string summary_lead(const Log& log, const json& summary) {
  const auto from = number_at(summary, "/counted_from_s");
  if (log.rows() == 0 || !from) return "";
  const double end = log.time.back();
  if (log.part) {
    return fmt::format(
        "Of the part from {:.3f} s to {:.3f} s; only the outcome is that of the whole run.", *from,
        end);
  }
  if (*from == 0.0) return "Of the whole run.";
  return fmt::format(
      "Errors, foot placement, torques and internal forces from {:.3g} s on, when the start has "
      "died "
      "away; the rest of the whole run.",
      *from);
}

std::string summary_html(const Log& log, const json& summary) {
  std::string out = "<div class=\"cards\">" + outcome_card(log, summary);
  if (const auto steps = number_at(summary, "/steps"))
    out += card("steps", fmt::format("{:.0f}", *steps));
  out += time_card(summary, log);
  for (const char* key : {"roll", "pitch", "yaw", "height"}) out += error_card(summary, key);
  add_number(out, summary, "/foot_placement_m/mean", "foot placement, mean", "m",
             placement_note(summary));
  add_number(out, summary, "/goal_error_m", "goal error", "m");
  add_number(out, summary, "/path_length_m", "path length", "m");
  add_number(out, summary, "/peak_torque_Nm", "peak torque", "N m");
  add_number(out, summary, "/max_torque_step_Nm", "largest torque step", "N m");
  if (summary.is_object() && summary.contains("internal_force") &&
      summary["internal_force"].is_object()) {
    for (const auto& [name, item] : summary["internal_force"].items()) {
      const auto rms = number_at(item, "/rms");
      const auto relative = number_at(item, "/relative_rms");
      if (rms) {
        out += card("internal force " + name + ", rms", measure(*rms, "N"),
                    relative ? fmt::format("{:.1f} % of the reference", 100 * *relative) : "");
      }
    }
  }
  const auto p50 = number_at(summary, "/tick_us/p50");
  const auto p99 = number_at(summary, "/tick_us/p99");
  if (p50) {
    out += card("tick, median", fmt::format("{:.3g} µs", *p50),
                p99 ? fmt::format("99 %: {:.3g} µs", *p99) : "");
  }
  add_number(out, summary, "/allocations", "allocations in the loop", "");
  return out + faults_card(summary) + "</div>";
}

std::string settings_html(const Log& log) {
  std::string out = "<table class=\"keys\">";
  for (const auto& [key, value] : log.run) {
    if (key == "states" || key == "tasks" || key == "actuators") continue;
    const bool fits = value.size() <= kMaxSetting;
    out += fmt::format("<tr><th>{}</th><td>{}{}</td></tr>", escape_html(key),
                       escape_html(value.substr(0, kMaxSetting)), fits ? "" : "…");
  }
  out += fmt::format("<tr><th>log</th><td>{} ({} signals, {} rows{})</td></tr></table>",
                     escape_html(log.path), log.signals.size(), log.rows(),
                     log.complete ? "" : ", cut off");
  return out;
}

Section event_section(const Log& log) {
  Section section{"events", "Events", "Transitions, marks, faults, plans and steps.", "", {}, {}};
  std::vector<LoggedEvent> events = log.events;
  if (events.size() > kMaxEvents) {  // a planner may answer every tick
    std::erase_if(events, [](const LoggedEvent& event) { return event.kind == "plan"; });
    section.lead += " Plans are too many to list; the planner's plots have them.";
  }
  if (events.empty()) return section;
  std::vector<std::string> kinds;
  for (const LoggedEvent& event : events) {
    if (std::ranges::find(kinds, event.kind) == kinds.end()) kinds.push_back(event.kind);
  }
  if (events.size() > kMaxEvents) {
    section.lead +=
        fmt::format(" Shown: the first and last {} of {}.", kMaxEvents / 2, events.size());
  }
  section.html = "<p class=\"filter\">";
  for (const std::string& kind : kinds) {
    section.html += fmt::format(
        "<label><input type=\"checkbox\" checked data-kind=\"{0}\">{0}</label>", escape_html(kind));
  }
  section.html +=
      "</p><div class=\"scroll moments\" tabindex=\"0\" role=\"group\" "
      "aria-label=\"events\"><table "
      "class=\"events\"><thead><tr><th>time, s</th>"
      "<th>kind</th><th>name</th><th>detail</th></tr></thead><tbody>";
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (events.size() > kMaxEvents && i == kMaxEvents / 2) i = events.size() - kMaxEvents / 2;
    const LoggedEvent& event = events[i];
    section.html += fmt::format(
        "<tr data-kind=\"{1}\" data-t=\"{0:.4f}\" "
        "data-what=\"{2}\"><td>{0:.3f}</td><td>{1}</td><td>{2}</td><td>{3}</td></tr>",
        event.time, escape_html(event.kind), escape_html(event.name), escape_html(event.detail));
  }
  section.html += "</tbody></table></div>";
  return section;
}

Section timing_section(const std::string& timing_text) {
  Section section{"timing", "Timing", "Wall-clock measurements; they differ between runs.",
                  "",       {},       {}};
  const json timing = core::parse_json(timing_text);
  if (!timing.is_object()) return section;
  std::string rows;
  add_rows(timing, "", rows);
  if (auto plot = percentiles(timing, rows)) section.planes.push_back(std::move(*plot));
  if (auto plot = histogram(timing)) section.planes.push_back(std::move(*plot));
  section.html = "<table class=\"keys\">" + rows + "</table>";
  return section;
}

}  // namespace footfall::lab
