// One case per estimator; see catalogue.h.
#include "engine/estimators/catalogue.h"

#include <stdexcept>

#include "engine/estimators/contact_kalman.h"
#include "engine/estimators/motion_capture.h"
#include "engine/estimators/true_state.h"

namespace footfall::engine {

std::unique_ptr<Estimator> make_estimator(const behaviors::EstimatorSpec& spec,
                                          const model::RobotDescription& robot,
                                          const model::ControlModel& model) {
  switch (spec.type) {
    case behaviors::EstimatorType::true_state:
      return std::make_unique<TrueState>(robot);
    case behaviors::EstimatorType::motion_capture:
      return std::make_unique<MotionCapture>(spec, robot, model);
    case behaviors::EstimatorType::contact_kalman:
      return make_contact_kalman(spec, robot, model);
  }
  throw std::runtime_error("this estimator does not exist yet");
}

}  // namespace footfall::engine
