// MuJoCo's renderer without a window; see renderer.h.
#include "sim/view/renderer.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "model/mjcf.h"
#include "sim/view/egl_context.h"

namespace footfall::sim {
namespace {

constexpr int kMaxGeoms = 2000;
constexpr double kArrowScale = 0.4 / 200.0;  // m/N
constexpr double kArrowMinimum = 5.0;        // N; shorter arrows would only be specks
constexpr double kCameraAzimuth = 145.0;     // deg; from the front, slightly from the right
constexpr double kCameraElevation = -10.0;   // deg
constexpr double kViewHeight = 1.72;         // m, height of the visible area at the robot
constexpr std::array<float, 3> kInk = {0.10F, 0.13F, 0.17F};

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

void add_arrow(mjvScene& scene, const FilmArrow& arrow) {
  const double force = std::hypot(arrow.force[0], arrow.force[1], arrow.force[2]);
  if (scene.ngeom >= scene.maxgeom || force < kArrowMinimum) return;
  mjvGeom& geom = scene.geoms[scene.ngeom++];
  constexpr std::array<float, 4> kColour = {0.90F, 0.35F, 0.10F, 1.0F};
  mjv_initGeom(&geom, mjGEOM_ARROW, nullptr, nullptr, nullptr, kColour.data());
  std::array<double, 3> to{};
  for (std::size_t i = 0; i < 3; ++i) to[i] = arrow.from[i] + kArrowScale * arrow.force[i];
  mjv_makeConnector(&geom, mjGEOM_ARROW, 0.014, arrow.from[0], arrow.from[1], arrow.from[2], to[0],
                    to[1], to[2]);
  geom.size[2] *= 2.0F;  // MuJoCo draws an arrow half as long as its connector
}

std::string boxes_xml(const model::Terrain& terrain) {
  std::string xml;
  for (const model::TerrainPiece& box : terrain.boxes) {
    const auto& R = box.R_WP;
    xml += fmt::format(
        "<geom type=\"box\" pos=\"{} {} {}\" size=\"{} {} {}\" xyaxes=\"{} {} {} {} {} {}\" "
        "rgba=\"0.62 0.66 0.70 1\" contype=\"0\" conaffinity=\"0\"/>\n",
        box.centre[0], box.centre[1], box.centre[2], box.half[0], box.half[1], box.half[2], R[0],
        R[3], R[6], R[1], R[4], R[7]);
  }
  return xml;
}

}  // namespace

std::string film_scene(const std::string& mjcf, FilmQuality quality,
                       const model::Terrain& terrain) {
  const bool fine = quality == FilmQuality::fine;
  return std::string(R"(<mujoco model="film">
  <compiler autolimits="true"/>
  <include file=")") +
         std::filesystem::absolute(mjcf).string() + R"("/>
  <visual>
    <headlight ambient="0.42 0.43 0.45" diffuse="0.30 0.30 0.30" specular="0.05 0.05 0.05"/>
    <quality shadowsize=")" +
         (fine ? "4096" : "1024") + R"(" offsamples=")" + (fine ? "4" : "0") + R"("/>
    <map znear="0.02" zfar="40" fogstart="4" fogend="14" shadowclip="2.0"/>
    <rgba haze="0.90 0.93 0.96 1" fog="0.90 0.93 0.96 1"/>
  </visual>
  <asset>
    <texture name="film_sky" type="skybox" builtin="gradient" rgb1="0.74 0.82 0.90"
             rgb2="0.97 0.98 0.99" width="256" height="256"/>
    <texture name="film_floor" type="2d" builtin="checker" rgb1="0.80 0.83 0.86"
             rgb2="0.70 0.74 0.78" mark="edge" markrgb="0.86 0.88 0.90" width="512" height="512"/>
    <material name="film_floor" texture="film_floor" texrepeat="2 2" texuniform="true"
              specular="0.1" shininess="0.1" reflectance="0.08"/>
  </asset>
  <worldbody>
    <light name="film_sun" directional="true" pos="1 -1.5 4" dir="-0.25 0.45 -1"
           diffuse="0.55 0.54 0.50" specular="0.25 0.25 0.25" castshadow="true"/>
    <light name="film_sky" directional="true" pos="-1 2 3" dir="0.4 -0.6 -0.5"
           diffuse="0.16 0.18 0.22" specular="0 0 0" castshadow="false"/>
    <geom name="film_floor" type="plane" size="0 0 0.05" material="film_floor" contype="0"
          conaffinity="0"/>
)" + boxes_xml(terrain) +
         R"(  </worldbody>
</mujoco>
)";
}

struct FilmRenderer::Impl {
  FilmContext gl;
  std::unique_ptr<mjModel, DeleteModel> model;
  std::unique_ptr<mjData, DeleteData> data;
  mjvScene scene{};
  mjvOption option{};
  mjvCamera camera{};
  mjrContext render{};
  mjrRect viewport{};
  bool level = true;  // no terrain
  int free_joint = -1;
  std::vector<std::uint8_t> bottom_up;

  Impl(const std::string& mjcf, int width, int height, FilmQuality quality,
       const model::Terrain& terrain)
      : model(model::compile_mjcf(film_scene(mjcf, quality, terrain), mjcf)),
        viewport{0, 0, width, height},
        level(terrain.boxes.empty()) {
    model->vis.global.offwidth = width;
    model->vis.global.offheight = height;
    data.reset(mj_makeData(model.get()));
    for (int i = 0; i < model->njnt && free_joint < 0; ++i) {
      if (model->jnt_type[i] == mjJNT_FREE) free_joint = i;
    }
    mjv_defaultOption(&option);
    option.sitegroup[4] = 0;
    option.geomgroup[3] = 0;  // hide collision-only shapes
    mjv_defaultCamera(&camera);
    mjv_defaultScene(&scene);
    mjv_makeScene(model.get(), &scene, kMaxGeoms);
    scene.flags[mjRND_FOG] = 1;
    scene.flags[mjRND_REFLECTION] = quality == FilmQuality::fine ? 1 : 0;
    scene.flags[mjRND_SHADOW] = quality == FilmQuality::fine ? 1 : 0;
    mjr_defaultContext(&render);
    mjr_makeContext(model.get(), &render, width > 500 ? mjFONTSCALE_150 : mjFONTSCALE_100);
    mjr_setBuffer(mjFB_OFFSCREEN, &render);
    bottom_up.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    // The first picture of a context differs from all later ones in a few shades: discard it.
    draw({});
  }
  ~Impl() {
    gl.make_current();
    mjr_freeContext(&render);
    mjv_freeScene(&scene);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void aim() {
    const int body = free_joint >= 0 ? model->jnt_bodyid[free_joint] : 0;
    const double half_angle = 0.5 * static_cast<double>(model->vis.global.fovy) * mjPI / 180.0;
    camera.type = mjCAMERA_FREE;
    camera.lookat[0] = data->xpos[3 * body];
    camera.lookat[1] = data->xpos[3 * body + 1];
    camera.lookat[2] = 0.41 * kViewHeight;
    // On terrain a robot may stand higher.
    if (!level) camera.lookat[2] = std::max(camera.lookat[2], data->xpos[3 * body + 2] - 0.1);
    camera.distance = 0.5 * kViewHeight / std::tan(half_angle);
    camera.azimuth = kCameraAzimuth;
    camera.elevation = kCameraElevation;
  }

  // Draws the configuration in `data` into the offscreen buffer.
  void draw(std::span<const FilmArrow> arrows) {
    mj_kinematics(model.get(), data.get());
    mj_comPos(model.get(), data.get());
    mj_camlight(model.get(), data.get());
    aim();
    mjv_updateScene(model.get(), data.get(), &option, nullptr, &camera, mjCAT_ALL, &scene);
    for (const FilmArrow& arrow : arrows) add_arrow(scene, arrow);
    mjr_render(viewport, &scene, &render);
  }

  // Dark letters on the sky; lines are numbered from the top.
  void write(const std::string& text, int line) {
    const auto width = static_cast<float>(viewport.width);
    const auto height = static_cast<float>(viewport.height);
    const float below =
        1.15F * static_cast<float>(render.charHeight) * static_cast<float>(line + 1);
    mjr_text(mjFONT_NORMAL, text.c_str(), &render, 8.0F / width, 1.0F - below / height, kInk[0],
             kInk[1], kInk[2]);
  }
};

FilmRenderer::FilmRenderer(const std::string& mjcf, int width, int height, FilmQuality quality,
                           const model::Terrain& terrain) {
  if (!std::filesystem::is_regular_file(mjcf)) {
    throw std::runtime_error("cannot render '" + mjcf + "': no such file");
  }
  impl_ = std::make_unique<Impl>(mjcf, width, height, quality, terrain);
}
FilmRenderer::~FilmRenderer() = default;
FilmRenderer::FilmRenderer(FilmRenderer&&) noexcept = default;
FilmRenderer& FilmRenderer::operator=(FilmRenderer&&) noexcept = default;

std::vector<double> FilmRenderer::neutral() const {
  const mjModel& model = *impl_->model;
  return {model.qpos0, model.qpos0 + model.nq};
}

void FilmRenderer::place_base(std::span<const double, 3> position, std::span<const double, 3> rpy,
                              std::vector<double>& qpos) const {
  if (impl_->free_joint < 0) return;
  const auto at = static_cast<std::size_t>(impl_->model->jnt_qposadr[impl_->free_joint]);
  std::copy(position.begin(), position.end(), qpos.begin() + static_cast<std::ptrdiff_t>(at));
  const double cr = std::cos(rpy[0] / 2), sr = std::sin(rpy[0] / 2);
  const double cp = std::cos(rpy[1] / 2), sp = std::sin(rpy[1] / 2);
  const double cy = std::cos(rpy[2] / 2), sy = std::sin(rpy[2] / 2);
  qpos[at + 3] = cr * cp * cy + sr * sp * sy;
  qpos[at + 4] = sr * cp * cy - cr * sp * sy;
  qpos[at + 5] = cr * sp * cy + sr * cp * sy;
  qpos[at + 6] = cr * cp * sy - sr * sp * cy;
}

int FilmRenderer::joint_address(std::string_view name) const {
  const int joint = mj_name2id(impl_->model.get(), mjOBJ_JOINT, std::string(name).c_str());
  return joint < 0 ? -1 : impl_->model->jnt_qposadr[joint];
}

Image FilmRenderer::render(const FilmFrame& frame) {
  Impl& me = *impl_;
  me.gl.make_current();
  const std::size_t n = std::min(frame.qpos.size(), static_cast<std::size_t>(me.model->nq));
  std::copy_n(frame.qpos.begin(), n, me.data->qpos);
  me.draw(frame.arrows);
  me.write(frame.title, 0);
  me.write(frame.caption, 1);
  mjr_readPixels(me.bottom_up.data(), nullptr, me.viewport, &me.render);

  Image image(me.viewport.width, me.viewport.height);
  const std::size_t row = 3 * static_cast<std::size_t>(image.width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
    const std::size_t from = static_cast<std::size_t>(image.height) - 1 - y;
    std::copy_n(me.bottom_up.data() + from * row, row, image.rgb.data() + y * row);
  }
  return image;
}

Image film_strip(std::span<const Image> pictures, int columns) {
  if (pictures.empty() || columns < 1) return {};
  constexpr int kGap = 4;
  const int rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
  const int width = pictures[0].width + kGap, height = pictures[0].height + kGap;
  Image strip(std::min(columns, static_cast<int>(pictures.size())) * width - kGap,
              rows * height - kGap);
  for (int i = 0; i < static_cast<int>(pictures.size()); ++i) {
    strip.paste(pictures[static_cast<std::size_t>(i)], i % columns * width, i / columns * height);
  }
  return strip;
}

}  // namespace footfall::sim
