#include "lab/process/result_line.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/text/json_text.h"
#include "core/text/printable.h"

namespace footfall::lab {

nlohmann::json result_line(const std::string& out) {
  const std::size_t last = out.find_last_not_of(" \n\r\t");
  if (last == std::string::npos) return {};
  const std::size_t begin = out.rfind('\n', last) + 1;  // npos + 1 is 0
  nlohmann::json object = core::parse_json(std::string_view(out).substr(begin, last + 1 - begin));
  return object.is_object() ? object : nlohmann::json();
}

std::string text_at(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return "";
  if (found->is_string()) return core::printable_lines(found->get<std::string>());
  if (found->is_number_float()) return fmt::format("{:.6g}", found->get<double>());
  return core::json_text(*found);
}

}  // namespace footfall::lab
