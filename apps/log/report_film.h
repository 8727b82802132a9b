// Pictures of a run from its log: joint positions of the log on the model that the run used.
#pragma once

#include <string>
#include <vector>

#include "lab/log/reader.h"
#include "sim/view/renderer.h"

namespace footfall::apps {

// Path of the MJCF that the log names. Throws std::runtime_error if it names none or it is gone.
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

// A strip of two rows of eight pictures: the last steps, at equal times over the time they took;
// the whole run where there are no steps. Throws std::runtime_error (no EGL, no model).
sim::Image film_strip(const lab::Log& log);

// The whole run at 30 pictures a second. Throws std::runtime_error (no EGL, no ffmpeg, no model).
void write_film(const lab::Log& log, const std::string& path);

}  // namespace footfall::apps
