// The loop that one axis of a task closes: a double integrator, whose acceleration is commanded
// once a period, held, and perhaps late. Pure functions. Load time only.
//
//   ẍ = u(t - delay),   u = -kp x - kd ẋ - ki ∫x dt   at t = k T, held until (k + 1) T
//
// A task that has its rank is this system (tasks/task_law.h: what is commanded is what is
// accelerated). Without integral and delay it is stable exactly if
//   kd T < 2                                held over the period; kd > kp T / 2
//   kd T + kp T^2 / 2 < 2                   semi-implicit Euler, one step a period
// and for T -> 0 with an integral if ki < kp kd.
#pragma once

namespace footfall::behaviors {

struct SampledLoop {
  double kp = 0.0, ki = 0.0, kd = 0.0;  // 1/s^2, 1/s^3, 1/s
  double period = 0.0;                  // s
  // Steps of the physics a period, semi-implicit Euler as in simulation; `exact`: integrated
  // exactly, as a robot does.
  int steps = 1;
  bool exact = false;
  double delay = 0.0;  // s, from the command to the torque, rounded to steps
  // What is measured is a rate: ẋ = u, kd on its error, kp on the error's integral.
  bool is_rate = false;
};

// By what factor the loop's error grows in a period, in the long run: the spectral radius of its
// period-to-period map. At most 1: it does not grow.
double growth(const SampledLoop& loop);

}  // namespace footfall::behaviors
