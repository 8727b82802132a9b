// Random numbers of a seed; see variation.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/random.h"
#include "model/variation/variation.h"

namespace footfall::model {
namespace {

constexpr double kCut = 3.0;  // standard deviations
constexpr const char* kDelayName = "command_delay_s";
constexpr const char* kJointsName = "start.joints_rad";

// The order is part of what a seed means: new quantities go to the end.
enum class Stream : std::uint32_t {
  velocity,
  joints,
  rates,
  friction,
  mass,
  com,
  command_delay,
  push,
  spring,
  coulomb,
  terrain,
};

class Source {
 public:
  Source(std::uint64_t seed, Stream stream) {
    std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                        static_cast<std::uint32_t>(stream)};
    random_.seed(words);
  }

  double of(const Spread& spread) {
    switch (spread.kind) {
      case Spread::Kind::none:
        return 0.0;
      case Spread::Kind::fixed:
        return spread.a;
      case Spread::Kind::normal:
        return spread.a * normal();
      case Spread::Kind::uniform:
        return spread.a + (spread.b - spread.a) * uniform();
      case Spread::Kind::sign:
        return uniform() < 0.5 ? spread.a : -spread.a;
      case Spread::Kind::ring:  // has two numbers
        return 0.0;
    }
    return 0.0;
  }
  std::array<double, 2> pair_of(const Spread& spread) {
    if (spread.kind != Spread::Kind::ring) {
      const double x = of(spread);
      return {x, of(spread)};
    }
    const double direction = 2.0 * std::numbers::pi * uniform();
    return {spread.a * std::cos(direction), spread.a * std::sin(direction)};
  }
  double uniform() { return core::uniform(random_); }

 private:
  double normal() {
    for (;;) {
      const double z = normal_(random_);
      if (std::abs(z) <= kCut) return z;
    }
  }

  std::mt19937_64 random_;
  core::Normal normal_;
};

bool is_drawn(const Spread& spread) { return spread.kind != Spread::Kind::none; }

}  // namespace

double Spread::least() const {
  if (kind == Kind::none) return 0.0;
  if (kind == Kind::sign || kind == Kind::ring) return -a;
  return kind == Kind::normal ? -kCut * a : a;
}

double Spread::most() const {
  if (kind == Kind::none) return 0.0;
  if (kind == Kind::normal) return kCut * a;
  return kind == Kind::uniform ? b : a;
}

std::optional<double> Variation::least_friction() const {
  if (!is_drawn(friction)) return std::nullopt;
  return friction.least();
}

double Variation::most_command_delay() const { return command_delay.most(); }

bool Variation::draws_actuators() const { return is_drawn(spring) || is_drawn(coulomb); }

bool Variation::depends_on_seed() const {
  const auto varies = [](const Spread& spread) { return spread.least() < spread.most(); };
  const bool believes = terrain.boxes > 0 && (terrain.tilt > 0.0 || terrain.height > 0.0);
  return noise || believes || varies(velocity) || varies(joints) || varies(rates) ||
         varies(friction) || varies(mass) || varies(command_delay) || varies(spring) ||
         varies(coulomb) || push.impulse > 0.0 ||
         std::ranges::any_of(com, [&](const auto& link) { return varies(link.second); });
}

namespace {

void draw_actuators(const Variation& v, int joints, std::uint64_t seed, Draw& out) {
  if (is_drawn(v.spring)) {
    Source source(seed, Stream::spring);
    for (int j = 0; j < joints; ++j) out.springs.push_back(1.0 + source.of(v.spring));
    out.values.emplace_back("actuators.spring", out.springs);
  }
  if (is_drawn(v.coulomb)) {
    Source source(seed, Stream::coulomb);
    for (int j = 0; j < joints; ++j) out.coulomb.push_back(1.0 + source.of(v.coulomb));
    out.values.emplace_back("actuators.coulomb", out.coulomb);
  }
}

void draw_terrain(const TerrainError& error, std::uint64_t seed, Draw& out) {
  if (!(error.tilt > 0.0) && !(error.height > 0.0)) return;
  Source source(seed, Stream::terrain);
  std::vector<double> tilts, heights;
  for (int b = 0; b < error.boxes; ++b) {
    DrawnTerrain box;
    box.tilt = source.pair_of({Spread::Kind::ring, error.tilt});
    box.height = source.of({Spread::Kind::sign, error.height});
    tilts.insert(tilts.end(), box.tilt.begin(), box.tilt.end());
    heights.push_back(box.height);
    out.terrain.push_back(box);
  }
  if (error.boxes == 0) return;
  if (error.tilt > 0.0) out.values.emplace_back("terrain.tilt_rad", std::move(tilts));
  if (error.height > 0.0) out.values.emplace_back("terrain.height_m", std::move(heights));
}

void draw_control_model(const Variation& v, const std::vector<std::string>& links,
                        std::uint64_t seed, Draw& out) {
  if (v.mass.kind == Spread::Kind::sign) {
    out.mass = 1.0 + Source(seed, Stream::mass).of(v.mass);
    out.values.emplace_back("control_model.mass", std::vector<double>{*out.mass});
  } else if (is_drawn(v.mass)) {
    Source source(seed, Stream::mass);
    std::vector<double> factors;
    for (const std::string& link : links) {
      factors.push_back(1.0 + source.of(v.mass));
      out.masses[link] = factors.back();
    }
    out.values.emplace_back("control_model.mass", std::move(factors));
  }
  Source com(seed, Stream::com);
  for (const auto& [link, spread] : v.com) {
    if (!is_drawn(spread)) continue;
    const auto& shift = out.com[link] = com.pair_of(spread);
    out.values.emplace_back("control_model.com." + link + "_m",
                            std::vector<double>{shift.begin(), shift.end()});
  }
}

}  // namespace

Draw draw(const Variation& v, int joints, const std::vector<std::string>& links,
          std::uint64_t seed) {
  Draw out;
  out.seed = seed;
  const auto tell = [&out](const char* name, std::vector<double> values) {
    out.values.emplace_back(name, std::move(values));
  };
  if (is_drawn(v.velocity)) {
    Source source(seed, Stream::velocity);
    for (double& x : out.velocity) x = source.of(v.velocity);
    tell("start.velocity_mps", {out.velocity.begin(), out.velocity.end()});
  }
  if (is_drawn(v.joints)) {
    Source source(seed, Stream::joints);
    for (int j = 0; j < joints; ++j) out.joints.push_back(source.of(v.joints));
    tell(kJointsName, out.joints);
  }
  if (is_drawn(v.rates)) {
    Source source(seed, Stream::rates);
    for (double& x : out.rates) x = source.of(v.rates);
    tell("start.rates_radps", {out.rates.begin(), out.rates.end()});
  }
  if (is_drawn(v.friction)) {
    out.friction = Source(seed, Stream::friction).of(v.friction);
    tell("friction", {*out.friction});
  }
  draw_control_model(v, links, seed, out);
  if (is_drawn(v.command_delay)) {
    out.command_delay = Source(seed, Stream::command_delay).of(v.command_delay);
    tell(kDelayName, {*out.command_delay});
  }
  draw_actuators(v, joints, seed, out);
  if (v.push.impulse > 0.0) {
    Source source(seed, Stream::push);
    DrawnPush push;
    const auto [from, to] = v.push.between;
    push.time = from + (to - from) * source.uniform();
    push.direction = 2.0 * std::numbers::pi * source.uniform();
    push.duration = v.push.duration;
    push.force = v.push.impulse / v.push.duration;
    out.push = push;
    tell("push.time_s", {push.time});
    tell("push.direction_rad", {push.direction});
  }
  draw_terrain(v.terrain, seed, out);
  return out;
}

void round_command_delay(Draw& drawn, double own, double step) {
  if (!drawn.command_delay) return;
  *drawn.command_delay = std::round((own + *drawn.command_delay) / step) * step - own;
  for (auto& [name, values] : drawn.values) {
    if (name == kDelayName) values = {*drawn.command_delay};
  }
}

void keep_start_within_limits(Draw& drawn, const RobotDescription& robot) {
  for (std::size_t j = 0; j < drawn.joints.size() && j < robot.joints.size(); ++j) {
    const JointDescription& joint = robot.joints[j];
    drawn.joints[j] = std::clamp(drawn.joints[j], std::min(0.0, joint.position_min - joint.posture),
                                 std::max(0.0, joint.position_max - joint.posture));
  }
  for (auto& [name, values] : drawn.values) {
    if (name == kJointsName) values = drawn.joints;
  }
}

}  // namespace footfall::model
