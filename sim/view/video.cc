// Pipes frames to ffmpeg; see video.h.
#include "sim/view/video.h"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

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

}  // namespace

MovieWriter::MovieWriter(const std::string& path, int width, int height, double frames_per_second)
    : path_(path) {
  if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0) {
    throw std::runtime_error("cannot make the film '" + path +
                             "': ffmpeg is missing (apt-get install ffmpeg)");
  }
  if (!std::ofstream(path, std::ios::binary | std::ios::app)) {
    throw std::runtime_error("cannot write the film '" + path + "'");
  }
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  const std::string command =
      "ffmpeg -hide_banner -loglevel error -y -f rawvideo -pixel_format rgb24 -video_size " + size +
      " -framerate " + std::to_string(frames_per_second) +
      " -i - -c:v libx264 -preset veryfast -crf 23 -pix_fmt yuv420p -movflags +faststart " +
      quoted(as_path(path));
  std::signal(SIGPIPE, SIG_IGN);  // if ffmpeg exits early, add() reports it
  pipe_ = ::popen(command.c_str(), "w");
  if (pipe_ == nullptr) throw std::runtime_error("cannot start ffmpeg for the film '" + path + "'");
}

MovieWriter::~MovieWriter() {
  if (pipe_ != nullptr) ::pclose(pipe_);
}

void MovieWriter::add(const Image& frame) {
  if (std::fwrite(frame.rgb.data(), 1, frame.rgb.size(), pipe_) != frame.rgb.size()) {
    throw std::runtime_error("ffmpeg ended before the film '" + path_ + "' was whole");
  }
}

void MovieWriter::finish() {
  if (pipe_ == nullptr) return;
  const int status = ::pclose(pipe_);
  pipe_ = nullptr;
  if (status != 0) throw std::runtime_error("ffmpeg could not write the film '" + path_ + "'");
}

}  // namespace footfall::sim
