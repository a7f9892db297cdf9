// gl_context.hpp: an OpenGL context without a window, on a GPU if there is one, else in software.
#pragma once
#include <string>

namespace roomradar {

enum class RendererChoice {
  kAuto,      ///< a working GPU if there is one, else software
  kGpu,       ///< a GPU, else Error
  kSoftware,  ///< Mesa's llvmpipe, else Error
};

/// Returns the choice in the environment variable ROOMRADAR_RENDERER: "gpu", "software" or "auto" (same as
/// unset).
/// @throws Error for any other value
RendererChoice renderer_choice_from_environment();

/// Owns an off-screen EGL display connection and an OpenGL core context of version 4.5 or later (reversed
/// depth needs glClipControl). The context is current on the thread that made it, and any code on that thread
/// may call GL. It has no default framebuffer, so everything draws into framebuffer objects. Clip space is
/// set here once (depth 0 to 1, lower left origin); code that changes it must restore it. Not thread safe.
/// Must outlive everything made with it (GpuMesh, DepthPass, GlRadar).
class GlContext {
 public:
  /// @throws Error listing the devices tried and why each failed (no EGL, no GPU, a version below 4.5)
  explicit GlContext(RendererChoice choice = renderer_choice_from_environment());
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Returns the driver's own name and GL version: "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5".
  [[nodiscard]] const std::string& renderer() const { return renderer_; }
  [[nodiscard]] bool is_software() const { return is_software_; }

  /// Makes the context current on the calling thread: after a window's context was current, or on another
  /// thread after release() on the first.
  /// @throws Error if the driver refuses
  void make_current() const;
  /// Releases the context from the calling thread.
  void release() const;

 private:
  void* display_ = nullptr;  // EGLDisplay
  void* context_ = nullptr;  // EGLContext
  std::string renderer_;
  bool is_software_ = true;
};

/// Discards pending GL errors, so require_drawn() reports later errors only.
void forget_gl_errors();

/// Throws Error "WHAT: the renderer ..." if a GL error has occurred since forget_gl_errors(), the context is
/// lost (a GPU that was reset or suspended), or no context is current on this thread. Data read from the
/// renderer is then invalid.
void require_drawn(const char* what);

}  // namespace roomradar
