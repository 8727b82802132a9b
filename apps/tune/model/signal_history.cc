// History of all signals, and a plot of one as text; see signal_history.h.
#include "apps/tune/model/signal_history.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/index.h"

namespace footfall::apps {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The values that belong to one column.
struct Column {
  double low = kInfinity, high = -kInfinity, first = 0.0, last = 0.0;
  bool empty() const { return low > high; }
};

std::vector<Column> columns_of(const SignalHistory& history, std::size_t signal, double window,
                               int count) {
  std::vector<Column> columns(extent(count));
  if (history.size() == 0) return columns;
  const double end = history.time(history.size() - 1);
  for (std::size_t i = 0; i < history.size(); ++i) {
    const double value = static_cast<double>(history.value(i, signal));
    const double age = end - history.time(i);
    if (age >= window || !std::isfinite(value)) continue;
    const int k = count - 1 - static_cast<int>(age / window * count);
    Column& column = columns[at(std::clamp(k, 0, count - 1))];
    if (column.empty()) column.first = value;
    column.low = std::min(column.low, value);
    column.high = std::max(column.high, value);
    column.last = value;
  }
  return columns;
}

// Connects the end of each filled column to the beginning of the next one.
void join_columns(std::vector<Column>& columns) {
  constexpr std::ptrdiff_t kLongestGap = 8;  // columns: bridges slow telemetry
  std::ptrdiff_t before = -1;
  for (std::ptrdiff_t k = 0; k < std::ssize(columns); ++k) {
    Column& column = columns[at(k)];
    if (column.empty()) continue;
    if (before >= 0 && k - before <= kLongestGap) {
      const Column from = columns[at(before)];
      for (std::ptrdiff_t j = before + 1; j < k; ++j) {
        const double part = static_cast<double>(j - before) / static_cast<double>(k - before);
        Column& between = columns[at(j)];
        between.low = between.high = from.last + part * (column.first - from.last);
        between.first = between.last = between.low;
      }
      const double near = columns[at(k - 1)].last;
      const double middle = 0.5 * (near + column.first);
      columns[at(k - 1)].low = std::min(columns[at(k - 1)].low, middle);
      columns[at(k - 1)].high = std::max(columns[at(k - 1)].high, middle);
      column.low = std::min(column.low, middle);
      column.high = std::max(column.high, middle);
    }
    before = k;
  }
}

// The UTF-8 code of a character in the Braille block.
std::string braille_character(unsigned dots) {
  const unsigned code = 0x2800 + dots;
  return {static_cast<char>(0xE0 | (code >> 12)), static_cast<char>(0x80 | ((code >> 6) & 0x3F)),
          static_cast<char>(0x80 | (code & 0x3F))};
}

// Braille dots are numbered down the left column, down the right one, then the lowest two.
constexpr std::array<std::array<unsigned, 4>, 2> kBrailleDots = {
    {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}}};

}  // namespace

void SignalHistory::reset(std::size_t signals, std::size_t capacity) {
  times_.assign(capacity, 0.0);
  rows_.assign(capacity * signals, 0.0F);
  signals_ = signals;
  next_ = size_ = 0;
}

void SignalHistory::add(double time_of_row, std::span<const float> row) {
  if (row.size() != signals_ || times_.empty()) return;
  if (size_ > 0 && time_of_row < time(size_ - 1)) size_ = 0;
  times_[next_] = time_of_row;
  std::ranges::copy(row, rows_.begin() + static_cast<std::ptrdiff_t>(next_ * signals_));
  next_ = (next_ + 1) % times_.size();
  size_ = std::min(size_ + 1, times_.size());
}

TextPlot plot_signal(const SignalHistory& history, std::size_t signal, double window, int width,
                     int height, bool braille) {
  TextPlot plot;
  const int across = braille ? 2 : 1, down = braille ? 4 : 1;
  std::vector<Column> columns = columns_of(history, signal, window, width * across);
  plot.low = kInfinity;
  plot.high = -kInfinity;
  for (const Column& column : columns) {
    plot.low = std::min(plot.low, column.low);
    plot.high = std::max(plot.high, column.high);
  }
  plot.empty = plot.low > plot.high;
  if (plot.empty) plot.low = plot.high = 0.0;
  join_columns(columns);

  const int dots_down = height * down;
  std::vector<unsigned> cells(extent(width * height), 0U);
  // A constant is drawn in the middle.
  const double span = plot.high - plot.low;
  const auto row_of = [&](double value) {
    const double part = span > 0.0 ? (plot.high - value) / span : 0.5;
    return std::clamp(static_cast<int>(std::lround(part * (dots_down - 1))), 0, dots_down - 1);
  };
  for (int x = 0; x < width * across; ++x) {
    const Column& column = columns[at(x)];
    if (column.empty()) continue;
    for (int y = row_of(column.high); y <= row_of(column.low); ++y) {
      cells[at(y / down * width + x / across)] |= kBrailleDots[at(x % across)][at(y % down)];
    }
  }
  for (int y = 0; y < height; ++y) {
    std::string& row = plot.rows.emplace_back();
    for (int x = 0; x < width; ++x) {
      const unsigned dots = cells[at(y * width + x)];
      row += dots == 0 ? " " : braille ? braille_character(dots) : "*";
    }
  }
  return plot;
}

}  // namespace footfall::apps
