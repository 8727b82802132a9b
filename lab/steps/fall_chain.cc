// Limits of a step's figures, and their first crossings before a fall; see fall_chain.h.
#include "lab/steps/fall_chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace footfall::lab {
namespace {

// Limits lie outside of what steps of a run that goes on reach: docs/why-it-falls.md has the
// rates. They tell a person where to look, and decide nothing in a run.
constexpr std::array kChainLinks = {
    ChainLink{"long_step", "step of {:.2f} s",
              "the longest of 1800 steps that went well took 0.40 s", 0.45, false,
              [](const StepRow& r) { return r.step_time; }},
    ChainLink{"not_reached", "the foot's reference was {:.3f} m from its target",
              "a tenth of a step's width, and of the reach to either side", 0.03, false,
              [](const StepRow& r) { return r.not_reached; }},
    ChainLink{"narrow", "feet {:.3f} m apart", "less than the planner asks for: no room to fall to",
              0.1, true, [](const StepRow& r) { return r.width; }},
    ChainLink{"early", "touchdown {:.3f} s early", "a quarter of a landing of 150 ms", 0.0375,
              false, [](const StepRow& r) { return r.early; }},
    ChainLink{"fast_foot", "the foot came down at {:.2f} m/s along the ground",
              "stopping it asks for more than the friction cone gives", 0.8, false,
              [](const StepRow& r) { return r.speed; }},
    ChainLink{"tracking", "the foot was {:.3f} m from its reference", "as for the target", 0.03,
              false, [](const StepRow& r) { return r.tracking; }},
    ChainLink{"prediction", "sideways {:.2f} m/s off the planner's prediction",
              "half of the speed of a step", 0.09, false,
              [](const StepRow& r) { return std::abs(r.lateral_speed - r.lateral_predicted); }},
    ChainLink{"slip", "feet slipped {:.1f} mm",
              "a landing foot slips 1 mm, a standing one does not", 6.0, false,
              [](const StepRow& r) { return 1e3 * (r.slip_single + r.slip_double); }},
    ChainLink{"friction", "tangential force {:.2f} of the normal one on one foot",
              "half of the friction of the world; steps need 0.1 to 0.18", 0.35, false,
              [](const StepRow& r) { return r.friction; }},
    ChainLink{"yaw_rate", "turning at {:.2f} rad/s", "0.3 rad in a step", 0.8, false,
              [](const StepRow& r) {
                return std::fmax(std::abs(r.yaw_rate), std::abs(r.yaw_rate_after));
              }},
    ChainLink{"saturated", "torque at its limit for {:.0f} ticks", "commands are then not obeyed",
              0.0, false, [](const StepRow& r) { return r.saturated; }},
    ChainLink{"tilt", "tilted by {:.3f} rad", "ten times that of a quiet step", 0.05, false,
              [](const StepRow& r) { return r.tilt; }},
};

std::string steps_before(std::size_t count) {
  if (count == 0) return "the last step";
  return fmt::format("{} step{} before it", count, count == 1 ? "" : "s");
}

}  // namespace

std::span<const ChainLink> chain_links() { return kChainLinks; }

std::vector<Crossing> fall_chain(std::span<const StepRow> rows) {
  const std::size_t first = rows.size() - std::min(rows.size(), kChainSteps);
  std::vector<Crossing> out;
  for (const ChainLink& link : kChainLinks) {
    for (std::size_t k = first; k < rows.size(); ++k) {
      if (!link.out_of_bounds(rows[k])) continue;
      out.push_back({&link, rows.size() - 1 - k, link.value(rows[k])});
      break;
    }
  }
  std::ranges::stable_sort(out, std::ranges::greater{}, &Crossing::before_end);
  return out;
}

std::string end_of(const Log& log) {
  for (const LoggedEvent& event : log.events) {
    if (event.kind == "end") return event.name;
  }
  return "";
}

std::string chain_text(std::span<const StepRow> rows) {
  if (rows.empty()) return "  no swing foot touched down before the fall\n";
  std::string text = fmt::format(
      "  first out of bounds, of the last {} of {} steps; the last touchdown was at {:.3f} s:\n",
      std::min(rows.size(), kChainSteps), rows.size(), rows.back().time);
  const std::vector<Crossing> chain = fall_chain(rows);
  if (chain.empty()) return text + "    nothing: all figures were within their limits\n";
  for (const Crossing& crossing : chain) {
    const ChainLink& link = *crossing.link;
    text += fmt::format("    {:18} {} ({} {:g}: {})\n", steps_before(crossing.before_end),
                        fmt::format(fmt::runtime(link.text), crossing.value),
                        link.below ? "below" : "over", link.limit, link.reason);
  }
  return text;
}

nlohmann::ordered_json chain_json(std::span<const StepRow> rows, bool fell) {
  nlohmann::ordered_json out = {
      {"fell", fell}, {"steps", rows.size()}, {"crossings", nlohmann::ordered_json::array()}};
  if (fell) {
    for (const Crossing& crossing : fall_chain(rows)) {
      out["crossings"].push_back({{"id", crossing.link->id},
                                  {"before_end", crossing.before_end},
                                  {"value", crossing.value}});
    }
  }
  const std::size_t healthy = rows.size() - (fell ? std::min(rows.size(), kChainSteps) : 0);
  nlohmann::ordered_json counts = {{"steps", healthy}};
  for (const ChainLink& link : kChainLinks) {
    counts[std::string(link.id)] = std::ranges::count_if(
        rows.first(healthy), [&](const StepRow& row) { return link.out_of_bounds(row); });
  }
  out["healthy"] = counts;
  return out;
}

}  // namespace footfall::lab
