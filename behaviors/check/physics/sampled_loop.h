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

// The loop of a measured force: F = F_ref + K (F_ref - y), y the force of `periods` periods before
// through a first-order low-pass of `bandwidth` (Hz, 0: none), torques held as commanded:
//   z^n - a z^(n-1) + K (1 - a) = 0,  a = exp(-2 pi B T)
// The smallest K > 0 from which an error no longer dies out: (1 + a)/(1 - a) for n = 1; else
// |exp(i t) - a|/(1 - a) at the least t in (0, pi) with (n - 1) t + arg(exp(i t) - a) = pi.
double force_feedback_limit(double bandwidth, double period, int periods);

}  // namespace footfall::behaviors
