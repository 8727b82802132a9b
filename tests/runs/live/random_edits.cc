// See random_edits.h.
#include "tests/runs/live/random_edits.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace footfall::tests {

using footfall_lcm::change_t;
using footfall_lcm::parameter_t;
using footfall_lcm::request_t;

RandomEdits::RandomEdits(const footfall_lcm::catalogue_t& catalogue, std::uint64_t seed)
    : catalogue_(catalogue), random_(seed) {}

int RandomEdits::below(int count) {
  return std::uniform_int_distribution<int>(0, count - 1)(random_);
}
double RandomEdits::part() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

change_t RandomEdits::change(std::size_t parameter) {
  const parameter_t& info = catalogue_.parameters[parameter];
  change_t change;
  change.name = info.name;
  change.component = info.size > 1 && below(2) == 0 ? below(info.size) : -1;
  const int first = info.first + std::max(0, change.component);
  const int count = change.component < 0 ? info.size : 1;
  for (int k = 0; k < count; ++k) {
    const double shipped = catalogue_.values[static_cast<std::size_t>(first + k)];
    double value = shipped * (0.8 + 0.4 * part());
    if (info.has_range) value = std::clamp(value, info.min, info.max);
    change.values.push_back(value);
  }
  return change;
}

request_t RandomEdits::valid() {
  request_t request{};
  request.revision = -1;
  request.over = 0.3 * part();
  std::set<std::size_t> chosen;
  for (int k = 1 + below(4); k > 0; --k) {
    chosen.insert(static_cast<std::size_t>(below(static_cast<int>(catalogue_.parameters.size()))));
  }
  for (const std::size_t parameter : chosen) request.changes.push_back(change(parameter));
  return request;
}

std::size_t RandomEdits::ranged() {
  std::vector<std::size_t> with;
  for (std::size_t k = 0; k < catalogue_.parameters.size(); ++k) {
    if (catalogue_.parameters[k].has_range) with.push_back(k);
  }
  return with.empty() ? 0 : with[static_cast<std::size_t>(below(static_cast<int>(with.size())))];
}

change_t RandomEdits::out_of_range(bool above) {
  const std::size_t parameter = ranged();
  const parameter_t& info = catalogue_.parameters[parameter];
  change_t change = this->change(parameter);
  const double width = info.max - info.min;
  change.values[0] = above ? info.max + width : info.min - width;
  return change;
}

request_t RandomEdits::invalid(int way) {
  request_t request = valid();
  change_t& some =
      request.changes[static_cast<std::size_t>(below(static_cast<int>(request.changes.size())))];
  switch (way) {
    case 0:
      some.name += "x";
      break;
    case 1:
      some.name.clear();
      break;
    case 2:
    case 3:
      request.changes = {out_of_range(way == 2)};
      break;
    case 4:
      some.values[0] = std::numeric_limits<double>::quiet_NaN();
      break;
    case 5:
      some.values[0] = std::numeric_limits<double>::infinity();
      break;
    case 6:
      some.values.push_back(1.0);
      break;
    case 7:
      some.values.clear();
      break;
    case 8:
      some.component = 1000;
      break;
    case 9:
      some.component = -2;
      break;
    case 10:
      request.changes.push_back(some);  // twice
      break;
    case 11:
      request.over = -1.0;
      break;
    case 12:
      request.over = std::numeric_limits<double>::quiet_NaN();
      break;
    case 13:
      request.revision = 0;  // long past
      break;
    case 14:
      request.changes.clear();
      break;
    case 15:
      request.events = {"no_such_event"};
      break;
    case 16:
      request.what = 7;
      break;
    default:
      request.events.assign(40, catalogue_.events.empty() ? "go" : catalogue_.events[0]);
  }
  return request;
}

}  // namespace footfall::tests
