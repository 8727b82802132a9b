// Contact forces that bear the robot at rest and lie near the contacts' normals: the references of
// internal forces by statics ([Kim16] IV-A, method 1). Pure function of the model's pose.
#pragma once

#include "model/control_model.h"

namespace footfall::tasks {

// Writes 3 x count forces, N, ground on robot, world axes: of all that balance the weight, those of
// least  Σ |tangential_i|² / N_i²  over the contacts, whatever the friction, with N_i fixed: the
// normal forces of the result itself, found by iteration. (Not the least of that sum with N_i free,
// which would press harder where that makes a share smaller.) A moment that the contacts cannot
// give, about the line of two, is left out. Allocates nothing.
void static_forces(const model::ControlModel& model, const int* contacts, int count,
                   double* forces) noexcept;

}  // namespace footfall::tasks
