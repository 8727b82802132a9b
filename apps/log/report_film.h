// Pictures of a run from its log: logged joint positions on the robot model of the run.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lab/log/reader.h"
#include "sim/view/renderer.h"

namespace footfall::apps {

// Path of the MJCF named in the log. Throws std::runtime_error if there is none or it was deleted.
std::string film_model(const lab::Log& log);

// The frame of one row: configuration, time, state and contact forces.
class LoggedPose {
 public:
  LoggedPose(const lab::Log& log, const sim::FilmRenderer& renderer);
  sim::FilmFrame frame(std::size_t row) const;

 private:
  struct Joint {
    const std::vector<float>* column;
    std::size_t address;
  };
  struct Foot {
    std::array<const std::vector<float>*, 3> point, force;
  };
  const lab::Log& log_;
  const sim::FilmRenderer& renderer_;
  std::vector<Joint> joints_;
  std::vector<Foot> feet_;
};

// Pictures of the run at these times, s, in rows of lab::kStripColumns. Throws std::runtime_error
// (no EGL, no model, no rows).
sim::Image film_strip(const lab::Log& log, std::span<const double> times);

// The whole run at 30 frames per second. Throws std::runtime_error (no EGL, no ffmpeg, no model).
void write_film(const lab::Log& log, const std::string& path);

}  // namespace footfall::apps
