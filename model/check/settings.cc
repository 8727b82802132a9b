// Settings of the physics engine in a robot's file: the world has its own, which apply.
#include <fmt/format.h>

#include <string>

#include "model/check/context.h"

namespace footfall::model {
namespace {

void warn_option(ModelContext& c, const MjcfAttribute& option, const char* element) {
  if (option.name == "apirate") return;  // without effect on physics
  if (option.name == "gravity") {
    double g[3] = {};
    const bool three = std::sscanf(option.value.c_str(), "%lf %lf %lf", g, g + 1, g + 2) == 3;
    if (three && g[0] == 0.0 && g[1] == 0.0 && g[2] == -9.81) return;  // as it is anyway
  }
  c.warn(option.place,
         fmt::format("<{} {}=\"{}\"> of the robot's model is dropped: physics is set by the world",
                     element, option.name, option.value));
}

}  // namespace

void check_settings(ModelContext& c) {
  for (const MjcfElement* option : c.source.sections("option")) {
    for (const MjcfAttribute& a : option->attributes) warn_option(c, a, "option");
    for (const MjcfElement* flag : option->children) {
      for (const MjcfAttribute& a : flag->attributes) warn_option(c, a, "flag");
    }
  }
  for (const MjcfElement* size : c.source.sections("size")) {
    for (const MjcfAttribute& a : size->attributes) {
      if (a.name == "njmax" || a.name == "nconmax" || a.name == "nstack") warn_option(c, a, "size");
    }
  }
  for (const MjcfElement* key : c.source.section("keyframe")) {
    c.warn(key->place,
           "a keyframe is not used: the robot starts in the `posture` of the robot file");
  }
}

}  // namespace footfall::model
