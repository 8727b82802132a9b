// The catalogue of what can be changed, and of the names of what is told.
#pragma once

#include "behaviors/compiled/behavior.h"

namespace footfall_lcm {
class catalogue_t;
}

namespace footfall::engine {

struct LiveNames;

// All that the behavior says; session, revision and the like are left to the server.
void fill_names(const behaviors::Behavior& behavior, const LiveNames& names,
                footfall_lcm::catalogue_t& catalogue);

}  // namespace footfall::engine
