// What a seed draws: the differences between one day in the lab and the next. A world file declares
// distributions (`variation:`), a scenario may pin or widen single ones; a run draws once, before
// it begins, and says what it drew.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/yaml/key_table.h"
#include "core/yaml/yaml.h"
#include "model/robot/description.h"

namespace footfall::model {

// A distribution of one number, SI. A normal one is cut at three standard deviations.
struct Spread {
  enum class Kind : std::uint8_t { none, fixed, normal, uniform, sign, ring };
  Kind kind = Kind::none;
  // fixed: a; normal: mean 0, standard deviation a; uniform: from a to b; sign: a or -a; ring: of
  // two numbers, at the distance a from 0 in a uniform direction.
  double a = 0.0, b = 0.0;

  // The least and the most that can be drawn; 0 if nothing is.
  double least() const;
  double most() const;
};

// A push of an impulse at a time between two, in any horizontal direction.
struct PushSpread {
  double impulse = 0.0;             // N s; 0: none
  double duration = 0.1;            // s
  std::array<double, 2> between{};  // s
};

// A link that a file names, and where.
// In `com: {"*": off}`: the links that are not named draw nothing.
inline constexpr std::string_view kOtherLinks = "*";

struct NamedLink {
  std::string name;
  std::string file;
  core::Mark mark;  // in that file
};
NamedLink named_link(const core::YamlEntry& entry, const core::Diagnostics& diagnostics);
// Reports links that the robot does not have; `bodies`: names of its model's.
void check_links(const std::vector<NamedLink>& links, const std::vector<std::string>& bodies,
                 core::Diagnostics& diagnostics);

// How wrong the belief of the terrain is (`terrain_belief` of a world, no key here): of each box a
// tilt in a drawn direction and a height of a drawn sign.
struct TerrainError {
  int boxes = 0;        // that the belief has
  double tilt = 0.0;    // rad
  double height = 0.0;  // m
};

struct Variation {
  Spread velocity;  // m/s, of the base at the start, x and y each
  Spread joints;    // rad, each joint's angle at the start, from its posture
  Spread rates;     // rad/s, of the base at the start, about each of its axes
  Spread friction;  // of the ground, in the place of the world's
  Spread mass;      // relative change of each link's mass in the control model; sign: one for all
  std::map<std::string, Spread> com;  // m, x and y of a link's CoM in the control model
  std::vector<NamedLink> links;       // those of `com`, as named
  Spread command_delay;               // s, added to the world's
  Spread spring;                      // relative change of each actuator's spring
  Spread coulomb;                     // relative change of each actuator's Coulomb friction
  NamedLink actuators;                // where these two stand
  PushSpread push;
  TerrainError terrain;
  bool noise = false;  // the world's sensors or its ground have random errors; no key here

  // The least friction that can be drawn; nullopt: it is not drawn.
  std::optional<double> least_friction() const;
  // The most command delay that can be added, s; 0: it is not drawn.
  double most_command_delay() const;
  bool draws_actuators() const;  // springs or friction
  // Whether two seeds can draw different values.
  bool depends_on_seed() const;
};

// `variation:` of a world or a scenario.
extern const core::KeyTable kVariationKeys;
extern const core::KeyTable kSpreadKeys, kVariedStartKeys, kVariedModelKeys, kVariedPushKeys,
    kVariedActuatorsKeys;

// Reads the map over `base`: what it names is replaced, `off` takes a draw away; `off` as a whole
// takes all away.
Variation read_variation(const core::YamlNode& node, const Variation& base,
                         core::Diagnostics& diagnostics);

// Before the merge of a world or scenario over its base (core::YamlLayers): `off` stays as a value,
// since what it takes away may come from elsewhere, such as a scenario's world; one kind of
// distribution replaces the other; a `ground: {friction}` replaces the base's draw of it.
void prepare_variation(core::YamlNode& base, const core::YamlNode& own);

struct DrawnPush {
  double time = 0.0;       // s
  double force = 0.0;      // N
  double direction = 0.0;  // rad, from the heading
  double duration = 0.0;   // s
};

// Error of one box of the believed terrain.
struct DrawnTerrain {
  std::array<double, 2> tilt{};  // rad, components of the rotation vector along x and y
  double height = 0.0;           // m
};

// What one seed drew. Empty or nullopt: not drawn.
struct Draw {
  std::uint64_t seed = 0;            // that drew
  std::vector<double> joints;        // rad, by joint of the robot file
  std::array<double, 2> velocity{};  // m/s
  std::array<double, 3> rates{};     // rad/s
  std::optional<double> friction;
  std::optional<double> mass;                        // factor, of all links
  std::map<std::string, double> masses;              // factor, by link
  std::map<std::string, std::array<double, 2>> com;  // m, by link
  std::optional<double> command_delay;               // s, added
  std::vector<double> springs;                       // factor, by joint
  std::vector<double> coulomb;                       // factor, by joint
  std::optional<DrawnPush> push;
  std::vector<DrawnTerrain> terrain;  // by box
  // What was drawn, by name with its unit (`start.velocity_mps`), for summaries and logs.
  std::vector<std::pair<std::string, std::vector<double>>> values;
};

// Ends the drawn start of a joint at its limits; where its posture is beyond them, at the posture.
void keep_start_within_limits(Draw& drawn, const RobotDescription& robot);
// Makes the drawn delay the one that acts: with the world's `own` it is of whole steps of the
// physics.
void round_command_delay(Draw& drawn, double own, double step);

// Each quantity has a stream of random numbers of its own: to pin one leaves the others as they
// are. `links`: names of the robot's bodies.
Draw draw(const Variation& variation, int joints, const std::vector<std::string>& links,
          std::uint64_t seed);

}  // namespace footfall::model
