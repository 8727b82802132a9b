// Writes a video file by piping frames to ffmpeg. After or beside a run.
#pragma once

#include <cstdio>
#include <string>

#include "sim/view/image.h"

namespace footfall::sim {

class MovieWriter {
 public:
  // Throws core::MachineError with one sentence if ffmpeg is missing or the folder cannot be
  // written.
  MovieWriter(const std::string& path, int width, int height, double frames_per_second);
  ~MovieWriter();
  MovieWriter(const MovieWriter&) = delete;
  MovieWriter& operator=(const MovieWriter&) = delete;
  // Adds a frame of the size given above. Throws core::MachineError if ffmpeg has exited.
  void add(const Image& frame);
  // Completes the file. Throws core::MachineError if ffmpeg reports an error.
  void finish();

 private:
  std::string path_, part_;  // part_: until the film is whole
  std::FILE* pipe_ = nullptr;
};

}  // namespace footfall::sim
