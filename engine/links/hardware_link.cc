// What the hardware is told of the law; see hardware_link.h.
#include "engine/links/hardware_link.h"

#include "behaviors/compiled/control_set.h"

namespace footfall::engine {

void HardwareLink::tell(const behaviors::Machine& machine) noexcept {
  if (machine.control_spec() == control_) return;
  control_ = machine.control_spec();
  std::uint64_t support = 0;
  for (int c = 0; c < static_cast<int>(behavior_.robot.contacts.size()); ++c) {
    if (behaviors::law_holds(behavior_, control_, c))
      support |= std::uint64_t{1} << static_cast<unsigned>(c);
  }
  hardware_.set_support(support);
}

}  // namespace footfall::engine
