// Feet that must meet the ground as the world says, and masses of shapes that physics leaves out.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "model/check/context.h"

namespace footfall::model {
namespace {

// Ground and terrain have MuJoCo's default bits and this priority; see sim/scene.cc.
constexpr int kGroundBits = 1;
constexpr int kGroundPriority = 1;

bool collides(const mjModel& m, int g) {
  return m.geom_contype[g] != 0 || m.geom_conaffinity[g] != 0;
}

void check_foot(ModelContext& c, int contact, int ball) {
  const mjModel& m = c.m;
  const ContactDescription& foot = c.robot.contacts[at(contact)];
  if (ball < 0) {
    const int site = mj_name2id(&m, mjOBJ_SITE, foot.site.c_str());
    if (site < 0) return;  // the control model says so
    c.refuse(
        c.place(mjOBJ_SITE, site),
        fmt::format("contact '{}' has no ball: expected a geom of type sphere on body {} whose "
                    "centre is the site '{}'",
                    foot.name, c.name(mjOBJ_BODY, m.site_bodyid[site]), foot.site));
    return;
  }
  if (((m.geom_contype[ball] | m.geom_conaffinity[ball]) & kGroundBits) == 0) {
    c.refuse(c.place(mjOBJ_GEOM, ball, "contype"),
             fmt::format("the ball of contact '{}' falls through the ground: contype {} and "
                         "conaffinity {} do not meet bit 1; expected contype 1",
                         foot.name, m.geom_contype[ball], m.geom_conaffinity[ball]));
  }
  const double above = m.geom_margin[ball] - m.geom_gap[ball];
  if (above != 0.0) {
    c.warn(c.place(mjOBJ_GEOM, ball, m.geom_margin[ball] != 0.0 ? "margin" : "gap"),
           fmt::format("the ball of contact '{}' touches {:g} mm {} the ground (margin less gap), "
                       "in the simulator only; expected 0",
                       foot.name, 1e3 * std::abs(above), above > 0.0 ? "above" : "below"));
  }
  const double radius = m.geom_size[3 * ball];
  if (std::abs(radius - foot.radius) > 1e-6) {
    c.warn(c.place(mjOBJ_GEOM, ball, "size"),
           fmt::format("the ball of contact '{}' has a radius of {:g} mm in the simulator and {:g} "
                       "mm in the robot file: the control model's contact point is wrong by that",
                       foot.name, 1e3 * radius, 1e3 * foot.radius));
  }
}

void check_priority(ModelContext& c, int g) {
  if (c.m.geom_priority[g] < kGroundPriority || !collides(c.m, g)) return;
  c.refuse(c.place(mjOBJ_GEOM, g, "priority"),
           fmt::format("geom {} has priority {}: its friction {:g} would replace the world's; "
                       "expected 0",
                       c.name(mjOBJ_GEOM, g), c.m.geom_priority[g], c.m.geom_friction[3 * g]));
}

void check_exclusion(ModelContext& c, int index, const MjcfElement* element,
                     const std::vector<int>& balls) {
  const mjModel& m = c.m;
  const int signature = m.exclude_signature[index];
  const int bodies[] = {(signature >> 16) - 1, (signature & 0xffff) - 1};
  const MjcfPlace place = element == nullptr ? MjcfPlace{} : element->place;
  for (const int body : bodies) {
    if (body == 0) {
      c.refuse(place,
               "a body that is excluded from contact with the world falls through its "
               "ground; expected no <exclude> of the world");
      return;
    }
    for (const int ball : balls) {
      if (ball < 0 || m.geom_bodyid[ball] != body) continue;
      c.warn(place, fmt::format("body {} with a contact is excluded from contact with another one: "
                                "they pass through each other in the simulator only",
                                c.name(mjOBJ_BODY, body)));
      return;
    }
  }
}

void check_pairs(ModelContext& c, const std::vector<int>& balls) {
  const mjModel& m = c.m;
  std::vector<const MjcfElement*> exclusions, pairs;
  for (const MjcfElement* e : c.source.section("contact")) {
    if (e->tag == "exclude") exclusions.push_back(e);
    if (e->tag == "pair") pairs.push_back(e);
  }
  // The compiled lists are sorted: find a written element by its bodies' names.
  for (int i = 0; i < m.nexclude; ++i) {
    const int signature = m.exclude_signature[i];
    const auto found = std::ranges::find_if(exclusions, [&](const MjcfElement* e) {
      const auto id = [&](const char* key) {
        const MjcfAttribute* a = e->find(key);
        return a == nullptr ? -1 : mj_name2id(&m, mjOBJ_BODY, a->value.c_str());
      };
      const int a = id("body1"), b = id("body2");
      return ((a + 1) << 16) + b + 1 == signature || ((b + 1) << 16) + a + 1 == signature;
    });
    check_exclusion(c, i, found == exclusions.end() ? nullptr : *found, balls);
  }
  for (const MjcfElement* pair : pairs) {
    c.warn(pair->place,
           "a contact pair acts in the simulator with friction and margin of its own, and the "
           "control model does not know contacts between the robot's own parts");
  }
}

}  // namespace

void check_collisions(ModelContext& c) {
  const std::vector<int> balls = c.balls();
  for (std::size_t i = 0; i < balls.size(); ++i) check_foot(c, static_cast<int>(i), balls[i]);
  for (int g = 0; g < c.m.ngeom; ++g) check_priority(c, g);
  check_pairs(c, balls);
}

void check_masses(ModelContext& c, const mjModel& physics) {
  const mjModel& m = c.m;
  if (physics.nbody != m.nbody) return;
  for (int b = 1; b < m.nbody; ++b) {
    const double lost = m.body_mass[b] - physics.body_mass[b];
    if (std::abs(lost) <= 1e-9 * std::max(m.body_mass[b], physics.body_mass[b])) continue;
    MjcfPlace place = c.place(mjOBJ_BODY, b);
    for (int g = m.ngeom - 1; g >= 0; --g) {
      if (m.geom_bodyid[g] == b && !collides(m, g)) place = c.place(mjOBJ_GEOM, g);
    }
    c.refuse(place, fmt::format("{:.4g} kg of body {} are lost: shapes that touch nothing are left "
                                "out of physics, with their mass; expected an <inertial> of the "
                                "body, or a shape that collides",
                                lost, c.name(mjOBJ_BODY, b)));
  }
}

}  // namespace footfall::model
