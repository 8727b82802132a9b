// The shared key of live tuning: who has it may change what runs. 32 random bytes, as hexadecimal
// digits in a file that its owner alone may read.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace footfall::engine {

using LiveKey = std::array<std::uint8_t, 32>;

// The user's own: $XDG_RUNTIME_DIR/footfall/lcm.key, else $HOME/.config/footfall/lcm.key. Throws
// std::runtime_error with one sentence if neither variable is set.
std::string default_key_path();

// Throws std::runtime_error (`PATH: error: what, what to do`) if the file is not there, holds no
// key, or can be read by others than its owner.
LiveKey read_key(const std::string& path);

// Makes a file with a new key, mode 0600, whole or not at all; its folders too, mode 0700. Throws
// std::runtime_error if there is one already or it cannot be written.
void make_key(const std::string& path);

// The key of default_key_path(), made if there is none: engine and clients of one user on one host
// share it without being set up. Of several that begin at once all get the same.
LiveKey default_key();

}  // namespace footfall::engine
