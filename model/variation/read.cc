// `variation:` of a file: keys and reading; see variation.h.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/diagnostics/did_you_mean.h"
#include "core/yaml/value_reader.h"
#include "model/variation/variation.h"

namespace footfall::model {
namespace {

using namespace core;  // constructors of the tables

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr KeySpec kSpreadRows[] = {
    key("sd", any_quantity(),
        "standard deviation of a normal distribution around 0, cut at three of them"),
    key("range", pair(any_quantity()), "ends of a uniform distribution"),
    key("sign", any_quantity(), "this or minus this, either with the same probability"),
    key("ring", any_quantity(), "of a centre of mass: this far in a uniform horizontal direction"),
};

constexpr KeySpec kVariedStartRows[] = {
    key("velocity", map_of(kSpreadKeys), any_quantity(), "of the base, x and y each"),
    key("joints", map_of(kSpreadKeys), any_quantity(), "angle of each joint, from the posture"),
    key("rates", map_of(kSpreadKeys), any_quantity(),
        "angular velocity of the base, about each axis"),
};

constexpr KeySpec kVariedModelRows[] = {
    key("mass", map_of(kSpreadKeys), any_quantity(),
        "relative change of each link's mass; a `sign` is one for all links"),
    key("com", by_name(map_of(kSpreadKeys)),
        "shift of a link's centre of mass, x and y each, by link"),
};

constexpr KeySpec kVariedActuatorsRows[] = {
    key("spring", map_of(kSpreadKeys), any_quantity(),
        "relative change of each actuator's spring, beside what its drive counts on"),
    key("coulomb", map_of(kSpreadKeys), any_quantity(),
        "relative change of each actuator's Coulomb friction"),
};

constexpr KeySpec kVariedPushRows[] = {
    key("impulse", quantity(kImpulse), "force times duration").required(),
    key("between", pair(quantity(kTime)), "times between which it comes").required(),
    key("for", quantity(kTime), "its duration").otherwise("100 ms"),
};

constexpr KeySpec kVariationRows[] = {
    key("start", map_of(kVariedStartKeys), "how the robot stands when the run begins"),
    key("friction", map_of(kSpreadKeys), any_quantity(),
        "of the ground, in the place of `ground: {friction}`"),
    key("control_model", map_of(kVariedModelKeys),
        "what the controller believes, beside the truth"),
    key("command_delay", map_of(kSpreadKeys), any_quantity(), "added to that of the actuators"),
    key("actuators", map_of(kVariedActuatorsKeys), "of a world with series-elastic actuators"),
    key("push", map_of(kVariedPushKeys), "a push in any horizontal direction"),
};

// Empty if the text is of no file, or of one that these diagnostics do not know.
std::string file_of(const Mark& mark, const Diagnostics& diagnostics) {
  const bool known = mark.file >= 0 && mark.file < diagnostics.file_count();
  return known ? diagnostics.file(mark.file) : "";
}

// Reads distributions; what they are over is known here only.
class Reader {
 public:
  explicit Reader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void spread(const YamlNode& map, const char* name, Dimension dimension, double least, double most,
              Spread& out) {
    if (const YamlNode* node = map.find(name)) out = read(*node, dimension, least, most);
  }

  // `pair`: of two numbers, x and y.
  Spread read(const YamlNode& node, Dimension dimension, double least, double most,
              bool pair = false) {
    Spread out;
    if (is_off(node)) return out;
    if (!node.is_map()) {
      const auto fixed = read_bounded(node, dimension, least, most, diagnostics_);
      if (fixed) out = {Spread::Kind::fixed, *fixed, *fixed};
      return out;
    }
    check_keys(node, kSpreadKeys, diagnostics_);
    if (node.entries.size() != 1) {
      diagnostics_.error(node.mark, "missing-key",
                         "expected 'sd', 'range', 'sign' or 'ring', one of them");
      return out;
    }
    if (const YamlNode* sd = node.find("sd")) return read_normal(*sd, dimension, least, most);
    if (const YamlNode* size = node.find("sign")) {
      return read_size(*size, dimension, std::min(-least, most), Spread::Kind::sign);
    }
    if (const YamlNode* size = node.find("ring")) {
      if (!pair) {
        diagnostics_.error(size->mark, "misplaced-key",
                           "a ring is of a centre of mass: expected 'sd', 'range' or 'sign'");
        return out;
      }
      return read_size(*size, dimension, std::min(-least, most), Spread::Kind::ring);
    }
    const YamlNode* const range = node.find("range");
    if (range == nullptr) return out;  // told
    if (const auto ends = read_range(*range, dimension, diagnostics_)) {
      if ((*ends)[0] < least || (*ends)[1] > most) {
        diagnostics_.error(range->mark, "out-of-range",
                           fmt::format("expected a range within {:g} and {:g}", least, most));
      }
      out = {Spread::Kind::uniform, (*ends)[0], (*ends)[1]};
    }
    return out;
  }

  // Of a distribution on both sides of 0.
  Spread read_size(const YamlNode& size, Dimension dimension, double most, Spread::Kind kind) {
    if (most <= 0.0) {
      diagnostics_.error(size.mark, "out-of-range",
                         "half of the draws would be below zero: expected {range: [FROM, TO]}");
      return {};
    }
    const auto value = read_bounded(size, dimension, 0.0, most, diagnostics_);
    return value ? Spread{kind, *value, 0.0} : Spread{};
  }

  // Three standard deviations, where the distribution is cut, must lie within what can be drawn.
  Spread read_normal(const YamlNode& sd, Dimension dimension, double least, double most) {
    const auto value = read_bounded(sd, dimension, 0.0, kInfinity, diagnostics_);
    if (!value) return {};
    const Spread out = {Spread::Kind::normal, *value, 0.0};
    if (least >= 0.0) return out;  // half of the draws would be below: refuse_normal()
    constexpr double kRounding = 1e-12;
    if (out.least() < least - kRounding || out.most() > most + kRounding) {
      diagnostics_.error(
          sd.mark, "out-of-range",
          fmt::format("three standard deviations reach from {:.4g} to {:.4g}, beyond {:g} and {:g} "
                      "(SI): expected an sd of at most {:.4g}",
                      out.least(), out.most(), least, most, std::min(-least, most) / 3.0));
    }
    return out;
  }

  void refuse_normal(const YamlNode& map, const char* name, Spread& out, const char* why) {
    const YamlNode* const node = map.find(name);
    if (node == nullptr || out.kind != Spread::Kind::normal) return;
    diagnostics_.error(node->mark, "out-of-range", why);
    out = {};
  }

  static bool is_off(const YamlNode& node) {
    return node.is_scalar() && !node.quoted && node.scalar == "off";
  }

  void start(const YamlNode& node, Variation& out) {
    if (is_off(node)) {
      out.velocity = out.joints = out.rates = {};
      return;
    }
    if (!expect_map(node, "{velocity: ..., joints: ..., rates: ...}", diagnostics_)) return;
    check_keys(node, kVariedStartKeys, diagnostics_);
    spread(node, "velocity", kVelocity, -10.0, 10.0, out.velocity);
    spread(node, "joints", kNone, -1.0, 1.0, out.joints);
    spread(node, "rates", kRate, -10.0, 10.0, out.rates);
  }

  void control_model(const YamlNode& node, Variation& out) {
    if (is_off(node)) {
      out.mass = {};
      clear_com(out);
      return;
    }
    if (!expect_map(node, "{mass: ..., com: {LINK: ...}}", diagnostics_)) return;
    check_keys(node, kVariedModelKeys, diagnostics_);
    spread(node, "mass", kNone, -0.9, 9.0, out.mass);
    const YamlNode* const com = node.find("com");
    if (com == nullptr) return;
    if (is_off(*com)) {
      clear_com(out);
    } else if (expect_map(*com, "a map by link", diagnostics_)) {
      const YamlNode* const others = com->find(kOtherLinks);
      if (others != nullptr && is_off(*others)) clear_com(out);
      for (const YamlEntry& entry : com->entries) {
        if (&entry.value == others && is_off(*others)) continue;
        out.com[entry.key] = read(entry.value, kLength, -1.0, 1.0, true);
        out.links.push_back(named_link(entry, diagnostics_));
      }
    }
  }

  void actuators(const YamlNode& node, Variation& out) {
    if (is_off(node)) {
      out.spring = out.coulomb = {};
      return;
    }
    if (!expect_map(node, "{spring: ..., coulomb: ...}", diagnostics_)) return;
    check_keys(node, kVariedActuatorsKeys, diagnostics_);
    spread(node, "spring", kNone, -0.9, 9.0, out.spring);
    spread(node, "coulomb", kNone, -1.0, 9.0, out.coulomb);
  }

  void push(const YamlNode& node, Variation& out) {
    out.push = {};
    if (is_off(node)) return;
    if (!expect_map(node, "{impulse: 1 N s, between: [3 s, 10 s]}", diagnostics_)) return;
    check_keys(node, kVariedPushKeys, diagnostics_);
    if (const YamlNode* impulse = require_key(node, "impulse", diagnostics_)) {
      out.push.impulse = read_bounded(*impulse, kImpulse, 0.0, 1e3, diagnostics_).value_or(0.0);
    }
    if (const YamlNode* between = require_key(node, "between", diagnostics_)) {
      out.push.between = read_range(*between, kTime, diagnostics_).value_or(out.push.between);
      if (out.push.between[0] < 0.0) {
        diagnostics_.error(between->mark, "out-of-range", "expected times from 0 s on");
      }
    }
    if (const YamlNode* time = node.find("for")) {
      out.push.duration = read_bounded(*time, kTime, 1e-3, 10.0, diagnostics_).value_or(0.1);
    }
  }

 private:
  static void clear_com(Variation& out) {
    out.com.clear();
    out.links.clear();
  }

  Diagnostics& diagnostics_;
};

}  // namespace

NamedLink named_link(const YamlEntry& entry, const Diagnostics& diagnostics) {
  return {entry.key, file_of(entry.key_mark, diagnostics), entry.key_mark};
}

void check_links(const std::vector<NamedLink>& links, const std::vector<std::string>& bodies,
                 Diagnostics& diagnostics) {
  for (const NamedLink& link : links) {
    if (std::ranges::find(bodies, link.name) != bodies.end()) continue;
    Mark mark = link.mark;
    mark.file = diagnostics.add_file(link.file);
    diagnostics.error(mark, "unknown-name",
                      fmt::format("the robot has no body '{}'{}", link.name,
                                  did_you_mean_or_list(link.name, bodies)));
  }
}

Variation read_variation(const YamlNode& node, const Variation& base, Diagnostics& diagnostics) {
  Variation out = base;
  if (Reader::is_off(node)) {
    out = {};
    out.noise = base.noise;
    out.terrain = base.terrain;
    return out;
  }
  if (!expect_map(node, "a map of what a seed draws, or off", diagnostics)) return out;
  check_keys(node, kVariationKeys, diagnostics);
  Reader reader(diagnostics);
  if (const YamlNode* start = node.find("start")) reader.start(*start, out);
  reader.spread(node, "friction", kNone, 0.0, 10.0, out.friction);
  reader.refuse_normal(node, "friction", out.friction,
                       "a friction is no difference from 0: expected {range: [0.6, 1]}");
  if (const YamlNode* model = node.find("control_model")) reader.control_model(*model, out);
  reader.spread(node, "command_delay", kTime, 0.0, 0.02, out.command_delay);
  reader.refuse_normal(node, "command_delay", out.command_delay,
                       "a delay cannot be negative: expected {range: [0 s, 667 us]}");
  if (const YamlNode* actuators = node.find("actuators")) {
    reader.actuators(*actuators, out);
    out.actuators = {"actuators", file_of(actuators->mark, diagnostics), actuators->mark};
  }
  if (const YamlNode* push = node.find("push")) reader.push(*push, out);
  return out;
}

constinit const KeyTable kSpreadKeys = {
    .id = "spread", .doc = "A distribution of one number.", .keys = kSpreadRows};
constinit const KeyTable kVariedStartKeys = {
    .id = "varied_start", .doc = "What a seed draws of the start.", .keys = kVariedStartRows};
constinit const KeyTable kVariedModelKeys = {.id = "varied_model",
                                             .doc = "What a seed draws of the control model.",
                                             .keys = kVariedModelRows};
constinit const KeyTable kVariedActuatorsKeys = {.id = "varied_actuators",
                                                 .doc = "What a seed draws of the actuators.",
                                                 .keys = kVariedActuatorsRows};
constinit const KeyTable kVariedPushKeys = {
    .id = "varied_push", .doc = "A push that a seed draws.", .keys = kVariedPushRows};
constinit const KeyTable kVariationKeys = {.id = "variation",
                                           .doc =
                                               "What a seed draws. A plain value in the place of a "
                                               "distribution pins it, `off` takes it away.",
                                           .keys = kVariationRows};

}  // namespace footfall::model
