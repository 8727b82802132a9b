// Pipes frames to ffmpeg; see video.h.
#include "sim/view/video.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "core/process/machine_error.h"
#include "core/text/whole_file.h"

namespace footfall::sim {
namespace {

// Quotes a text as one word for the shell.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// A path that begins with `-` would be read as an option.
std::string as_path(const std::string& path) { return path.starts_with('-') ? "./" + path : path; }

// The film under its own name is whole. ffmpeg takes the format from the ending.
std::string part_of(const std::string& path) {
  const std::filesystem::path film(path);
  return (film.parent_path() / (film.stem().string() + "." + std::to_string(::getpid()) + ".part"))
             .string() +
         film.extension().string();
}

}  // namespace

MovieWriter::MovieWriter(const std::string& path, int width, int height, double frames_per_second)
    : path_(path), part_(part_of(path)) {
  if (core::is_stream(path)) {
    throw core::MachineError("cannot write the film '" + path + "': it is no file");
  }
  if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0) {
    throw core::MachineError("cannot make the film '" + path +
                             "': ffmpeg is missing (apt-get install ffmpeg)");
  }
  if (!std::ofstream(part_, std::ios::binary)) {
    throw core::MachineError("cannot write the film '" + path + "'");
  }
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  const std::string command =
      "ffmpeg -hide_banner -loglevel error -y -f rawvideo -pixel_format rgb24 -video_size " + size +
      " -framerate " + std::to_string(frames_per_second) +
      " -i - -c:v libx264 -preset veryfast -crf 23 -pix_fmt yuv420p -movflags +faststart " +
      quoted(as_path(part_));
  std::signal(SIGPIPE, SIG_IGN);  // if ffmpeg exits early, add() reports it
  pipe_ = ::popen(command.c_str(), "w");
  if (pipe_ == nullptr) throw core::MachineError("cannot start ffmpeg for the film '" + path + "'");
}

MovieWriter::~MovieWriter() {
  if (pipe_ != nullptr) ::pclose(pipe_);
  std::remove(part_.c_str());
}

void MovieWriter::add(const Image& frame) {
  if (std::fwrite(frame.rgb.data(), 1, frame.rgb.size(), pipe_) != frame.rgb.size()) {
    throw core::MachineError("ffmpeg ended before the film '" + path_ + "' was whole");
  }
}

void MovieWriter::finish() {
  if (pipe_ == nullptr) return;
  const int status = ::pclose(pipe_);
  pipe_ = nullptr;
  if (status != 0 || std::rename(part_.c_str(), path_.c_str()) != 0) {
    throw core::MachineError("ffmpeg could not write the film '" + path_ + "'");
  }
}

}  // namespace footfall::sim
