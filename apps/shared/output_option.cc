// Compares outputs with inputs; see output_option.h.
#include "apps/shared/output_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "apps/shared/commands.h"

namespace footfall::apps {

void require_no_input(const char* option, const std::string& output,
                      const std::vector<std::string>& inputs) {
  if (output.empty() || output == "-") return;
  std::error_code error;
  if (std::filesystem::is_directory(output, error)) {
    throw InputError(fmt::format("{}: error: '{}' is a folder, expected a file", option, output));
  }
  for (const std::string& input : inputs) {
    if (!std::filesystem::is_regular_file(output, error)) return;
    if (!std::filesystem::equivalent(output, input, error)) continue;
    throw InputError(
        fmt::format("{}: error: '{}' is a file that this command reads", option, output));
  }
}

void require_film_name(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (path.empty() || ending == ".mp4") return;
  throw InputError(
      fmt::format("--film: error: expected a file named *.mp4, got '{}': films are MP4", path));
}

}  // namespace footfall::apps
