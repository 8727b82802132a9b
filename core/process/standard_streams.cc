// Null device and streams that remember their errors; see standard_streams.h.
#include "core/process/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "core/process/write_all.h"

namespace footfall::core {
namespace {

struct Sink {
  int descriptor;
  int error = 0;  // errno of the first write that failed; nothing is written after it
};

Sink g_out{STDOUT_FILENO};
Sink g_err{STDERR_FILENO};

// fopencookie's writer. It never reports an error: fmt would throw, in the middle of a run.
ssize_t write_or_remember(void* cookie, const char* data, std::size_t size) {
  auto& sink = *static_cast<Sink*>(cookie);
  if (sink.error == 0 && !write_all(sink.descriptor, {data, size})) sink.error = errno;
  return static_cast<ssize_t>(size);
}

std::FILE* stream_of(Sink& sink, int buffering) {
  std::FILE* const stream =
      ::fopencookie(&sink, "w", {nullptr, write_or_remember, nullptr, nullptr});
  if (stream != nullptr) std::setvbuf(stream, nullptr, buffering, BUFSIZ);
  return stream;
}

void open_descriptor(int number, int flags) {
  if (::fcntl(number, F_GETFD) >= 0 || errno != EBADF) return;
  // The lowest free number is this one, because those below were opened before.
  [[maybe_unused]] const int opened = ::open("/dev/null", flags);
}

}  // namespace

void open_standard_streams() {
  open_descriptor(STDIN_FILENO, O_RDONLY);
  open_descriptor(STDOUT_FILENO, O_WRONLY);
  open_descriptor(STDERR_FILENO, O_WRONLY);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // `ulimit -f`: an error of write() then, as on a full disk
  const bool terminal = ::isatty(STDOUT_FILENO) != 0;
  if (std::FILE* const out = stream_of(g_out, terminal ? _IOLBF : _IOFBF)) stdout = out;
  if (std::FILE* const err = stream_of(g_err, _IONBF)) stderr = err;
}

bool standard_output_failed() noexcept { return g_out.error != 0; }

std::string finish_standard_output() {
  std::fflush(stdout);
  return g_out.error == 0 || g_out.error == EPIPE ? std::string() : std::strerror(g_out.error);
}

}  // namespace footfall::core
