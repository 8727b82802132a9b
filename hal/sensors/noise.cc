// Random numbers; see noise.h.
#include "hal/sensors/noise.h"

#include <bit>
#include <random>

namespace footfall::hal {

NoiseStream::NoiseStream(std::uint64_t seed, NoiseSource source, std::uint32_t index) {
  std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                      static_cast<std::uint32_t>(source), index};
  std::array<std::uint32_t, 8> bits{};
  words.generate(bits.begin(), bits.end());
  for (std::size_t k = 0; k < state_.size(); ++k) {
    state_[k] = std::uint64_t{bits[2 * k]} << 32U | bits[2 * k + 1];
  }
  state_[0] |= 1U;  // not all bits are zero
}

std::uint64_t NoiseStream::next() noexcept {
  const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t shifted = state_[1] << 17U;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= shifted;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

}  // namespace footfall::hal
