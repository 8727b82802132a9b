// The backend without physics, as a world and a robot describe it.
#pragma once

#include <string>

#include "hal/backends/stub.h"
#include "sim/world/description.h"

namespace footfall::apps {

// The world of a run on the stand to which none was given, which has series-elastic actuators
// without imperfections: ideal ones for a robot that has no others.
sim::WorldDescription stand_world(sim::WorldDescription world,
                                  const model::RobotDescription& robot);

// Steps of the plant in a tick: one for each of the torque loops.
int stand_steps(const sim::WorldDescription& world, const model::RobotDescription& robot);

hal::StubSettings stub_settings(const model::RobotDescription& robot,
                                const sim::WorldDescription& world);
std::string stub_facts(const sim::WorldDescription& world);  // for the summary's `physics`

}  // namespace footfall::apps
