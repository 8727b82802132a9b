// The parts of a sweep file that define values: `vary`, `zip`, `sample`. See loader.h.
#pragma once

#include "core/yaml/yaml.h"
#include "lab/sweep/plan/sweep.h"

namespace footfall::lab {

void read_sweep_vary(const core::YamlNode& node, SweepDescription& sweep,
                     core::Diagnostics& diagnostics);
void read_sweep_zip(const core::YamlNode& node, SweepDescription& sweep,
                    core::Diagnostics& diagnostics);
void read_sweep_sample(const core::YamlNode& node, SweepDescription& sweep,
                       core::Diagnostics& diagnostics);

}  // namespace footfall::lab
