// The signals of all behaviors as patterns: `joint.JOINT.position`. Part of the reference.
#pragma once

#include <string>

namespace footfall::apps {

std::string signals_markdown();

}  // namespace footfall::apps
