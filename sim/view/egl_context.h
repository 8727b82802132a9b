// An OpenGL context without screen or window: EGL without a surface, rendered by the GPU or by
// Mesa.
#pragma once

namespace footfall::sim {

class FilmContext {
 public:
  // Throws std::runtime_error with one sentence if EGL or OpenGL is not available.
  FilmContext();
  ~FilmContext();
  FilmContext(const FilmContext&) = delete;
  FilmContext& operator=(const FilmContext&) = delete;
  // Makes this the current OpenGL context of the calling thread.
  void make_current();

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace footfall::sim
