// Layout of the full screen; see layout.h.
#include "apps/tune/view/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "apps/tune/view/head.h"
#include "core/index.h"
#include "core/units/units.h"

namespace footfall::apps {
namespace {

using Lines = std::vector<StyledLine>;

constexpr int kTwoColumns = 118;  // from this width on, plot and edits are beside the list
constexpr int kEdgeLabel = 10;    // columns for numbers beside a plot

// `-- title ----- right --`
StyledLine rule(const std::string& title, const std::string& right, int width, bool unicode) {
  const std::string dash = unicode ? "\u2500" : "-";
  const auto dashes = [&](int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += dash;
    return out;
  };
  const int room = width - text_columns(title) - (right.empty() ? 0 : text_columns(right) + 4) - 4;
  StyledLine line = {{dashes(2), Style::dim}, {" " + title + " ", Style::strong}};
  line.push_back({dashes(std::max(0, room)), Style::dim});
  if (!right.empty()) {
    line.push_back({" " + right + " ", Style::plain});
    line.push_back({dashes(2), Style::dim});
  }
  return line;
}

// Scrolls so that the selected row is among the `rows` rows from `top` on.
void scroll_to(int selected, int count, int rows, int& top) {
  top = std::clamp(top, std::max(0, selected - rows + 1), std::max(0, selected));
  top = std::max(0, std::min(top, count - rows));
}

struct ListColumns {
  int name = 0, value = 12;
  bool file = true;
};

ListColumns columns_for(int width) {
  ListColumns columns;
  columns.file = width >= 64;
  columns.name = width - 2 - (columns.file ? 3 : 2) * (columns.value + 1) - 1;
  return columns;
}

StyledLine list_head(const ListColumns& columns) {
  std::string text = "  " + fitted("name", columns.name) + " " +
                     fitted_right("now", columns.value) + " " +
                     fitted_right("goes to", columns.value);
  if (columns.file) text += " " + fitted_right("file", columns.value);
  return {{text, Style::dim}};
}

StyledLine entry_line(const TuneModel& model, const TuneOutbox& outbox, int index, bool selected,
                      const ListColumns& columns) {
  const TuneEntry& entry = model.entries[at(index)];
  const DisplayUnit& unit = model.parameters[at(entry.parameter)].unit;
  const double now = model.value_now(entry.slot), of_file = model.value_of_file(entry.slot);
  const double target = outbox.expected(model, index);
  const auto cell = [&](double value) {
    return " " + fitted_right(shown_value(value, unit, 5), columns.value);
  };
  const Style style = selected ? Style::selected : Style::plain;
  const auto marked = [&](Style other) { return selected ? Style::selected : other; };
  StyledLine line = {{selected ? "> " : "  ", style},
                     {fitted_name(entry.name, columns.name), style}};
  const bool changed = target != of_file;
  line.push_back({cell(now), marked(changed ? Style::warning : Style::plain)});
  line.push_back({target == now ? std::string(at(columns.value + 1), ' ') : cell(target),
                  marked(outbox.is_waiting(index) ? Style::dim : Style::good)});
  if (columns.file) line.push_back({cell(of_file), marked(changed ? Style::plain : Style::dim)});
  return line;
}

// Range, step and doc of the selected entry.
StyledLine detail_line(const TuneModel& model, const TuneView& view,
                       const std::vector<int>& shown) {
  if (shown.empty()) return {{" no name matches the filter (escape shows all)", Style::warning}};
  const TuneEntry& entry = model.entries[at(shown[at(view.selected)])];
  const TuneParameter& parameter = model.parameters[at(entry.parameter)];
  std::string text = " ";
  if (parameter.has_range()) text += range_text(parameter) + ", ";
  text += fmt::format("step {:g}{}{}", entry.step, parameter.unit.name.empty() ? "" : " ",
                      parameter.unit.name);
  if (view.over > 0.0) text += ", over " + shown_value(view.over, {"ms", 1e-3});
  if (!parameter.doc.empty()) text += ": " + parameter.doc;
  return {{text, Style::dim}};
}

void add_list(Lines& lines, const TuneModel& model, TuneView& view, const TuneOutbox& outbox,
              int width, int height, bool unicode) {
  const std::vector<int> shown = shown_entries(model, view);
  const int count = static_cast<int>(shown.size()), rows = height - 3;
  view.selected = std::clamp(view.selected, 0, std::max(0, count - 1));
  scroll_to(view.selected, count, rows, view.top);
  std::string right = fmt::format("{} of {}", count == 0 ? 0 : view.selected + 1, count);
  if (!view.filter.empty()) right = fmt::format("filter {}   {}", view.filter, right);
  lines.push_back(rule("parameters and gains", right, width, unicode));
  const ListColumns columns = columns_for(width);
  lines.push_back(list_head(columns));
  for (int row = 0; row < rows; ++row) {
    const int k = view.top + row;
    lines.push_back(k < count ? entry_line(model, outbox, shown[at(k)], k == view.selected, columns)
                              : StyledLine{});
  }
  lines.push_back(detail_line(model, view, shown));
}

void add_choice(Lines& lines, const TuneModel& model, TuneView& view, int width, int height,
                bool unicode) {
  const std::vector<std::string> names = offered(model, view);
  const int count = static_cast<int>(names.size()), rows = height - 1;
  view.choice = std::clamp(view.choice, 0, std::max(0, count - 1));
  scroll_to(view.choice, count, rows, view.choice_top);
  const bool signals = view.prompt == TunePrompt::signal;
  lines.push_back(rule(signals ? "signals" : "events",
                       fmt::format("{} of {}", count == 0 ? 0 : view.choice + 1, count), width,
                       unicode));
  for (int row = 0; row < rows; ++row) {
    const int k = view.choice_top + row;
    StyledLine& line = lines.emplace_back();
    if (k >= count) continue;
    const std::string& name = names[at(k)];
    std::string text = (k == view.choice ? "> " : "  ") + name;
    if (signals) {
      const auto unit = core::parse_unit(signal_unit(model, name));
      const DisplayUnit shown{unit ? core::unit_text(unit->dimension) : std::string(), 1.0};
      text = fitted_name(text, width - 20) +
             fitted_right(shown_value(signal_value(model, name), shown, 5), 18);
    }
    line.push_back({text, k == view.choice ? Style::selected : Style::plain});
  }
}

void add_page(Lines& lines, TuneView& view, int width, int height, bool unicode) {
  const int count = static_cast<int>(view.page.size()), rows = height - 1;
  view.page_top = std::clamp(view.page_top, 0, std::max(0, count - rows));
  const std::string right = count > rows ? fmt::format("{} to {} of {} lines", view.page_top + 1,
                                                       std::min(count, view.page_top + rows), count)
                                         : std::string();
  lines.push_back(rule(view.page_title, right, width, unicode));
  for (int row = 0; row < rows; ++row) {
    const int k = view.page_top + row;
    StyledLine line = k < count ? view.page[at(k)] : StyledLine{};
    line.insert(line.begin(), {" "});
    lines.push_back(std::move(line));
  }
}

void add_plot(Lines& lines, const TuneModel& model, const TuneView& view, int width, int height,
              bool unicode) {
  const int signal = find_signal(model, view.signal);
  const auto unit = core::parse_unit(signal_unit(model, view.signal));
  const core::Dimension dimension = unit ? unit->dimension : core::Dimension{};
  TextPlot plot;
  if (signal >= 0) {
    plot = plot_signal(model.history, at(signal), view.window, width - kEdgeLabel - 1, height - 1,
                       unicode);
  }
  const double size = std::max(std::abs(plot.low), std::abs(plot.high));
  const DisplayUnit shown = display_unit(dimension, size);
  const DisplayUnit edge_unit{{}, shown.factor};  // the title already has the unit
  const double value = signal_value(model, view.signal);
  std::string title = signal < 0 ? "plot" : view.signal;
  if (std::isfinite(value)) title += "  " + shown_value(value, shown, 4);
  lines.push_back(rule(title, fmt::format("{:g} s", view.window), width, unicode));
  for (int row = 0; row + 1 < height; ++row) {
    std::string edge;
    if (!plot.empty && row == 0) edge = shown_value(plot.high, edge_unit, 4);
    if (!plot.empty && row + 2 == height && plot.low < plot.high)
      edge = shown_value(plot.low, edge_unit, 4);
    StyledLine line = {{fitted_right(edge, kEdgeLabel) + " ", Style::dim}};
    if (!plot.empty)
      line.push_back({plot.rows[at(row)], Style::curve});
    else if (row == 0)
      line.push_back({signal < 0 ? "p chooses a signal" : "no value yet", Style::dim});
    lines.push_back(std::move(line));
  }
}

void add_notes(Lines& lines, const TuneModel& model, int width, int height, bool unicode) {
  lines.push_back(rule("edits", {}, width, unicode));
  const int rows = height - 1;
  const auto count = static_cast<int>(model.notes.size());
  for (int row = 0; row < rows; ++row) {
    const int k = std::max(0, count - rows) + row;
    StyledLine& line = lines.emplace_back();
    if (k >= count) continue;
    const TuneNote& note = model.notes[at(k)];
    line.push_back({fitted_right(fmt::format("{:.1f} s", note.time), 9) + "  ", Style::dim});
    line.push_back({note.who + "  ", note.own ? Style::dim : Style::strong});
    line.push_back({note.text, note.accepted ? Style::plain : Style::bad});
  }
}

struct KeyHelp {
  const char *key, *text;
};

// As many key hints as fit.
StyledLine key_line(std::initializer_list<KeyHelp> keys, int width) {
  StyledLine line;
  int used = 0;
  for (const auto& [key, text] : keys) {
    const std::string before = line.empty() ? " " : "  ";
    const int columns = text_columns(before) + text_columns(key) + 1 + text_columns(text);
    if (used + columns > width) continue;
    line.push_back({before});
    line.push_back({key, Style::key});
    line.push_back({std::string(" ") + text, Style::dim});
    used += columns;
  }
  return line;
}

StyledLine keys_of(const TuneView& view, int width) {
  switch (view.mode) {
    case TuneMode::list:
      return key_line({{"?", "help"},
                       {"q", "quit"},
                       {"+ -", "change"},
                       {"=", "type"},
                       {"u", "undo"},
                       {"r", "redo"},
                       {"/", "filter"},
                       {"c", "compare"},
                       {"s", "save"},
                       {"p", "plot"},
                       {"e", "event"},
                       {"o", "over"},
                       {"> <", "ten steps"},
                       {". ,", "a tenth"},
                       {"f", "as in the file"}},
                      width);
    case TuneMode::prompt:
      return key_line({{"enter", "takes it"}, {"escape", "leaves it"}}, width);
    case TuneMode::choice:
      return key_line({{"up down", "choose"},
                       {"enter", "takes it"},
                       {"escape", "leaves it"},
                       {"text", "filters"}},
                      width);
    case TuneMode::page:
      return key_line({{"up down", "scroll"}, {"any other key", "goes back"}}, width);
    case TuneMode::confirm:
      return key_line({{"y", "write"},
                       {"o", "into another file"},
                       {"up down", "scroll"},
                       {"any other key", "writes nothing"}},
                      width);
  }
  return {};
}

const char* label_of(TunePrompt prompt) {
  switch (prompt) {
    case TunePrompt::filter:
      return "filter (text or pattern): ";
    case TunePrompt::value:
      return "value: ";
    case TunePrompt::command:
      return "NAME=VALUE ...: ";
    case TunePrompt::over:
      return "changes take: ";
    case TunePrompt::overlay:
      return "save into the file (a new one becomes an overlay): ";
    case TunePrompt::signal:
      return "signal: ";
    case TunePrompt::event:
      return "event: ";
  }
  return "";
}

// The text being typed, or the last message.
StyledLine message_line(const TuneView& view, const TuneLink& link, Picture& picture, int row) {
  if (view.mode == TuneMode::prompt || view.mode == TuneMode::choice) {
    const std::string label = std::string(" ") + label_of(view.prompt);
    picture.cursor_row = row;
    picture.cursor_column = text_columns(label) + text_columns(view.typed);
    StyledLine line = {{label, Style::strong}, {view.typed}};
    if (!view.message.empty()) line.push_back({"   " + view.message, Style::bad});
    return line;
  }
  if (link.silence > kLongSilence && !link.trouble.empty())
    return {{" " + link.trouble, Style::bad}};
  return {{" " + view.message, view.message_is_bad ? Style::bad : Style::good}};
}

// The list, or in its place the names to choose from.
void add_main(Lines& lines, const TuneModel& model, TuneView& view, const TuneOutbox& outbox,
              int width, int height, bool unicode) {
  if (view.mode == TuneMode::choice) {
    add_choice(lines, model, view, width, height, unicode);
  } else {
    add_list(lines, model, view, outbox, width, height, unicode);
  }
}

void add_beside(Lines& lines, const Lines& left, const Lines& right, int left_width, bool unicode) {
  for (std::size_t k = 0; k < left.size(); ++k) {
    StyledLine line = left[k];
    fit_line(line, left_width);
    line.push_back({unicode ? "\u2502" : "|", Style::dim});
    if (k < right.size()) line.insert(line.end(), right[k].begin(), right[k].end());
    lines.push_back(std::move(line));
  }
}

void add_body(Lines& lines, const TuneModel& model, TuneView& view, const TuneOutbox& outbox,
              const TuneLink& link, int width, int height) {
  if (view.mode == TuneMode::page || view.mode == TuneMode::confirm) {
    add_page(lines, view, width, height, link.unicode);
    return;
  }
  if (width >= kTwoColumns) {
    const int left_width = width * 11 / 20, right_width = width - left_width - 1;
    const int plot_height = std::clamp(height / 2, 5, 16);
    Lines left, right;
    add_main(left, model, view, outbox, left_width, height, link.unicode);
    add_plot(right, model, view, right_width, plot_height, link.unicode);
    add_notes(right, model, right_width, height - plot_height, link.unicode);
    add_beside(lines, left, right, left_width, link.unicode);
    return;
  }
  const int plot_height = std::clamp(height / 4, 3, 10), note_height = std::clamp(height / 5, 2, 8);
  add_main(lines, model, view, outbox, width, height - plot_height - note_height, link.unicode);
  add_plot(lines, model, view, width, plot_height, link.unicode);
  add_notes(lines, model, width, note_height, link.unicode);
}

}  // namespace

Picture draw(const TuneModel& model, TuneView& view, const TuneOutbox& outbox, const TuneLink& link,
             int width, int height) {
  Picture picture;
  if (width < kLeastWidth || height < kLeastHeight) {
    picture.lines.push_back(
        {{fmt::format("The window is too small: {} x {} is needed.", kLeastWidth, kLeastHeight)}});
    picture.lines.resize(at(std::max(1, height)));
  } else {
    picture.lines = head_lines(model, link.silence, width);
    const int foot = 2, head = static_cast<int>(picture.lines.size());
    add_body(picture.lines, model, view, outbox, link, width, height - head - foot);
    picture.lines.push_back(message_line(view, link, picture, height - foot));
    picture.lines.push_back(keys_of(view, width));
  }
  for (StyledLine& line : picture.lines) fit_line(line, width);
  picture.cursor_column = std::min(picture.cursor_column, width - 1);
  return picture;
}

}  // namespace footfall::apps
