// The catalogue of a run: everything that can be changed, and names of reported quantities.
#pragma once

#include "behaviors/compiled/behavior.h"

namespace footfall_lcm {
class catalogue_t;
}

namespace footfall::engine {

struct LiveNames;

// Fills everything that depends on the behavior; session, revision etc. are filled by the server.
void fill_names(const behaviors::Behavior& behavior, const LiveNames& names,
                footfall_lcm::catalogue_t& catalogue);

}  // namespace footfall::engine
