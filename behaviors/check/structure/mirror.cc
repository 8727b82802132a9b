// Literal left or right names of the robot inside a mirrored template, where only arguments are
// mirrored: both sides would use the same foot.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "behaviors/check/structure/structure.h"

namespace footfall::behaviors {
namespace {

// A name of one side of the robot in a text, and its position.
struct SideName {
  std::string name;
  std::string partner;
  int offset = 0;
};

bool is_name_byte(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

class MirrorCheck {
 public:
  MirrorCheck(LoadContext& context, const Arguments& arguments)
      : context_(context), arguments_(arguments) {}

  void scan_template(const std::string& name) {
    const core::YamlNode* templates = context_.section("templates");
    const core::YamlNode* body = templates == nullptr ? nullptr : templates->find(name);
    if (body != nullptr && scanned_.insert(body).second) scan(*body);
  }

 private:
  std::vector<SideName> side_names(const std::string& text) const {
    std::vector<SideName> out;
    for (std::size_t k = 0; k < text.size();) {
      if (!is_name_byte(text[k])) {
        ++k;
        continue;
      }
      const std::size_t first = k;
      while (k < text.size() && is_name_byte(text[k])) ++k;
      if (first > 0 && text[first - 1] == '$') continue;
      const std::string word = text.substr(first, k - first);
      for (const auto& [a, b] : context_.behavior.robot.symmetry) {
        if (word == a) out.push_back({a, b, static_cast<int>(first)});
        if (word == b) out.push_back({b, a, static_cast<int>(first)});
      }
    }
    return out;
  }

  // Keys whose values name states, stacks or templates, or are documentation.
  static bool names_no_side(std::string_view key) {
    for (const char* other : {"to", "initial", "default", "use", "mirror", "stack", "toward", "doc",
                              "reason", "log", "mark", "args", "type"}) {
      if (key == other) return true;
    }
    return false;
  }
  static bool holds_names(std::string_view key) {
    return key == "states" || key == "tasks" || key == "internal";
  }

  // Names of both sides together are not one-sided.
  void report(const std::vector<SideName>& names, const std::set<std::string>& beside,
              core::Mark mark, bool quoted) {
    for (const SideName& side : names) {
      if (beside.contains(side.partner)) continue;
      core::Mark place = mark;
      place.column += side.offset + (quoted ? 1 : 0);
      std::string hint;
      for (const auto& [argument, value] : arguments_) {
        if (value.scalar == side.name) hint = fmt::format(": write ${}", argument);
      }
      context_.warning(
          place, "not-mirrored",
          fmt::format("'{}' is the same foot or side in the mirror image{}", side.name, hint));
    }
  }

  void scan(const core::YamlNode& node, std::string_view under = {}) {
    std::set<std::string> here;  // one-sided names among the scalars and keys of this node
    const auto add = [&](const std::string& text) {
      for (const SideName& side : side_names(text)) here.insert(side.name);
    };
    for (const core::YamlNode& item : node.items) add(item.scalar);
    for (const core::YamlEntry& entry : node.entries) {
      if (!holds_names(under)) add(entry.key);
      if (!names_no_side(entry.key)) add(entry.value.scalar);
    }
    for (const core::YamlNode& item : node.items) {
      report(side_names(item.scalar), here, item.mark, item.quoted);
      scan(item);
    }
    for (const core::YamlEntry& entry : node.entries) {
      if (!holds_names(under)) {
        report(side_names(entry.key), here, entry.key_mark, entry.key_quoted);
      }
      follow(entry);
      if (names_no_side(entry.key)) continue;
      report(side_names(entry.value.scalar), here, entry.value.mark, entry.value.quoted);
      scan(entry.value, entry.key);
    }
  }

  // Templates and stacks named in the text belong to both sides, too.
  void follow(const core::YamlEntry& entry) {
    if (entry.key == "use" || entry.key == "mirror") scan_template(entry.value.scalar);
    if (entry.key != "stack" && entry.key != "toward") return;
    const core::YamlNode* stacks = context_.section("stacks");
    const core::YamlNode* stack = stacks == nullptr ? nullptr : stacks->find(entry.value.scalar);
    if (stack != nullptr && scanned_.insert(stack).second) scan(*stack);
  }

  LoadContext& context_;
  const Arguments& arguments_;
  std::set<const core::YamlNode*> scanned_;
};

}  // namespace

void check_mirror(LoadContext& context) {
  std::set<std::string> done;
  for (const auto& [name, arguments] : context.mirrored) {
    if (done.insert(name).second) MirrorCheck(context, arguments).scan_template(name);
  }
}

}  // namespace footfall::behaviors
