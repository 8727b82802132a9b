// Writes a video file by piping frames to ffmpeg. After or beside a run.
#pragma once

#include <cstdio>
#include <string>

#include "sim/view/image.h"

namespace footfall::sim {

class MovieWriter {
 public:
  // Throws std::runtime_error with one sentence if ffmpeg is missing or the folder cannot be
  // written.
  MovieWriter(const std::string& path, int width, int height, double frames_per_second);
  ~MovieWriter();
  MovieWriter(const MovieWriter&) = delete;
  MovieWriter& operator=(const MovieWriter&) = delete;
  // Adds a frame of the size given above. Throws std::runtime_error if ffmpeg has exited.
  void add(const Image& frame);
  // Completes the file. Throws std::runtime_error if ffmpeg reports an error.
  void finish();

 private:
  std::string path_;
  std::FILE* pipe_ = nullptr;
};

}  // namespace footfall::sim
