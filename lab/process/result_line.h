// The result that a child of ours prints: a JSON object on the last line of its output.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace footfall::lab {

// The object on the last non-empty line of `out`; null if there is none.
nlohmann::json result_line(const std::string& out);

// Its entry KEY as printable text; empty if absent or null.
std::string text_at(const nlohmann::json& object, const char* key);

}  // namespace footfall::lab
