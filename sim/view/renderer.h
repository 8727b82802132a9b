// Renders pictures of a robot without a window: MuJoCo's renderer on EGL, for given joint
// configurations. After or beside a run; has its own model and data and never steps.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/terrain.h"
#include "sim/view/image.h"

namespace footfall::sim {

// An arrow in the picture, e.g. the force of the ground on a foot.
struct FilmArrow {
  std::array<double, 3> from{};   // m, world
  std::array<double, 3> force{};  // N, world; 200 N are drawn 0.4 m long
};

// One picture.
struct FilmFrame {
  std::vector<double> qpos;  // filled by FilmRenderer's place functions
  std::string title;         // upper left, e.g. the time
  std::string caption;       // below it, e.g. the state
  std::vector<FilmArrow> arrows;
};

// Fine has four samples a pixel and shadows; fast is several times as fast, for movies.
enum class FilmQuality { fine, fast };

class FilmRenderer {
 public:
  // mjcf: path of a robot's model; a floor with its terrain, a sky and lights are added. Throws
  // std::runtime_error with one sentence if the model or EGL is not available.
  FilmRenderer(const std::string& mjcf, int width, int height,
               FilmQuality quality = FilmQuality::fine, const model::Terrain& terrain = {});
  ~FilmRenderer();
  FilmRenderer(FilmRenderer&&) noexcept;
  FilmRenderer& operator=(FilmRenderer&&) noexcept;

  // The model's default configuration (qpos0).
  std::vector<double> neutral() const;
  // Writes base position (m, world) and orientation (roll, pitch, yaw: R = Rz Ry Rx, rad) into
  // `qpos`. No effect for a model without free joint.
  void place_base(std::span<const double, 3> position, std::span<const double, 3> rpy,
                  std::vector<double>& qpos) const;
  // Index of a joint's position in qpos, -1 if absent.
  int joint_address(std::string_view name) const;

  // Renders one frame; the camera follows the base, three-quarter from the front.
  Image render(const FilmFrame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Pictures of equal size side by side, `columns` in a row.
Image film_strip(std::span<const Image> pictures, int columns);

// The robot of the file `mjcf` on a checkered floor under a light sky, as MJCF.
std::string film_scene(const std::string& mjcf, FilmQuality quality,
                       const model::Terrain& terrain = {});

}  // namespace footfall::sim
