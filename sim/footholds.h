// Ground whose height is wrong below each foot, by another error for every step: each contact's
// ball has a ground of its own, a copy of the plane and the terrain, that no other body meets.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hal/sensors/noise.h"
#include "sim/world/description.h"

struct mjModel_;
struct mjData_;

namespace footfall::sim {

// The name of a copy in the scene: `piece` 0 is the plane, 1 the first piece of terrain.
std::string foothold_name(std::size_t contact, std::size_t piece);

// A foot's ground moves while its ball is clear of the highest that it can be, once
// between two touchdowns: it never meets the ball by moving. At the start the errors are 0.
class Footholds {
 public:
  // Makes the balls meet their own ground only. `balls`: geoms, by contact. Throws
  // std::runtime_error if the robot's file leaves too few bits for the contacts.
  Footholds(mjModel_& model, const WorldDescription& world, std::span<const int> balls);

  void start(mjModel_& model);
  // After a tick's physics. No allocation.
  void update(mjModel_& model, const mjData_& data) noexcept;
  // How often a foot got another height since the start; one that swings low keeps its own.
  std::int64_t drawn() const noexcept { return drawn_; }
  double height(int contact) const { return footholds_[static_cast<std::size_t>(contact)].height; }

 private:
  struct Foothold {
    int ball = -1;
    int first_piece = -1;  // geoms of its ground follow each other
    hal::NoiseStream noise;
    double height = 0.0;  // m, error
    bool touched = true;  // since it moved
  };
  bool is_clear(const mjModel_& model, const mjData_& data, int ball) const noexcept;
  void move(mjModel_& model, Foothold& foothold, double height) const noexcept;

  double error_;
  std::uint64_t seed_;
  model::Terrain terrain_;       // without error
  std::vector<double> heights_;  // m, of the pieces' centres without error
  std::vector<Foothold> footholds_;
  std::int64_t drawn_ = 0;
};

}  // namespace footfall::sim
