// OpenGL without a screen; see egl_context.h.
#include "sim/view/egl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "core/process/machine_error.h"
namespace footfall::sim {
namespace {

[[noreturn]] void fail(const std::string& what) {
  std::array<char, 16> code{};
  std::snprintf(code.data(), code.size(), "0x%x", static_cast<unsigned>(eglGetError()));
  throw core::MachineError("cannot render pictures: " + what + " (EGL error " + code.data() +
                           "; are libegl1 and libgl1-mesa-dri installed?)");
}

// The display of Mesa's surfaceless platform; for drivers without it, the default display.
EGLDisplay open_display() {
  EGLDisplay display = EGL_NO_DISPLAY;
  const auto get_platform_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (get_platform_display != nullptr) {
    display = get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  }
  if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE) {
    return display;
  }
  display = eglGetDisplay(nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    fail("EGL has no display");
  }
  return display;
}

}  // namespace

FilmContext::FilmContext() : display_(open_display()) {
  // clang-format off
  constexpr std::array<EGLint, 13> kConfig = {
      EGL_RED_SIZE, 8, EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8, EGL_DEPTH_SIZE, 24,
      EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  // clang-format on
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display_, kConfig.data(), &config, 1, &count) != EGL_TRUE || count < 1) {
    fail("EGL has no fitting configuration");
  }
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) fail("EGL has no OpenGL");
  context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, nullptr);
  if (context_ == EGL_NO_CONTEXT) fail("EGL gives no OpenGL context");
  make_current();
}

FilmContext::~FilmContext() {
  // The display belongs to the process and is shared by all contexts, so it is not terminated.
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

void FilmContext::make_current() {
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
    fail("EGL cannot work without a surface");
  }
}

}  // namespace footfall::sim
