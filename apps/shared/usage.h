// Command lines that cannot be understood, explained.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace footfall::apps {

// The message, with a suggestion for an unknown command or option, and where the help is: that of
// the command at hand. Ends with a line feed.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv);

}  // namespace footfall::apps
