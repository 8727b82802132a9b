// One row per estimator; see catalogue.h.
#include "engine/estimators/catalogue.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "core/diagnostics/did_you_mean.h"
#include "engine/estimators/true_state.h"

namespace footfall::engine {
namespace {

using Factory = std::unique_ptr<Estimator> (*)(const model::RobotDescription& robot);

template <class T>
std::unique_ptr<Estimator> make(const model::RobotDescription& robot) {
  return std::make_unique<T>(robot);
}

struct Row {
  std::string_view name;
  Factory make;
};

constexpr std::array kEstimators = {
    Row{"true_state", make<TrueState>},
};

}  // namespace

std::unique_ptr<Estimator> make_estimator(std::string_view name,
                                          const model::RobotDescription& robot) {
  for (const Row& row : kEstimators) {
    if (row.name == name) return row.make(robot);
  }
  throw std::runtime_error(fmt::format("unknown estimator '{}'{}", name,
                                       core::did_you_mean_or_list(name, estimator_names())));
}

std::vector<std::string> estimator_names() {
  std::vector<std::string> names;
  for (const Row& row : kEstimators) names.emplace_back(row.name);
  return names;
}

}  // namespace footfall::engine
