// The loop that a task closes over series-elastic actuators, as a linear map from tick to tick:
// links, springs, rotors, torque loops, encoders' rates, delays and the task's law. From its
// equations, not from the simulator's code; docs/impedance.md derives it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hal/actuators/drive.h"

namespace footfall::tests {

// The law: τ = T u, u = kp e + ki ∫e dt − kd J q̇, e = −J q about the posture; once a period.
struct SampledLaw {
  Eigen::MatrixXd rows;    // J, rows x velocities
  Eigen::MatrixXd torque;  // T, joints x rows: from accelerations to torques
  Eigen::VectorXd kp, ki, kd;
  // Periods by which J q, J q̇ reach the law later than they are measured.
  int position_delay = 0, velocity_delay = 0;
};

// Velocities n, of them the joints' last m. Of the torque loops: `direct` without i and observer.
// Friction, saturation and resolutions are no part of it.
struct SampledPlant {
  Eigen::MatrixXd inertia;             // of the links, n x n
  Eigen::MatrixXd damping, stiffness;  // of external aids, n x n
  hal::DriveSettings drive;            // its command_delay in steps
  int steps_per_period = 1;            // of the drive
};

// By what factor an error grows from a tick to the next, in the long run: the spectral radius.
// Throws std::invalid_argument for torque loops beyond those above.
double sampled_growth(const SampledPlant& plant, const SampledLaw& law);

// The largest kp of `row`, up to `most`, below which every kp is stable: the first that is not is
// sought on a grid of ratio 1.05 from most/1e4 on, then halved to 0.1 %. 0: none is stable.
double largest_stable_kp(const SampledPlant& plant, SampledLaw law, int row, double most);

}  // namespace footfall::tests
