// What a robot is, as its `robot: 1` file says: data for every robot, code for none.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/fault.h"
#include "core/yaml/yaml.h"
#include "hal/actuators/drive.h"

namespace footfall::model {

// One actuated joint, in the order of commands and logs.
struct JointDescription {
  std::string name;
  double position_min = 0.0;  // rad
  double position_max = 0.0;  // rad
  double torque_limit = 0.0;  // N m, symmetric
  double posture = 0.0;       // rad, nominal
  // Of its series-elastic actuator; 0: none.
  double spring = 0.0;        // N m/rad, nominal
  double rotor = 0.0;         // kg m^2, reflected
  double motor_torque = 0.0;  // N m, largest; 0: unlimited
  double motor_speed = 0.0;   // rad/s, largest; 0: unlimited
  core::Mark mark;            // of its name
};

// The drives between commands and joints, where the joints have series-elastic actuators.
struct DriveDescription {
  static constexpr double kUnfiltered = std::numeric_limits<double>::infinity();
  double rate = 12'000.0;  // Hz, of the torque loops
  hal::RateFilters filters{kUnfiltered, kUnfiltered};
  // Gains at the start, by joint; empty: the robot does not tell.
  std::vector<hal::TorqueLoopGains> torque_loop;
  core::Mark mark;   // of the section
  std::string file;  // of that position
};

enum class ContactType { point, surface, fixed };

// A place that can touch the world.
struct ContactDescription {
  std::string name;
  std::string site;  // MJCF site at the centre of the foot's ball
  ContactType type = ContactType::point;
  core::Mark type_mark;   // where the type is written
  std::string group;      // joint group of its leg, may be empty
  double radius = 0.0;    // m; the contact point is centre - radius * ground normal
  double friction = 0.9;  // coefficient that checks count on; the world has its own
};

// A named place with a frame: a site of the model with its orientation, or a body's own frame.
struct PointDescription {
  std::string name;
  std::string site;
  std::string body{};  // instead of a site
};

struct JointGroup {
  std::string name;
  std::vector<int> joints;  // indices into joints
};

struct SensorDescription {
  std::string imu_site;
  std::vector<std::string> mocap_sites;
  std::vector<int> switches;  // contact indices
};

struct RobotDescription {
  std::string name;
  std::string path;        // of the robot file
  std::string model_path;  // MJCF, absolute
  std::string floating_base;
  std::int64_t rate_mhz = 1'000'000;  // servo rate in millihertz (exact)
  double standing_height = 0.0;       // m, origin of the floating base above the ground
  std::vector<JointDescription> joints;
  DriveDescription drives;
  std::vector<JointGroup> groups;
  std::vector<ContactDescription> contacts;
  std::vector<PointDescription> points;
  SensorDescription sensors;
  std::vector<std::array<std::string, 2>> symmetry;  // names that change places in a mirror image
  double tilt_limit = 0.8;                           // rad
  double height_limit = 0.6;       // part of standing_height below which it has fallen
  double torque_step_limit = 0.0;  // N m between neighbouring ticks; 0: none
  double swing_limit = 1.0;        // s, a foot in the air while stepping
  // Of a level, largest over smallest pivot. At 100 a model that is wrong by 1 % makes the
  // acceleration in the worst direction wrong by all of it.
  double condition_limit = 100.0;
  // Of commanded torques, over the joints' limits; above 1 those hold for the measured torques.
  double command_limit = 1.0;
  double slip_limit = 0.01;   // m, along the ground, in about 0.2 s
  double imu_age = 0.02;      // s, without new IMU data
  double mocap_age = 0.2;     // s, without a new frame of motion capture
  double edit_ramp = 0.1;     // s, shortest of a person's edits
  int overruns = 15;          // late ticks in a row that are the fault tick.overrun
  double reload_watch = 2.0;  // s after a reload, in which a fault takes it back
  // By fault; what the file does not name: FaultRule::otherwise.
  std::array<core::Reaction, core::kFaultCount> reactions{};

  double rate_hz() const { return static_cast<double>(rate_mhz) * 1e-3; }
  double period_s() const { return 1e3 / static_cast<double>(rate_mhz); }
  int joint_count() const { return static_cast<int>(joints.size()); }
  std::vector<double> torque_limits()
      const;  // N m, of commands by joint; infinite where none is given
  int find_joint(std::string_view name) const;
  int find_contact(std::string_view name) const;
  int find_group(std::string_view name) const;
};

// Loads a robot file and checks it (unknown keys, dimensions, globs, references between its parts).
// Problems go to diagnostics; the result is meaningful only without errors.
RobotDescription load_robot(const std::string& path, core::Diagnostics& diagnostics);

// Where a robot is found by name: NAME itself if it is a file, else DIR/robots/NAME/robot.yaml for
// each folder of `search` in turn; empty if nowhere.
std::string find_robot_file(const std::string& name, const std::vector<std::string>& search);

}  // namespace footfall::model
