// Substitutes template arguments in YAML; see context.h and substitution.h.
#include "behaviors/load/substitution.h"

#include <cctype>

#include "behaviors/load/context.h"
#include "behaviors/load/steps.h"

namespace footfall::behaviors {
namespace {

bool is_name_byte(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

const core::YamlNode* find_argument(const Arguments& arguments, std::string_view name) {
  for (const auto& [key, value] : arguments) {
    if (key == name) return &value;
  }
  return nullptr;
}

bool is_number(std::string_view text) {
  return !text.empty() && (text.front() == '-' || text.front() == '.' ||
                           std::isdigit(static_cast<unsigned char>(text.front())) != 0);
}

// Substitutes every `$name` of an argument in the text; `framed` inside expressions.
std::string substitute_text(const std::string& text, const Arguments& arguments, bool framed) {
  std::string out;
  std::size_t at = 0;
  while (at < text.size()) {
    if (text[at] != '$') {
      out += text[at++];
      continue;
    }
    std::size_t end = at + 1;
    while (end < text.size() && is_name_byte(text[end])) ++end;
    const auto* value =
        find_argument(arguments, std::string_view(text).substr(at + 1, end - at - 1));
    if (value == nullptr || !value->is_scalar()) {
      out.append(text, at, end - at);
    } else if (!framed) {
      out += value->scalar;
    } else {
      std::string part = value->scalar;
      if (core::is_expression(*value)) {
        part = "(" + part.substr(1) + ")";
      } else if (is_number(part)) {
        part = "(" + part + ")";
      }
      out += kMarkBegin;
      out += static_cast<char>(std::min<std::size_t>(end - at, 120));
      out += part + kMarkEnd;
    }
    at = end;
  }
  return out;
}

// Whether an argument may be the cause of an error in the text that it is put into: not a part of
// the robot, nor a plain number such as $side.
bool may_be_wrong(const core::YamlNode& value, const model::RobotDescription& robot) {
  if (!value.is_scalar()) return false;
  const std::string& text = value.scalar;
  const auto quantity = core::parse_quantity(text);
  if (quantity && quantity->bare) return false;
  return robot.find_contact(text) < 0 && robot.find_joint(text) < 0 && robot.find_group(text) < 0;
}

// Gives a place the cause that is the first doubtful argument of its text.
void add_cause(core::Mark& mark, const std::string& text, const Arguments& arguments,
               const model::RobotDescription& robot) {
  for (std::size_t at = text.find('$'); at != std::string::npos; at = text.find('$', at + 1)) {
    std::size_t end = at + 1;
    while (end < text.size() && is_name_byte(text[end])) ++end;
    const auto* value =
        find_argument(arguments, std::string_view(text).substr(at + 1, end - at - 1));
    if (value == nullptr || !may_be_wrong(*value, robot)) continue;
    mark.set_cause(value->mark);
    return;
  }
}

core::YamlNode substitute_node(const core::YamlNode& node, const Arguments& arguments,
                               const model::RobotDescription& robot, bool condition) {
  core::YamlNode out = node;
  if (node.is_scalar()) {
    if (node.scalar.find('$') == std::string::npos) return out;
    if (core::is_reference(node)) {
      if (const auto* value = find_argument(arguments, node.scalar.substr(1))) {
        out = *value;
        if (may_be_wrong(out, robot)) out.mark.set_cause(value->mark);
        return out;
      }
    }
    add_cause(out.mark, node.scalar, arguments, robot);
    out.scalar = substitute_text(node.scalar, arguments, condition || core::is_expression(node));
  }
  for (core::YamlNode& item : out.items) item = substitute_node(item, arguments, robot, false);
  for (core::YamlEntry& entry : out.entries) {
    const bool when = entry.key == "when";
    add_cause(entry.key_mark, entry.key, arguments, robot);
    entry.key = substitute_text(entry.key, arguments, false);
    entry.value = substitute_node(entry.value, arguments, robot, when);
  }
  return out;
}

}  // namespace

int MarkedText::column(int offset) const {
  const auto k = static_cast<std::size_t>(offset);
  if (k < columns.size()) return columns[k];
  return columns.empty() ? 0 : columns.back() + static_cast<int>(k - columns.size()) + 1;
}

bool MarkedText::is_inside(int offset) const {
  for (auto k = static_cast<std::size_t>(offset); k < text.size(); ++k) {
    if (inside[k]) return true;
    if (!is_name_byte(text[k]) && text[k] != '.') return false;
  }
  return false;
}

MarkedText read_marked(std::string_view text) {
  MarkedText out;
  int column = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == kMarkBegin && k + 1 < text.size()) {
      const int length = text[k + 1];
      int depth = 1;  // an argument may contain arguments itself
      for (k += 2; k < text.size(); ++k) {
        if (text[k] == kMarkBegin) {
          ++depth;
          ++k;
        } else if (text[k] == kMarkEnd) {
          if (--depth == 0) break;
        } else {
          out.text += text[k];
          out.columns.push_back(column);
          out.inside.push_back(true);
        }
      }
      column += length;
    } else if (text[k] != kMarkEnd) {
      out.text += text[k];
      out.columns.push_back(column++);
      out.inside.push_back(false);
    }
  }
  return out;
}

core::YamlNode substitute(const core::YamlNode& node, const Arguments& arguments,
                          const model::RobotDescription& robot) {
  return arguments.empty() ? node : substitute_node(node, arguments, robot, false);
}

}  // namespace footfall::behaviors
