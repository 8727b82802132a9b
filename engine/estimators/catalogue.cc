// One case per estimator; see catalogue.h.
#include "engine/estimators/catalogue.h"

#include <stdexcept>

#include "engine/estimators/true_state.h"

namespace footfall::engine {

std::unique_ptr<Estimator> make_estimator(const behaviors::EstimatorSpec& spec,
                                          const model::RobotDescription& robot,
                                          const model::ControlModel& model) {
  static_cast<void>(model);
  switch (spec.type) {
    case behaviors::EstimatorType::true_state:
      return std::make_unique<TrueState>(robot);
    case behaviors::EstimatorType::motion_capture:
    case behaviors::EstimatorType::contact_kalman:
      break;
  }
  throw std::runtime_error("this estimator does not exist yet");
}

}  // namespace footfall::engine
