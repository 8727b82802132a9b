// The name of a client of live tuning; see client_name.h.
#include "engine/live/client_name.h"

#include <unistd.h>

#include <cstdlib>
#include <stdexcept>

#include "core/text/printable.h"
#include "engine/edits/door.h"
#include "engine/live/host_name.h"

namespace footfall::engine {
namespace {

std::string user_at_host() {
  const char* const user = std::getenv("USER");
  const std::string name = user != nullptr && *user != '\0' ? user : std::to_string(::getuid());
  return core::on_one_line(name + "@" + host_name());
}

}  // namespace

std::string client_name(const std::string& who) {
  if (who.empty()) return core::printable(user_at_host(), kMaxWho);
  if (who.size() <= kMaxWho && core::printable(who, kMaxWho) == who) return who;
  throw std::invalid_argument("'" + core::printable(who, kMaxWho) +
                              "' is no name of a user: expected at most " +
                              std::to_string(kMaxWho) + " bytes of printable text");
}

}  // namespace footfall::engine
