// Reads calls without a parser: brackets, commas and quotes are enough; see source_ids.h.
#include "tests/language/mistakes/source_ids.h"

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string_view>

namespace footfall::tests {
namespace {

namespace fs = std::filesystem;

// The second argument of the call whose bracket opened before `at`; empty if it has fewer than
// three.
std::string second_argument(std::string_view text, std::size_t at) {
  int depth = 0, commas = 0;
  bool quoted = false;
  std::string argument;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quoted && c == '\\') {
      ++at;
      continue;
    }
    if (c == '"') quoted = !quoted;
    if (!quoted) {
      if (c == '(' || c == '[' || c == '{') ++depth;
      if (c == ')' || c == ']' || c == '}') --depth;
      if (depth < 0) return {};
      if (c == ',' && depth == 0 && ++commas == 2) return argument;
    }
    if (commas == 1) argument += c;
  }
  return {};
}

void read_source(const fs::path& path, std::map<std::string, std::string>& ids) {
  std::ostringstream content;
  content << std::ifstream(path).rdbuf();
  const std::string text = content.str();
  static const std::regex call(R"(\b(?:error|warning|fail|absence)\(|\berror = \{)");
  static const std::regex id(R"re("([a-z]+(?:-[a-z]+)*)")re");
  const std::sregex_iterator end;
  for (std::sregex_iterator found(text.begin(), text.end(), call); found != end; ++found) {
    const auto behind = static_cast<std::size_t>(found->position() + found->length());
    const std::string argument = second_argument(text, behind);
    for (std::sregex_iterator word(argument.begin(), argument.end(), id); word != end; ++word) {
      ids[(*word)[1]] = path.filename().string();
    }
  }
}

}  // namespace

std::map<std::string, std::string> ids_in_sources(const std::string& root) {
  std::map<std::string, std::string> ids;
  for (const char* folder : {"core", "model", "behaviors", "tasks", "sim", "lab"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(root) / folder)) {
      // What checks before a run find is listed in docs/behaviors.md, section 7, and has tests of
      // its own.
      const bool finding = entry.path().string().find("model/check/") != std::string::npos;
      if (!finding && entry.path().extension() == ".cc") read_source(entry.path(), ids);
    }
  }
  return ids;
}

}  // namespace footfall::tests
