// Suggestions for words of the command line; see usage.h.
#include "apps/shared/usage.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <span>
#include <vector>

#include "core/diagnostics/did_you_mean.h"
#include "core/diagnostics/quantity_hint.h"

namespace footfall::apps {
namespace {

const CLI::App* child(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (command->get_name() == name) return command;
  }
  return nullptr;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

// The unknown word, and what was meant; empty if all words are known.
std::string unknown_word(const CLI::App& app, const std::vector<std::string>& words,
                         std::size_t after_command) {
  const auto commands = command_names(app);
  if (!commands.empty()) {
    if (after_command >= words.size()) return {};
    const std::string& word = words[after_command];
    if (word.starts_with('-') || child(app, word) != nullptr) return {};
    if (word == "help" || word == "version") {
      return fmt::format("unknown command '{0}' (did you mean '--{0}'?)", word);
    }
    return fmt::format("unknown command '{}'{}", word, core::did_you_mean_or_list(word, commands));
  }
  const auto options = option_names(app);
  for (std::size_t k = after_command; k < words.size(); ++k) {
    const std::string word = words[k].substr(0, words[k].find('='));
    if (word == "--") break;
    const bool option = word.size() > 1 && word[0] == '-' && word.find_first_of("0123456789") != 1;
    if (!option || std::ranges::find(options, word) != options.end()) continue;
    if (word[1] != '-' && std::ranges::find(options, word.substr(0, 2)) != options.end()) continue;
    // Of one letter all are near; most look for where the output goes.
    const std::string hint = word == "-o" || word == "--output" ? " (see --log, --out)" : "";
    return fmt::format("unknown option '{}'{}", word,
                       word[1] == '-' && hint.empty() ? core::did_you_mean(word, options) : hint);
  }
  return {};
}

// How to quote the value of an option that the shell has split, `--for 2 s`; empty if none was.
std::string split_value(const std::vector<std::string>& words, std::size_t after_command) {
  for (std::size_t k = after_command; k < words.size(); ++k) {
    if (!words[k].starts_with("--")) continue;
    const bool joined = words[k].find('=') != std::string::npos;  // --for=2 s
    const std::size_t unit = joined ? k + 1 : k + 2;
    if (unit >= words.size()) continue;
    bool rest = false;
    const std::string first = joined ? words[k] : words[k] + "=" + words[k + 1];
    const std::string hint = core::split_argument_hint({first, words[unit]}, 1, rest);
    if (!hint.empty()) return hint;
  }
  return {};
}

}  // namespace

std::string usage_error(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  std::vector<std::string> words;
  for (char* word : std::span(argv, static_cast<std::size_t>(argc)).subspan(1)) {
    words.emplace_back(word);
  }
  const CLI::App* at = &app;
  std::string name = "footfall";
  std::size_t after = 0;
  while (after < words.size()) {
    const CLI::App* const next = child(*at, words[after]);
    if (next == nullptr) break;
    at = next;
    name += " " + words[after++];
  }
  std::string text = unknown_word(*at, words, after);
  if (text.empty()) {
    text = error.what();
    const std::string hint = split_value(words, after);
    if (!hint.empty()) text += ": " + hint;
  }
  return fmt::format("footfall: error: {} (see {} --help)\n", text, name);
}

}  // namespace footfall::apps
