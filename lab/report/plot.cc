// Plot data for the page's script, and functions shared with SVG drawing; see plot.h.
#include "lab/report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "core/text/json_text.h"

namespace footfall::lab {
namespace {

// Well-known walking states have the same colour in every report; others follow in order.
constexpr std::array<const char*, 6> kKnownStates = {"dual", "unload", "lift",
                                                     "land", "load",   "rise"};
constexpr int kBandColours = 10;

template <typename T>
std::string base64_of(const std::vector<T>& values) {
  return base64(values.data(), values.size() * sizeof(T));
}

nlohmann::json grid_json(const Grid& grid, const StateBands& bands) {
  nlohmann::json json = {{"x", base64_of(grid.time())}, {"bands", nlohmann::json::array()}};
  if (grid.time().empty()) return json;
  for (const StateInterval& interval : bands.intervals) {
    if (interval.end < grid.time().front() || interval.begin > grid.time().back()) continue;
    json["bands"].push_back({std::round(interval.begin * 1e4) / 1e4,
                             std::round(interval.end * 1e4) / 1e4, interval.name});
  }
  return json;
}

}  // namespace

std::string base64(const void* data, std::size_t size) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  std::string out;
  out.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    std::uint32_t word = static_cast<std::uint32_t>(bytes[i]) << 16;
    if (i + 1 < size) word |= static_cast<std::uint32_t>(bytes[i + 1]) << 8;
    if (i + 2 < size) word |= bytes[i + 2];
    out += kDigits[word >> 18];
    out += kDigits[word >> 12 & 63];
    out += i + 1 < size ? kDigits[word >> 6 & 63] : '=';
    out += i + 2 < size ? kDigits[word & 63] : '=';
  }
  return out;
}

int band_colour(const std::string& name, int index) {
  const auto* const known = std::ranges::find(kKnownStates, name);
  if (known != kKnownStates.end()) return static_cast<int>(known - kKnownStates.begin());
  constexpr int kKnown = static_cast<int>(kKnownStates.size());
  return kKnown + index % (kBandColours - kKnown);
}

std::pair<double, std::string> display_unit(const std::string& unit, double greatest) {
  const bool small = greatest < 0.1;
  if (unit == "m" && small) return {1e3, "mm"};
  if (unit == "rad" && small) return {1e3, "mrad"};
  return {1.0, unit};
}

double greatest(const TimePlot& plot) {
  double result = 0.0;
  for (const Curve& curve : plot.curves) {
    for (const float value : curve.values) {
      if (std::isfinite(value)) result = std::max(result, std::abs(static_cast<double>(value)));
    }
  }
  return result;
}

std::vector<double> ticks(double low, double high, int count) {
  const double raw = (high - low) / count;
  if (!(raw > 0.0) || !std::isfinite(raw)) return {low};
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double part = raw / power;
  const double step = power * (part <= 1.0 ? 1.0 : part <= 2.0 ? 2.0 : part <= 5.0 ? 5.0 : 10.0);
  std::vector<double> places;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
    places.push_back(k * step);
  }
  return places;
}

std::string bands_legend(const StateBands& bands) {
  if (bands.names.empty()) return "";
  std::string out = "<p class=\"bands\" aria-label=\"states\">";
  for (std::size_t i = 0; i < bands.names.size(); ++i) {
    out +=
        fmt::format("<span><i style=\"background:var(--s{})\"></i>{}</span>",
                    band_colour(bands.names[i], static_cast<int>(i)), escape_html(bands.names[i]));
  }
  return out + "</p>";
}

std::string time_plot_html(const TimePlot& plot) {
  const std::string unit = display_unit(plot.unit, greatest(plot)).second;
  return fmt::format(
      "<figure class=\"plot\"><figcaption>{}<small>{}</small></figcaption>"
      "<div class=\"chart\" data-plot=\"{}\" role=\"group\" aria-label=\"{}\"></div></figure>\n",
      escape_html(plot.title), unit.empty() ? "" : escape_html(unit), escape_html(plot.id),
      escape_html(plot.title));
}

std::string plot_data(const std::vector<TimePlot>& plots, const PlotFrame& frame) {
  nlohmann::json data;
  data["grids"] = {{"run", grid_json(frame.run, frame.bands)},
                   {"zoom", grid_json(frame.zoom, frame.bands)}};
  data["states"] = nlohmann::json::array();
  for (std::size_t i = 0; i < frame.bands.names.size(); ++i) {
    data["states"].push_back(
        {{"name", frame.bands.names[i]},
         {"colour", fmt::format("s{}", band_colour(frame.bands.names[i], static_cast<int>(i)))}});
  }
  data["marks"] = nlohmann::json::array();
  for (const PlotMark& mark : frame.marks) {
    data["marks"].push_back({std::round(mark.time * 1e4) / 1e4, mark.kind});
  }
  data["plots"] = nlohmann::json::object();
  for (const TimePlot& plot : plots) {
    const auto [scale, unit] = display_unit(plot.unit, greatest(plot));
    nlohmann::json item = {{"grid", plot.zoom ? "zoom" : "run"}, {"unit", unit}};
    for (const Curve& curve : plot.curves) {
      item["curves"].push_back({{"label", curve.label},
                                {"colour", curve.colour},
                                {"dashed", curve.dashed},
                                {"run", curve.run},
                                {"y", base64_of(frame.of(plot).thin(curve.values, scale))}});
    }
    data["plots"][plot.id] = std::move(item);
  }
  std::string text = core::json_text(data);
  // `</script>` in a name must not end the script element.
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
    text.replace(at, 1, "\\u003c");
  }
  return text;
}

}  // namespace footfall::lab
