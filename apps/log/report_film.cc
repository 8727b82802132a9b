// Pictures of a run from its log; see report_film.h.
#include "apps/log/report_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "lab/report/data.h"
#include "lab/report/strip.h"
#include "lab/run/log_setup.h"
#include "sim/view/video.h"

namespace footfall::apps {
namespace {

constexpr int kPictureWidth = 240, kPictureHeight = 340;
constexpr int kFilmWidth = 480, kFilmHeight = 600;
constexpr double kFilmRate = 30.0;

std::array<const std::vector<float>*, 3> xyz(const lab::Log& log, const std::string& stem,
                                             const std::array<const char*, 3>& axes = {"x", "y",
                                                                                       "z"}) {
  std::array<const std::vector<float>*, 3> columns{};
  for (std::size_t i = 0; i < 3; ++i) columns[i] = log.values(stem + "." + axes[i]);
  return columns;
}

std::array<double, 3> at(const std::array<const std::vector<float>*, 3>& columns, std::size_t row) {
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (columns[i] != nullptr) values[i] = static_cast<double>((*columns[i])[row]);
  }
  return values;
}

std::size_t row_at(const lab::Log& log, double time) {
  const auto found = std::ranges::lower_bound(log.time, time);
  return std::min(static_cast<std::size_t>(found - log.time.begin()), log.rows() - 1);
}

}  // namespace

std::string film_model(const lab::Log& log) {
  const std::string path = log.get("model");
  if (log.rows() == 0) throw std::runtime_error("the log has no rows");
  if (path.empty()) throw std::runtime_error("the log does not name the robot's model");
  if (!std::filesystem::is_regular_file(path)) {
    throw std::runtime_error("the robot's model '" + path + "' is gone");
  }
  return path;
}

LoggedPose::LoggedPose(const lab::Log& log, const sim::FilmRenderer& renderer)
    : log_(log), renderer_(renderer) {
  for (const std::string& joint : lab::parts(log, "joint.", ".position")) {
    const int address = renderer.joint_address(joint);
    if (address < 0) continue;
    joints_.push_back(
        {log.values("joint." + joint + ".position"), static_cast<std::size_t>(address)});
  }
  for (const std::string& foot : lab::parts(log, "contact.", "")) {
    feet_.push_back({xyz(log, "point." + foot), xyz(log, "force." + foot)});
  }
}

sim::FilmFrame LoggedPose::frame(std::size_t row) const {
  sim::FilmFrame frame{renderer_.neutral(),
                       fmt::format("{:.3f} s", log_.time[row]),
                       lab::state_caption(lab::state_path(log_, row)),
                       {}};
  const std::array<double, 3> position = at(xyz(log_, "base.pos"), row);
  const std::array<double, 3> rpy = at(xyz(log_, "base.rpy", {"roll", "pitch", "yaw"}), row);
  if (log_.values("base.pos.x") != nullptr) renderer_.place_base(position, rpy, frame.qpos);
  for (const Joint& joint : joints_) {
    frame.qpos[joint.address] = static_cast<double>((*joint.column)[row]);
  }
  for (const Foot& foot : feet_) frame.arrows.push_back({at(foot.point, row), at(foot.force, row)});
  return frame;
}

sim::Image film_strip(const lab::Log& log, std::span<const double> times) {
  sim::FilmRenderer renderer(film_model(log), kPictureWidth, kPictureHeight, sim::FilmQuality::fine,
                             lab::grounds_of(log.setup).truth);
  const LoggedPose pose(log, renderer);
  std::vector<sim::Image> pictures;
  for (const double time : times) {
    pictures.push_back(renderer.render(pose.frame(row_at(log, time))));
  }
  return sim::film_strip(pictures, lab::kStripColumns);
}

void write_film(const lab::Log& log, const std::string& path) {
  sim::FilmRenderer renderer(film_model(log), kFilmWidth, kFilmHeight, sim::FilmQuality::fast,
                             lab::grounds_of(log.setup).truth);
  const LoggedPose pose(log, renderer);
  sim::MovieWriter movie(path, kFilmWidth, kFilmHeight, kFilmRate);
  const auto frames = static_cast<int>((log.time.back() - log.time.front()) * kFilmRate) + 1;
  for (int i = 0; i < frames; ++i) {
    movie.add(renderer.render(pose.frame(row_at(log, log.time.front() + i / kFilmRate))));
  }
  movie.finish();
}

}  // namespace footfall::apps
