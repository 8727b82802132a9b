// Arguments of the programs that work on an engine as its users and enemies do: `--name value`.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "engine/lcm/client.h"

namespace footfall::tests {

class Options {
 public:
  Options(int argc, char** argv) {
    for (int i = 1; i + 1 < argc; i += 2) values_[argv[i]] = argv[i + 1];
  }
  std::string text(const std::string& name, const std::string& otherwise = "") const {
    const auto found = values_.find(name);
    return found == values_.end() ? otherwise : found->second;
  }
  double number(const std::string& name, double otherwise) const {
    const std::string value = text(name);
    return value.empty() ? otherwise : std::strtod(value.c_str(), nullptr);
  }
  // --url, --prefix, --key FILE, --who
  engine::LiveClientSettings client() const {
    engine::LiveClientSettings settings;
    settings.url = text("--url");
    settings.prefix = text("--prefix", settings.prefix);
    settings.who = text("--who");
    settings.key = text("--key").empty() ? engine::default_key() : engine::read_key(text("--key"));
    return settings;
  }

 private:
  std::map<std::string, std::string> values_;
};

// Ends the program with a sentence if there is no engine.
inline void connect_or_exit(engine::LiveClient& client) {
  if (client.connect(30.0)) return;
  std::fprintf(stderr, "%s\n", client.why_not().c_str());
  std::exit(3);
}

}  // namespace footfall::tests
