// Writes output files atomically and calls external programs.
#pragma once

#include <string>
#include <string_view>

namespace footfall::apps {

// What a program (looked up on PATH, no shell) writes to its stdout when given `input`. Throws
// std::runtime_error if it is missing or fails; `package` is named as where to get it.
std::string run_program(const std::string& program, const std::string& argument,
                        std::string_view input, const std::string& package);

}  // namespace footfall::apps
