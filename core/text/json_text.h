// JSON values to text and back, compiled once: the library's reader and writer are slow to compile.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace footfall::core {

// One line, or indented by `indent` columns. Bytes that are not UTF-8 are replaced.
std::string json_text(const nlohmann::json& value, int indent = -1);
std::string json_text(const nlohmann::ordered_json& value, int indent = -1);
std::string json_text(const std::vector<std::string>& texts);  // a list

// Text that is not JSON gives a value whose is_discarded() is true; no exception.
nlohmann::json parse_json(std::string_view text);                  // keys sorted
nlohmann::ordered_json parse_ordered_json(std::string_view text);  // keys as in the text

}  // namespace footfall::core
