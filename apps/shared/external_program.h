// Calls external programs.
#pragma once

#include <string>
#include <string_view>

namespace footfall::apps {

// The stdout of a program (found on PATH, no shell) for the stdin `input`. Throws
// std::runtime_error if it is missing or fails; the message names `package`, which contains it.
std::string run_program(const std::string& program, const std::string& argument,
                        std::string_view input, const std::string& package);

}  // namespace footfall::apps
