// Derives the report's data from a log; see data.h.
#include "lab/report/data.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/text/json_text.h"
#include "lab/figures/log_figures.h"
#include "lab/figures/step_counter.h"

namespace footfall::lab {
namespace {

std::string last_part(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? path : path.substr(dot + 1);
}

std::array<const std::vector<float>*, 2> xy(const Log& log, const std::string& stem) {
  return {log.values(stem + ".x"), log.values(stem + ".y")};
}

// The column that tells whether a foot bears load: the contact set of the control law, else the
// foot switch.
const std::vector<float>* support_of(const Log& log, const std::string& foot) {
  const auto* support = log.values("support." + foot);
  return support != nullptr ? support : log.values("contact." + foot);
}

}  // namespace

std::vector<std::string> state_paths(const Log& log) {
  std::vector<std::string> paths;
  const auto list = core::parse_json(log.get("states", "[]"));
  if (!list.is_array()) return paths;
  for (const auto& item : list) {
    if (item.is_string()) {
      paths.push_back(item.get<std::string>());
    } else if (item.is_object() && item.contains("path") && item["path"].is_string()) {
      // {index, path}, in any order
      const std::size_t index =
          item.contains("index") && item["index"].is_number_unsigned()
              ? std::min<std::size_t>(item["index"].get<std::size_t>(), 100'000)
              : paths.size();
      if (paths.size() <= index) paths.resize(index + 1);
      paths[index] = item["path"].get<std::string>();
    } else {
      paths.emplace_back();
    }
  }
  return paths;
}

StateBands state_bands(const Log& log) {
  StateBands bands;
  const auto* state = log.values("state");
  const std::vector<std::string> paths = state_paths(log);
  if (state == nullptr || paths.empty()) return bands;
  int before = -1;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const auto index = static_cast<std::ptrdiff_t>(std::lround((*state)[row]));
    if (index < 0 || index >= static_cast<std::ptrdiff_t>(paths.size())) continue;
    const std::string name = last_part(paths[static_cast<std::size_t>(index)]);
    const auto found = std::ranges::find(bands.names, name);
    const int id = static_cast<int>(found - bands.names.begin());
    if (found == bands.names.end()) bands.names.push_back(name);
    if (id != before) {
      if (!bands.intervals.empty()) bands.intervals.back().end = log.time[row];
      bands.intervals.push_back({log.time[row], log.time[row], id});
      before = id;
    }
    bands.intervals.back().end = log.time[row];
  }
  return bands;
}

std::string state_path(const Log& log, std::size_t row) {
  const auto* state = log.values("state");
  if (state == nullptr || row >= log.rows()) return "";
  const std::vector<std::string> paths = state_paths(log);
  const auto index = static_cast<std::ptrdiff_t>(std::lround((*state)[row]));
  if (index < 0 || index >= static_cast<std::ptrdiff_t>(paths.size())) return "";
  return paths[static_cast<std::size_t>(index)];
}

std::vector<SupportPhase> single_support(const Log& log) {
  std::vector<SupportPhase> phases;
  const std::vector<std::string> feet = parts(log, "contact.", "");
  std::vector<const std::vector<float>*> support;
  for (const std::string& foot : feet) support.push_back(support_of(log, foot));
  int before = -1;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    int only = -1;  // the only supporting foot; -1: none, or several
    int count = 0;
    for (std::size_t i = 0; i < feet.size(); ++i) {
      if (support[i] != nullptr && (*support[i])[row] > 0.5F) {
        ++count;
        only = static_cast<int>(i);
      }
    }
    if (count != 1) only = -1;
    if (only != before && only >= 0) {
      phases.push_back({row, row, feet[static_cast<std::size_t>(only)]});
    }
    if (only >= 0) phases.back().end = row + 1;
    before = only;
  }
  return phases;
}

std::vector<PlannerColumns> planners(const Log& log) {
  std::vector<PlannerColumns> list;
  for (const std::string& name : parts(log, "planner.", ".target.x")) {
    const std::string stem = "planner." + name;
    list.push_back({name, xy(log, stem + ".target"), xy(log, stem + ".predicted_pos"),
                    xy(log, stem + ".predicted_vel")});
  }
  return list;
}

std::vector<Touchdown> touchdowns(const Log& log) {
  std::vector<Touchdown> list;
  const SampleNames names = sample_names(log);
  const SampleColumns columns =
      sample_columns(names, [&](std::string_view name) { return log.find(name); });
  StepCounter counter(static_cast<int>(names.contacts.size()),
                      1e3 / static_cast<double>(log.rate_mhz));
  std::array<double, core::kMaxContacts> heights{};
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const TickSample tick =
        read_sample(columns, [&](int i) { return log.column[static_cast<std::size_t>(i)][row]; });
    for (std::size_t c = 0; c < names.contacts.size(); ++c) heights[c] = tick.point[c][2];
    counter.observe(log.time[row], tick.contact.data(), heights.data());
    for (std::size_t c = 0; c < names.contacts.size(); ++c) {
      if (!counter.touched_down(static_cast<int>(c))) continue;
      list.push_back({log.time[row],
                      names.contacts[c],
                      {tick.point[c][0], tick.point[c][1]},
                      tick.target,
                      tick.has_target()});
    }
  }
  return list;
}

Grid::Grid(const Log& log, std::size_t begin, std::size_t end, std::size_t points)
    : begin_(begin), end_(end), buckets_(end - begin <= points ? 0 : points / 2) {
  if (buckets_ == 0) {
    time_.assign(log.time.begin() + static_cast<std::ptrdiff_t>(begin),
                 log.time.begin() + static_cast<std::ptrdiff_t>(end));
    return;
  }
  for (std::size_t b = 0; b < buckets_; ++b) {
    const std::size_t first = begin_ + b * (end_ - begin_) / buckets_;
    const std::size_t next = begin_ + (b + 1) * (end_ - begin_) / buckets_;
    time_.push_back(log.time[first]);
    time_.push_back(log.time[first + (next - first) / 2]);
  }
}

std::vector<float> Grid::thin(const std::vector<float>& column, double scale) const {
  std::vector<float> out;
  const auto put = [&](float value) {
    out.push_back(static_cast<float>(static_cast<double>(value) * scale));
  };
  if (buckets_ == 0) {
    for (std::size_t row = begin_; row < end_; ++row) put(column[row]);
    return out;
  }
  for (std::size_t b = 0; b < buckets_; ++b) {
    const auto first =
        column.begin() + static_cast<std::ptrdiff_t>(begin_ + b * (end_ - begin_) / buckets_);
    const auto next =
        column.begin() + static_cast<std::ptrdiff_t>(begin_ + (b + 1) * (end_ - begin_) / buckets_);
    const auto [least, greatest] = std::minmax_element(first, next);
    put(least < greatest ? *least : *greatest);
    put(least < greatest ? *greatest : *least);
  }
  return out;
}

}  // namespace footfall::lab
