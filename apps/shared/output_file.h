// Files that a command writes: whole or not at all.
#pragma once

#include <string>
#include <string_view>

namespace footfall::apps {

// Writes to a temporary file beside `path`, then renames it; the mode of a file that was there
// stays. Throws std::runtime_error (with the path and the reason) and leaves nothing behind.
void write_whole_file(const std::string& path, std::string_view text);
// The bytes of a file, of stdin for `-`. Throws std::runtime_error.
std::string read_whole_file(const std::string& path);
// What a program (looked up on PATH, no shell) writes to its stdout when given `input`. Throws
// std::runtime_error if it is missing or fails; `package` is named as where to get it.
std::string run_program(const std::string& program, const std::string& argument,
                        std::string_view input, const std::string& package);

}  // namespace footfall::apps
