// Bits of collision and heights of footholds; see footholds.h.
#include "sim/footholds.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/index.h"

namespace footfall::sim {
namespace {

// A bit that no geom has; 0: none is left.
int free_bit(int& used) {
  for (unsigned b = 1; b < 31; ++b) {
    const int bit = 1 << b;
    if ((used & bit) != 0) continue;
    used |= bit;
    return bit;
  }
  throw std::runtime_error(
      "'height_error': error: the robot's contype and conaffinity leave too few of their bits: "
      "expected one unused for each contact and one more");
}

int used_bits(const mjModel& m) {
  int used = 1;
  for (int g = 0; g < m.ngeom; ++g) used |= m.geom_contype[g] | m.geom_conaffinity[g];
  return used;
}

bool meets_ground(const mjModel& m, int geom) {
  return (m.geom_contype[geom] & 1) != 0 || (m.geom_conaffinity[geom] & 1) != 0;
}

}  // namespace

std::string foothold_name(std::size_t contact, std::size_t piece) {
  return fmt::format("foothold_{}_{}", contact, piece);
}

// The ground's bit is 1 in both masks (scene.cc). The common ground gets a bit that all have who
// met it, but for the balls; the ground of a ball gets one that only the ball has. Nothing changes
// between two geoms of the robot: none has these bits in its contype.
Footholds::Footholds(mjModel_& m, const WorldDescription& world, std::span<const int> balls)
    : error_(world.height_error), seed_(world.noise_seed), terrain_(terrain_of(world.terrain)) {
  int used = used_bits(m);
  const int common = free_bit(used);
  for (int g = 0; g < m.ngeom; ++g) {
    if (m.geom_bodyid[g] == 0) {
      m.geom_contype[g] = common;
      m.geom_conaffinity[g] = 0;
    } else if (std::ranges::find(balls, g) == balls.end() && meets_ground(m, g)) {
      m.geom_conaffinity[g] |= common;
    }
  }
  heights_.push_back(0.0);
  for (const model::TerrainPiece& box : terrain_.boxes) heights_.push_back(box.centre[2]);
  for (std::size_t c = 0; c < balls.size(); ++c) {
    Foothold foothold;
    foothold.ball = balls[c];
    foothold.first_piece = mj_name2id(&m, mjOBJ_GEOM, foothold_name(c, 0).c_str());
    const int own = free_bit(used);
    m.geom_conaffinity[foothold.ball] |= own;
    for (std::size_t piece = 0; piece < heights_.size(); ++piece) {
      const int g = foothold.first_piece + static_cast<int>(piece);
      m.geom_contype[g] = own;
      m.geom_sameframe[g] = 0;  // else MuJoCo takes the world's place for the geom's
    }
    footholds_.push_back(foothold);
  }
}

void Footholds::start(mjModel_& model) {
  drawn_ = 0;
  for (std::size_t c = 0; c < footholds_.size(); ++c) {
    footholds_[c].noise =
        hal::NoiseStream(seed_, hal::NoiseSource::footholds, static_cast<std::uint32_t>(c));
    footholds_[c].touched = true;
    move(model, footholds_[c], 0.0);
  }
}

void Footholds::move(mjModel_& model, Foothold& foothold, double height) const noexcept {
  foothold.height = height;
  for (std::size_t piece = 0; piece < heights_.size(); ++piece) {
    const int geom = foothold.first_piece + static_cast<int>(piece);
    model.geom_pos[3 * geom + 2] = heights_[piece] + height;
  }
}

// Wherever its ground may be, which is up to the error above its place.
bool Footholds::is_clear(const mjModel_& model, const mjData_& data, int ball) const noexcept {
  const double* p = data.geom_xpos + 3 * ball;
  constexpr double kGap = 1e-3;  // m
  return terrain_.nearest({p[0], p[1], p[2]}).distance > model.geom_size[3 * ball] + error_ + kGap;
}

void Footholds::update(mjModel_& model, const mjData_& data) noexcept {
  for (int i = 0; i < data.ncon; ++i) {
    const mjContact& contact = data.contact[i];
    if (contact.exclude != 0) continue;
    for (Foothold& f : footholds_) {
      const bool first = contact.geom1 == f.ball, second = contact.geom2 == f.ball;
      const int other = first ? contact.geom2 : contact.geom1;
      if ((first || second) && model.geom_bodyid[other] == 0) f.touched = true;
    }
  }
  for (Foothold& f : footholds_) {
    if (!f.touched || !is_clear(model, data, f.ball)) continue;
    f.touched = false;
    ++drawn_;
    move(model, f, error_ * (2.0 * f.noise.uniform() - 1.0));
  }
}

}  // namespace footfall::sim
