// The program's version, from the build.
#pragma once

namespace footfall::lab {

inline constexpr const char* kVersion = FOOTFALL_VERSION;

}  // namespace footfall::lab
