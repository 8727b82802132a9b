// Event marks of the report: external inputs and faults, as lines in all plots and as a list.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <optional>
#include <string_view>

#include "lab/report/sections.h"

namespace footfall::lab {
namespace {

constexpr std::array<std::string_view, 5> kMarkKinds = {"edit", "push", "hold", "inject", "fault"};
constexpr std::size_t kMaxRows = 500;

bool is_mark(const LoggedEvent& event) {
  return std::ranges::find(kMarkKinds, event.kind) != kMarkKinds.end();
}

// Values of parameters over the run, to show the value before an edit.
class Values {
 public:
  explicit Values(const Log& log) : log_(log), values_(log.parameter_values) {}

  // Advances to just before a tick of the behavior; times must not decrease.
  void advance(std::int64_t tick) {
    for (; next_ < log_.edits.size() && log_.edits[next_].tick < tick; ++next_) {
      for (const auto& [slot, value] : log_.edits[next_].writes) {
        if (slot >= 0 && static_cast<std::size_t>(slot) < values_.size()) {
          values_[static_cast<std::size_t>(slot)] = value;
        }
      }
    }
  }

  // `name` or `name[2]`.
  std::optional<double> of(std::string_view name) const {
    int index = 0;
    if (const std::size_t open = name.find('['); open != std::string_view::npos) {
      index = std::atoi(std::string(name.substr(open + 1)).c_str());
      name = name.substr(0, open);
    }
    for (const LoggedParameter& p : log_.parameters) {
      if (p.name != name || index < 0 || index >= p.size) continue;
      const auto slot = static_cast<std::size_t>(p.slot + index);
      if (slot < values_.size()) return values_[slot];
    }
    return {};
  }

 private:
  const Log& log_;
  std::vector<double> values_;
  std::size_t next_ = 0;
};

// Adds old values: `a = 1, raise b over 9 ticks` becomes `a: 0.5 → 1, raise b over 9 ticks`.
std::string with_values_before(std::string_view detail, const Values& values) {
  std::string out;
  while (!detail.empty()) {
    const std::size_t comma = std::min(detail.find(", "), detail.size());
    const std::string_view part = detail.substr(0, comma);
    detail.remove_prefix(std::min(comma + 2, detail.size()));
    const std::size_t equals = part.find(" = ");
    const auto before =
        equals == std::string_view::npos ? std::nullopt : values.of(part.substr(0, equals));
    if (!out.empty()) out += ", ";
    out += before ? fmt::format("{}: {:g} → {}", part.substr(0, equals), *before,
                                part.substr(equals + 3))
                  : std::string(part);
  }
  return out;
}

struct Row {
  double time = 0.0, last = 0.0;  // s, of the first and the last
  std::string kind, name, detail;
  int count = 1;
};

// Repetitions of the same fault are one row.
std::vector<Row> rows_of(const Log& log) {
  std::vector<Row> rows;
  Values values(log);
  for (const LoggedEvent& event : log.events) {
    if (!is_mark(event)) continue;
    if (!rows.empty() && event.kind == "fault" && rows.back().kind == "fault" &&
        rows.back().name == event.name) {
      ++rows.back().count;
      rows.back().last = event.time;
      continue;
    }
    values.advance(event.tick);
    const bool edit = event.kind == "edit";
    rows.push_back({event.time, event.time, event.kind, event.name,
                    edit ? with_values_before(event.detail, values) : event.detail});
  }
  return rows;
}

std::string row_html(const Row& row) {
  const std::string more =
      row.count > 1 ? fmt::format("; {} times until {:.3f} s", row.count, row.last) : "";
  return fmt::format(
      "<tr data-kind=\"{1}\" data-t=\"{0:.4f}\" data-what=\"{1} {2}\"><td>{0:.3f}</td><td>{1}</td>"
      "<td>{2}</td><td>{3}{4}</td></tr>",
      row.time, escape_html(row.kind), escape_html(row.name), escape_html(row.detail), more);
}

}  // namespace

std::vector<PlotMark> run_marks(const Log& log) {
  std::vector<PlotMark> marks;
  for (const LoggedEvent& event : log.events) {
    if (is_mark(event)) marks.push_back({event.time, event.kind});
  }
  return marks;
}

Section mark_section(const Log& log) {
  Section section{"marks",
                  "Edits, pushes and faults",
                  "External inputs with the previous values, and faults. "
                  "Each has a line in every plot; its row moves all plots to it.",
                  "",
                  {},
                  {}};
  const std::vector<Row> rows = rows_of(log);
  if (rows.empty()) return section;
  section.html =
      "<div class=\"scroll moments\" tabindex=\"0\" role=\"group\" aria-label=\"edits, pushes and "
      "faults\"><table class=\"events\"><thead><tr><th>time, s</th><th>kind</th><th>source or "
      "name</th><th>what</th></tr></thead><tbody>";
  for (std::size_t i = 0; i < std::min(rows.size(), kMaxRows); ++i) {
    section.html += row_html(rows[i]);
  }
  section.html += "</tbody></table></div>";
  if (rows.size() > kMaxRows) {
    section.lead += fmt::format(" Shown: the first {} of {}.", kMaxRows, rows.size());
  }
  return section;
}

}  // namespace footfall::lab
