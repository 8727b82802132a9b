// What the parts of check_model share: the compiled model, and where its objects are written.
#pragma once

#include <mujoco/mujoco.h>

#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "model/robot/description.h"
#include "model/source/mjcf_source.h"

namespace footfall::model {

inline double degrees(double rad) { return rad * 180.0 / std::numbers::pi; }

class ModelContext {
 public:
  // `m` has all shapes of the file, also those that physics leaves out.
  ModelContext(const mjModel& m, const RobotDescription& robot, const MjcfSource& source,
               core::Diagnostics& diagnostics);

  const mjModel& m;
  const RobotDescription& robot;
  const MjcfSource& source;

  void refuse(MjcfPlace place, std::string text);
  void warn(MjcfPlace place, std::string text);
  // Where `attribute` of an object is written, in its element or in a class of defaults; the
  // element itself if `attribute` is empty. The whole file if the element is not found.
  MjcfPlace place(mjtObj type, int id, std::string_view attribute = {}) const;
  // "'NAME'", or "number N" of an object without a name.
  std::string name(mjtObj type, int id) const;
  // The robot file's joint of a joint of the model; nullptr: the floating base, or unknown.
  const JointDescription* joint(int id) const;
  // The shapes that are a contact's ball, by contact; -1 where there is none.
  std::vector<int> balls() const;

 private:
  const MjcfElement* element(mjtObj type, int id) const;
  const std::vector<const MjcfElement*>& list(mjtObj type) const;
  core::Mark mark(MjcfPlace place) const;

  core::Diagnostics& diagnostics_;
  std::vector<const MjcfElement*> bodies_, joints_, geoms_, sites_, actuators_, tendons_,
      equalities_, none_;
};

// The parts, one topic each.
void check_actuators(ModelContext& context);
void check_passive(ModelContext& context);     // joints, tendons, equality constraints
void check_base(ModelContext& context);        // start, what hangs on the world
void check_collisions(ModelContext& context);  // feet, ground, pairs, exclusions
void check_masses(ModelContext& context, const mjModel& physics);
void check_settings(ModelContext& context);  // option, size, keyframe

}  // namespace footfall::model
