// Writes output files atomically and calls external programs.
#pragma once

#include <string>
#include <string_view>

namespace footfall::apps {

// Writes to a temporary file beside `path`, then renames it; keeps the mode of an existing file.
// Throws std::runtime_error (with path and reason) and leaves nothing behind.
void write_whole_file(const std::string& path, std::string_view text);
// Content of a file, of stdin for `-`. Throws std::runtime_error.
std::string read_whole_file(const std::string& path);
// The stdout of a program (found on PATH, no shell) for the stdin `input`. Throws
// std::runtime_error if it is missing or fails; the message names `package`, which contains it.
std::string run_program(const std::string& program, const std::string& argument,
                        std::string_view input, const std::string& package);

}  // namespace footfall::apps
