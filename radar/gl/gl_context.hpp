// gl_context.hpp: an OpenGL context without a window, on a GPU where there is one, else on the processor.
#pragma once
#include <string>

namespace roomradar {

enum class RendererChoice {
  kAuto,      ///< a working GPU where there is one, else software
  kGpu,       ///< a GPU or an Error
  kSoftware,  ///< Mesa's llvmpipe or an Error
};

/// What the environment variable ROOMRADAR_RENDERER asks for: "gpu", "software", or "auto" (the same as
/// unset).
/// @throws Error if it holds anything else
RendererChoice renderer_choice_from_environment();

/// Owns an off-screen EGL display connection and an OpenGL core context of version 4.5 or later (reversed
/// depth needs glClipControl). The context is current on the thread that made it, and any code that runs
/// there may call GL; it has no default framebuffer, so everything draws into framebuffer objects. Clip space
/// is set once, here, for all: depth 0 to 1, lower left origin; whoever changes that puts it back. Not thread
/// safe. Everything made with it (GpuMesh, DepthPass, GlRadar) must be gone before it is.
class GlContext {
 public:
  /// @throws Error saying which devices were tried and why each failed (no EGL, no GPU, a version below 4.5)
  explicit GlContext(RendererChoice choice = renderer_choice_from_environment());
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// As the driver names itself, with its GL version: "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5".
  [[nodiscard]] const std::string& renderer() const { return renderer_; }
  [[nodiscard]] bool is_software() const { return is_software_; }

  /// Makes the context current on the calling thread (after a window's context has been, or on another thread
  /// once the first has called release()).
  /// @throws Error if the driver refuses
  void make_current() const;
  /// Lets go of the context on the calling thread.
  void release() const;

 private:
  void* display_ = nullptr;  // EGLDisplay
  void* context_ = nullptr;  // EGLContext
  std::string renderer_;
  bool is_software_ = true;
};

/// Forgets errors of GL that nobody asked about: what require_drawn() says after it is of what came between.
void forget_gl_errors();

/// Throws Error "WHAT: the renderer ..." if GL met an error since they were forgotten, has lost its context
/// (a GPU that was reset, or slept), or none is current on this thread. What was read from it is then nothing
/// to go by.
void require_drawn(const char* what);

}  // namespace roomradar
