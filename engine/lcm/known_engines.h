// The engines that a client heard, and whether messages fit the catalogue of theirs.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "engine/lcm/client.h"

namespace footfall::engine {

class KnownEngines {
 public:
  // An engine by its catalogue; `usable`: it has the client's key.
  void note(const footfall_lcm::catalogue_t& message, bool usable);
  // A session that was heard; its catalogue may come.
  void note(std::int64_t session);
  // Whether every session heard has said who it is.
  bool all_named() const { return nameless_.empty(); }
  // Oldest first.
  std::vector<EngineIdentity> list() const;

 private:
  std::map<std::int64_t, EngineIdentity> engines_;  // by session
  std::set<std::int64_t> nameless_;
};

// Whether indices and sizes are consistent, so that they can be used as such.
bool fits(const footfall_lcm::catalogue_t& catalogue);
bool fits(const footfall_lcm::values_t& values, const footfall_lcm::catalogue_t& catalogue);
bool fits(const footfall_lcm::telemetry_t& telemetry, const footfall_lcm::catalogue_t& catalogue);

}  // namespace footfall::engine
