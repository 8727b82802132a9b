// MJCF from memory through MuJoCo's virtual file system; see mjcf.h.
#include "model/mjcf.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "core/realtime/mujoco_errors.h"

namespace footfall::model {
namespace {

struct VfsDeleter {
  void operator()(mjVFS* vfs) const {
    mj_deleteVFS(vfs);
    delete vfs;
  }
};

[[noreturn]] void refuse(const std::string& what, const char* reason) {
  std::string text = reason;
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  throw std::runtime_error(what + ": error: MuJoCo refuses it: " + text);
}

}  // namespace

mjModel_* compile_mjcf(const std::string& xml, const std::string& what) {
  core::install_mujoco_error_handlers();
  std::unique_ptr<mjVFS, VfsDeleter> vfs(new mjVFS);
  mj_defaultVFS(vfs.get());
  mj_makeEmptyFileVFS(vfs.get(), "scene.xml", static_cast<int>(xml.size()));
  const int index = mj_findFileVFS(vfs.get(), "scene.xml");
  std::memcpy(vfs->filedata[index], xml.data(), xml.size());
  std::array<char, 1024> error{};
  mjModel* m = mj_loadXML("scene.xml", vfs.get(), error.data(), static_cast<int>(error.size()));
  if (!m) refuse(what, error.data());
  return m;
}

mjModel_* load_whole_model(const std::string& model_path) {
  return compile_mjcf(
      "<mujoco><include file=\"" + model_path + "\"/><compiler discardvisual=\"false\"/></mujoco>",
      model_path);
}

mjModel_* load_robot_model(const std::string& model_path) {
  mjModel* const m = compile_mjcf(
      "<mujoco><compiler discardvisual=\"true\"/><include file=\"" + model_path + "\"/></mujoco>",
      model_path);
  use_own_settings(*m);
  return m;
}

void use_own_settings(mjModel& m) {
  const mjOption set = m.opt;
  mj_defaultOption(&m.opt);
  m.opt.timestep = set.timestep;
  m.opt.integrator = set.integrator;
  m.opt.solver = set.solver;
  m.opt.cone = set.cone;
  m.opt.impratio = set.impratio;
  m.opt.iterations = set.iterations;
  m.opt.tolerance = set.tolerance;
}

std::vector<std::string> body_names(const std::string& model_path) {
  const std::unique_ptr<mjModel, decltype(&mj_deleteModel)> m(load_robot_model(model_path),
                                                              mj_deleteModel);
  std::vector<std::string> names;
  for (int body = 1; body < m->nbody; ++body) {
    const char* name = mj_id2name(m.get(), mjOBJ_BODY, body);
    if (name != nullptr && *name != '\0') names.emplace_back(name);
  }
  return names;
}

}  // namespace footfall::model
