// An OpenGL context without screen or window: EGL on no surface at all, drawn by the GPU or by
// Mesa.
#pragma once

namespace footfall::sim {

class FilmContext {
 public:
  // Throws std::runtime_error with one sentence if EGL, or OpenGL on it, is not to be had.
  FilmContext();
  ~FilmContext();
  FilmContext(const FilmContext&) = delete;
  FilmContext& operator=(const FilmContext&) = delete;
  // OpenGL calls of this thread go here.
  void make_current();

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace footfall::sim
