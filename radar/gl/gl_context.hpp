// gl_context.hpp: an OpenGL context without a window, on a GPU if there is one, else in software.
#pragma once
#include <string>

namespace roomradar {

enum class RendererChoice {
  /// Uses a working GPU if there is one, else software.
  kAuto,
  /// Requires a GPU; throws Error if there is none.
  kGpu,
  /// Requires a Mesa software renderer, e.g. llvmpipe; throws Error if there is none.
  kSoftware,
};

/// Returns the choice that the environment variable ROOMRADAR_RENDERER names: "gpu", "software" or "auto".
/// Unset or empty means "auto".
/// @throws Error for any other value
RendererChoice renderer_choice_from_environment();

/// Owns an off-screen EGL display connection and an OpenGL core context of version 4.5 or later (reversed
/// depth needs glClipControl). The context is current on the thread that made it. Any code on that thread may
/// call GL. The context has no default framebuffer, so everything is drawn into framebuffer objects. The
/// constructor sets the clip-space convention (depth 0 to 1, lower left origin). Code that changes the
/// convention must restore it. Not thread safe. Must outlive all objects made with it (GpuMesh, DepthPass,
/// GlRadar).
class GlContext {
 public:
  /// @throws Error listing the devices tried and why each failed (no EGL, no GPU, a version below 4.5)
  explicit GlContext(RendererChoice choice = renderer_choice_from_environment());
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Returns the driver's name and GL version, for example "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5".
  [[nodiscard]] const std::string& renderer() const { return renderer_; }
  [[nodiscard]] bool is_software() const { return is_software_; }

  /// Makes the context current on the calling thread. Necessary after another context (a window's) was
  /// current on this thread, or after another thread called release().
  /// @throws Error if the driver refuses
  void make_current() const;
  /// Releases the context from the calling thread, so another thread can call make_current().
  void release() const;

 private:
  // EGLDisplay.
  void* display_ = nullptr;
  // EGLContext.
  void* context_ = nullptr;
  std::string renderer_;
  bool is_software_ = true;
};

/// Discards pending GL errors, so require_drawn() reports only later ones.
void forget_gl_errors();

/// Throws Error if a GL error has occurred since forget_gl_errors(). Also throws if the context is lost (the
/// GPU was reset or suspended) or no context is current on this thread. If it throws, data read from the
/// renderer are invalid.
/// @param what  name of the failed task, which begins the message
void require_drawn(const char* what);

}  // namespace roomradar
