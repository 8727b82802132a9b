// Registry of signals; see signal_table.h.
#include "core/signal_table.h"

#include <utility>

namespace footfall::core {

int SignalTable::add(std::string name, Dimension dimension, std::string doc) {
  const auto found = index_.find(name);
  if (found != index_.end()) return found->second;
  const int index = size();
  index_.emplace(name, index);
  infos_.push_back({std::move(name), dimension, std::move(doc)});
  values_.push_back(0.0);
  return index;
}

int SignalTable::find(std::string_view name) const {
  const auto found = index_.find(std::string(name));
  return found == index_.end() ? -1 : found->second;
}

}  // namespace footfall::core
