// The shared key of live tuning: whoever has it may change a run. 32 random bytes, as hexadecimal
// digits in a file that only its owner may read.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace footfall::engine {

using LiveKey = std::array<std::uint8_t, 32>;

// The user's default key file: $XDG_RUNTIME_DIR/footfall/lcm.key, else
// $HOME/.config/footfall/lcm.key. Throws std::runtime_error with one sentence if neither variable
// is set.
std::string default_key_path();

// Throws std::runtime_error (`PATH: error: reason, remedy`) if the file is missing, contains no
// key, or can be read by users other than its owner.
LiveKey read_key(const std::string& path);

// Creates a file with a new key atomically, mode 0600; its folders with mode 0700. Throws
// std::runtime_error if it exists already or cannot be written.
void make_key(const std::string& path);

// The key of default_key_path(), created if missing: engine and clients of one user on one host
// share it without setup. Processes that start at the same time get the same key.
LiveKey default_key();

}  // namespace footfall::engine
