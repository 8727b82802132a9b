// Objects of the compiled model and their elements; see context.h.
#include "model/check/context.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/index.h"

namespace footfall::model {
namespace {

int count(const mjModel& m, mjtObj type) {
  switch (type) {
    case mjOBJ_BODY:
      return m.nbody;
    case mjOBJ_JOINT:
      return m.njnt;
    case mjOBJ_GEOM:
      return m.ngeom;
    case mjOBJ_SITE:
      return m.nsite;
    case mjOBJ_ACTUATOR:
      return m.nu;
    case mjOBJ_TENDON:
      return m.ntendon;
    case mjOBJ_EQUALITY:
      return m.neq;
    default:
      return 0;
  }
}

}  // namespace

ModelContext::ModelContext(const mjModel& model, const RobotDescription& described,
                           const MjcfSource& text, core::Diagnostics& diagnostics)
    : m(model), robot(described), source(text), diagnostics_(diagnostics) {
  bodies_ = source.bodies();
  const auto worlds = source.sections("worldbody");
  // MuJoCo numbers by body, within a body as written; all <worldbody> are one body.
  const auto take = [this](const MjcfElement& body) {
    for (const MjcfElement* child : body.children) {
      if (child->tag == "joint" || child->tag == "freejoint") joints_.push_back(child);
      if (child->tag == "geom") geoms_.push_back(child);
      if (child->tag == "site") sites_.push_back(child);
    }
  };
  for (const MjcfElement* world : worlds) take(*world);
  for (const MjcfElement* body : bodies_) {
    if (body->tag == "body") take(*body);
  }
  actuators_ = source.section("actuator");
  tendons_ = source.section("tendon");
  equalities_ = source.section("equality");
}

const std::vector<const MjcfElement*>& ModelContext::list(mjtObj type) const {
  switch (type) {
    case mjOBJ_BODY:
      return bodies_;
    case mjOBJ_JOINT:
      return joints_;
    case mjOBJ_GEOM:
      return geoms_;
    case mjOBJ_SITE:
      return sites_;
    case mjOBJ_ACTUATOR:
      return actuators_;
    case mjOBJ_TENDON:
      return tendons_;
    case mjOBJ_EQUALITY:
      return equalities_;
    default:
      return none_;
  }
}

const MjcfElement* ModelContext::element(mjtObj type, int id) const {
  const auto& elements = list(type);
  const char* const given = mj_id2name(&m, type, id);
  if (given != nullptr && *given != '\0') {
    const auto found = std::ranges::find_if(elements, [given](const MjcfElement* e) {
      const MjcfAttribute* const name = e->find("name");
      return name != nullptr && name->value == given;
    });
    if (found != elements.end()) return *found;
  }
  // Objects that MuJoCo generates (<composite>) would shift the numbers.
  const bool same = std::cmp_equal(elements.size(), count(m, type));
  return same && id >= 0 ? elements[at(id)] : nullptr;
}

MjcfPlace ModelContext::place(mjtObj type, int id, std::string_view attribute) const {
  const MjcfElement* const e = element(type, id);
  if (e == nullptr) return {};
  return attribute.empty() ? e->place : source.find(*e, attribute);
}

std::string ModelContext::name(mjtObj type, int id) const {
  const char* const given = mj_id2name(&m, type, id);
  if (given != nullptr && *given != '\0') return fmt::format("'{}'", given);
  return fmt::format("number {}", id + 1);
}

const JointDescription* ModelContext::joint(int id) const {
  const char* const given = mj_id2name(&m, mjOBJ_JOINT, id);
  const int index = given == nullptr ? -1 : robot.find_joint(given);
  return index < 0 ? nullptr : &robot.joints[at(index)];
}

std::vector<int> ModelContext::balls() const {
  std::vector<int> out;
  for (const ContactDescription& contact : robot.contacts) {
    const int site = mj_name2id(&m, mjOBJ_SITE, contact.site.c_str());
    int ball = -1;
    for (int g = 0; site >= 0 && g < m.ngeom && ball < 0; ++g) {
      if (m.geom_bodyid[g] != m.site_bodyid[site] || m.geom_type[g] != mjGEOM_SPHERE) continue;
      if (mju_dist3(m.geom_pos + 3 * g, m.site_pos + 3 * site) < 1e-6) ball = g;
    }
    out.push_back(ball);
  }
  return out;
}

core::Mark ModelContext::mark(MjcfPlace place) const {
  const auto& files = source.files();
  const std::string& file = files.empty() ? robot.model_path : files[at(place.file)];
  return {diagnostics_.add_file(file), place.line, place.column};
}

void ModelContext::refuse(MjcfPlace place, std::string text) {
  diagnostics_.error(mark(place), "model", std::move(text));
}

void ModelContext::warn(MjcfPlace place, std::string text) {
  diagnostics_.warning(mark(place), "simulator-only", std::move(text));
}

}  // namespace footfall::model
