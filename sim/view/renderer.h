// Pictures of a robot without a window: MuJoCo's renderer on EGL, given joint configurations. After
// or beside a run; it has a model and data of its own and never steps.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/view/image.h"

namespace footfall::sim {

// An arrow in the picture, e.g. the force of the ground on a foot.
struct FilmArrow {
  std::array<double, 3> from{};   // m, world
  std::array<double, 3> force{};  // N, world; 200 N are drawn 0.4 m long
};

// One picture.
struct FilmFrame {
  std::vector<double> qpos;  // as FilmRenderer::place fills it
  std::string title;         // upper left, e.g. the time
  std::string caption;       // below it, e.g. the state
  std::vector<FilmArrow> arrows;
};

// Fine has four samples a pixel and shadows; fast is several times as quick, for movies.
enum class FilmQuality { fine, fast };

class FilmRenderer {
 public:
  // mjcf: path of a robot's model, which gets a floor, a sky and lights. Throws std::runtime_error
  // with one sentence: no such model, or no EGL.
  FilmRenderer(const std::string& mjcf, int width, int height,
               FilmQuality quality = FilmQuality::fine);
  ~FilmRenderer();
  FilmRenderer(FilmRenderer&&) noexcept;
  FilmRenderer& operator=(FilmRenderer&&) noexcept;

  // Configuration of the model as its file has it.
  std::vector<double> neutral() const;
  // Base position (m, world) and orientation (roll, pitch, yaw: R = Rz Ry Rx, rad) into `qpos`.
  // Without a free joint in the model nothing happens.
  void place_base(std::span<const double, 3> position, std::span<const double, 3> rpy,
                  std::vector<double>& qpos) const;
  // Where a joint's position is in qpos, -1 if there is no such joint.
  int joint_address(std::string_view name) const;

  // Draws one frame; the camera follows the base, three-quarter from the front.
  Image render(const FilmFrame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Pictures of equal size side by side, `columns` in a row.
Image film_strip(std::span<const Image> pictures, int columns);

// The MJCF of the robot in `mjcf` on a checkered floor under a light sky.
std::string film_scene(const std::string& mjcf, FilmQuality quality);

}  // namespace footfall::sim
