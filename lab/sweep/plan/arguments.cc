// Converts command-line options to the tree of a sweep file; see loader.h.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/diagnostics/quantity_hint.h"
#include "lab/suite/discovery.h"
#include "lab/sweep/plan/loader.h"
#include "lab/sweep/plan/yaml_build.h"

namespace footfall::lab {
namespace {

using core::Diagnostics;
using core::YamlNode;

std::string trimmed(std::string text) {
  text.erase(0, text.find_first_not_of(" \t"));
  text.erase(text.find_last_not_of(" \t") + 1);
  return text;
}

// Reads an option's text as YAML; positions in messages are the option's name.
class OptionReader {
 public:
  explicit OptionReader(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  YamlNode yaml(const std::string& text, const std::string& option) {
    return core::load_yaml_text(text, option, diagnostics_);
  }

  // Splits NAME=REST; an empty name after an error.
  std::pair<std::string, std::string> split(const std::vector<std::string>& texts,
                                            std::size_t index, const char* option) {
    const std::string& text = texts[index];
    const std::size_t equals = text.find('=');
    if (equals != std::string::npos && equals > 0) {
      return {trimmed(text.substr(0, equals)), trimmed(text.substr(equals + 1))};
    }
    bool rest = false;
    const std::string hint = core::split_argument_hint(texts, index, rest);
    if (!rest) {
      diagnostics_.error(
          {diagnostics_.add_file(option), 0, 0}, "expected",
          fmt::format("expected NAME=VALUES, got '{}'{}{}", text, hint.empty() ? "" : ": ", hint));
    }
    return {};
  }

  // As `test` reads them. A file has a range, or a list: of a malformed one it tells which entry.
  YamlNode seeds(const std::string& text) {
    const bool list = text.find(',') != std::string::npos;
    const auto parsed = parse_seeds(text);
    if (list && parsed) return yaml(fmt::format("[{}]", fmt::join(*parsed, ", ")), "--seeds");
    return yaml(list ? "[" + text + "]" : text, "--seeds");
  }

  // `130ms..160ms:4`, `[a, b]`, `{from: ...}`, or a single value.
  YamlNode values(const std::string& text, const std::string& option) {
    const std::size_t dots = text.find("..");
    const std::size_t colon = text.rfind(':');
    const bool grid = text.find_first_of("[{") == std::string::npos && dots != std::string::npos;
    if (grid && colon != std::string::npos && colon > dots) {
      return yaml(fmt::format("{{from: {}, to: {}, count: {}}}", text.substr(0, dots),
                              text.substr(dots + 2, colon - dots - 2), text.substr(colon + 1)),
                  option);
    }
    if (grid) {
      diagnostics_.error({diagnostics_.add_file(option), 1, 1}, "expected",
                         fmt::format("expected FROM..TO:COUNT or [A, B, ...], got '{}'", text));
      return {};
    }
    if (text.starts_with("[") || text.starts_with("{")) return yaml(text, option);
    return yaml("[" + text + "]", option);
  }

  // `uniform(1, 2)` or `{uniform: [1, 2]}`
  YamlNode distribution(const std::string& text, const std::string& option) {
    const std::size_t open = text.find('(');
    if (text.starts_with("{") || open == std::string::npos || text.back() != ')') {
      return yaml(text, option);
    }
    return yaml(fmt::format("{{{}: [{}]}}", text.substr(0, open),
                            text.substr(open + 1, text.size() - open - 2)),
                option);
  }

  // `none,mocap.dropout@5s` as a list.
  YamlNode faults(const std::string& text) {
    std::string list;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      const std::string item = text.substr(begin, end - begin);
      const std::size_t at = item.find('@');
      const std::size_t colon = item.find(':', at == std::string::npos ? 0 : at);
      if (!list.empty()) list += ", ";
      if (at == std::string::npos) {
        list += item;
      } else {
        list += fmt::format("{{fault: {}, at: {}", item.substr(0, at),
                            item.substr(at + 1, std::min(colon, item.size()) - at - 1));
        if (colon != std::string::npos) list += ", for: " + item.substr(colon + 1);
        list += "}";
      }
      begin = end + 1;
    }
    return yaml("[" + list + "]", "--faults");
  }

 private:
  Diagnostics& diagnostics_;
};

}  // namespace

YamlNode sweep_tree(const SweepArguments& a, bool scenario, Diagnostics& diagnostics) {
  OptionReader reader(diagnostics);
  YamlNode root = yaml_map({diagnostics.add_file("sweep"), 0, 0});
  const auto mark_of = [&](const char* option) {
    return core::Mark{diagnostics.add_file(option), 0, 0};
  };
  yaml_add(root, "sweep", yaml_scalar("1", root.mark));
  // Relative to the working folder, unlike paths in a file.
  yaml_add(root, scenario ? "scenario" : "behavior", yaml_scalar(a.what, {}));
  const auto text = [&](const char* key, const std::string& value, const char* option) {
    if (!value.empty()) yaml_add(root, key, yaml_scalar(value, mark_of(option)));
  };
  text("robot", a.robot, "--robot");
  if (!a.worlds.empty()) yaml_add(root, "worlds", reader.yaml("[" + a.worlds + "]", "--worlds"));
  if (!a.faults.empty()) yaml_add(root, "faults", reader.faults(a.faults));
  if (!a.seeds.empty()) yaml_add(root, "seeds", reader.seeds(a.seeds));
  text("for", a.duration, "--for");
  const auto by_name = [&](const char* key, const std::vector<std::string>& texts,
                           const std::string& option, auto read) {
    if (texts.empty()) return;
    YamlNode map = yaml_map(mark_of(option.c_str()));
    for (std::size_t k = 0; k < texts.size(); ++k) {
      const auto [name, rest] = reader.split(texts, k, option.c_str());
      if (name.empty()) continue;
      YamlNode value = read(rest, option + " " + name);
      if (!value.is_null()) yaml_add(map, name, std::move(value));
    }
    yaml_add(root, key, std::move(map));
  };
  const auto values = [&](const std::string& t, const std::string& o) {
    return reader.values(t, o);
  };
  by_name("vary", a.vary, "--vary", values);
  by_name("zip", a.zip, "--zip", values);
  by_name("of", a.sample, "--sample",
          [&](const std::string& t, const std::string& o) { return reader.distribution(t, o); });
  if (!a.sample.empty()) {
    YamlNode of = std::move(root.entries.back().value);
    root.entries.pop_back();
    YamlNode sample = yaml_map(of.mark);
    yaml_add(sample, "count", yaml_scalar(a.count.empty() ? "20" : a.count, mark_of("--count")));
    if (!a.sample_seed.empty())
      yaml_add(sample, "seed", yaml_scalar(a.sample_seed, mark_of("--sample-seed")));
    if (!a.method.empty()) yaml_add(sample, "method", yaml_scalar(a.method, mark_of("--method")));
    yaml_add(sample, "of", std::move(of));
    yaml_add(root, "sample", std::move(sample));
  }
  if (!a.figures.empty()) {
    YamlNode list;
    list.kind = YamlNode::Kind::sequence;
    for (const std::string& name : a.figures) list.items.push_back(yaml_scalar(name, {}));
    yaml_add(root, "figures", std::move(list));
  }
  text("timeout", a.timeout, "--timeout");
  return root;
}

}  // namespace footfall::lab
