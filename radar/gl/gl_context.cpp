// gl_context.cpp: tries the machine's EGL devices, GPUs first, and takes the first with OpenGL 4.5.
#include "radar/gl/gl_context.hpp"

#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// A way to reach a renderer.
struct Candidate {
  EGLDisplay display = EGL_NO_DISPLAY;
  std::string name;  // for error messages
  bool is_software = false;
};

bool has_extension(const char* extensions, std::string_view name) {
  std::string_view rest = extensions != nullptr ? extensions : "";
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    if (word == name) return true;
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
  }
  return false;
}

template <typename Function>
Function egl_function(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// Returns the devices in EGL's order, GPUs before software, and last Mesa's surfaceless platform, which
/// needs no device.
std::vector<Candidate> candidates() {
  std::vector<Candidate> found;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto get_display = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (client == nullptr || get_display == nullptr) return found;
  const auto query_devices = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto query_device = egl_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  if (has_extension(client, "EGL_EXT_platform_device") && query_devices != nullptr &&
      query_device != nullptr) {
    EGLint count = 0;
    if (query_devices(0, nullptr, &count) == EGL_TRUE && count > 0) {
      std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
      query_devices(count, devices.data(), &count);
      for (EGLint i = 0; i < count; ++i) {
        Candidate candidate;
        const EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
        candidate.is_software =
            has_extension(query_device(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
        candidate.name = "EGL device " + std::to_string(i);
        candidate.display = get_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
        found.push_back(candidate);
      }
      std::stable_sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
        return !a.is_software && b.is_software;
      });
    }
  }
  if (has_extension(client, "EGL_MESA_platform_surfaceless")) {
    // Mesa chooses here; a context's renderer name shows whether it is software.
    found.push_back({get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                     "EGL surfaceless platform", true});
  }
  return found;
}

bool names_software(std::string_view renderer) {
  for (const std::string_view name : {"llvmpipe", "softpipe", "swrast", "SWR"}) {
    if (renderer.find(name) != std::string_view::npos) return true;
  }
  return false;
}

std::string gl_string(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text != nullptr ? reinterpret_cast<const char*>(text) : "";
}

/// Makes a current context on the candidate's display, or returns EGL_NO_CONTEXT and the reason in `fault`.
EGLContext make_context(const Candidate& candidate, std::string& fault) {
  if (candidate.display == EGL_NO_DISPLAY || eglInitialize(candidate.display, nullptr, nullptr) != EGL_TRUE) {
    fault = "cannot be initialised";
    return EGL_NO_CONTEXT;
  }
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) {
    fault = "has no desktop OpenGL";
    return EGL_NO_CONTEXT;
  }
  const EGLint config_wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint config_count = 0;
  if (eglChooseConfig(candidate.display, config_wanted, &config, 1, &config_count) != EGL_TRUE ||
      config_count == 0) {
    config = nullptr;  // EGL_KHR_no_config_context
  }
  const auto create = [&](EGLint major, EGLint minor, bool tells_loss) {
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                             major,
                             EGL_CONTEXT_MINOR_VERSION,
                             minor,
                             EGL_CONTEXT_OPENGL_PROFILE_MASK,
                             EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                             tells_loss ? EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY : EGL_NONE,
                             EGL_LOSE_CONTEXT_ON_RESET,
                             EGL_NONE};
    return eglCreateContext(candidate.display, config, EGL_NO_CONTEXT, wanted);
  };
  // With loss notification if available, so glGetGraphicsResetStatus reports a GPU reset.
  EGLContext context = create(4, 5, true);
  if (context == EGL_NO_CONTEXT) context = create(4, 5, false);
  if (context == EGL_NO_CONTEXT) {
    fault = "gives no OpenGL 4.5 core context";
    context = create(3, 1, false);  // to report the version it has
    if (context == EGL_NO_CONTEXT) return EGL_NO_CONTEXT;
    if (eglMakeCurrent(candidate.display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) {
      fault += ", only " + gl_string(GL_VERSION) + " on " + gl_string(GL_RENDERER);
      eglMakeCurrent(candidate.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglDestroyContext(candidate.display, context);
    return EGL_NO_CONTEXT;
  }
  if (eglMakeCurrent(candidate.display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
    fault = "gives a context that works only with a window";
    eglDestroyContext(candidate.display, context);
    return EGL_NO_CONTEXT;
  }
  return context;
}

}  // namespace

RendererChoice renderer_choice_from_environment() {
  const char* asked = std::getenv("ROOMRADAR_RENDERER");
  const std::string_view choice = asked != nullptr ? asked : "auto";
  if (choice == "auto" || choice.empty()) return RendererChoice::kAuto;
  if (choice == "gpu") return RendererChoice::kGpu;
  if (choice == "software") return RendererChoice::kSoftware;
  throw Error("ROOMRADAR_RENDERER = \"" + std::string(choice) + "\": must be gpu, software or auto");
}

GlContext::GlContext(RendererChoice choice) {
  std::string tried;
  std::vector<Candidate> all = candidates();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Candidate candidate = all[i];
    if (choice == RendererChoice::kSoftware && !candidate.is_software) continue;
    std::string fault;
    const EGLContext context = make_context(candidate, fault);
    if (context != EGL_NO_CONTEXT) {
      const std::string name = gl_string(GL_RENDERER);
      const bool is_software = names_software(name);
      // A GPU without a driver of its own also renders in software, though a better device may follow.
      const bool is_taken = choice == RendererChoice::kAuto
                                ? !is_software || candidate.is_software
                                : is_software == (choice == RendererChoice::kSoftware);
      if (is_taken) {
        display_ = candidate.display;
        context_ = context;
        is_software_ = is_software;
        GLint major = 0, minor = 0;
        glGetIntegerv(GL_MAJOR_VERSION, &major);
        glGetIntegerv(GL_MINOR_VERSION, &minor);
        renderer_ = name + ", OpenGL " + std::to_string(major) + "." + std::to_string(minor);
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        return;
      }
      eglMakeCurrent(candidate.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      eglDestroyContext(candidate.display, context);
      fault = "is " + name + ", not what was asked for";
      if (choice == RendererChoice::kAuto) {  // retry it after all others
        all.push_back(candidate);
        all.back().is_software = true;
      }
    }
    tried += "\n  " + candidate.name + " " + fault;
  }
  const char* wanted = choice == RendererChoice::kGpu        ? "a GPU renderer"
                       : choice == RendererChoice::kSoftware ? "the software renderer"
                                                             : "a renderer";
  throw Error(std::string("cannot get ") + wanted + " with OpenGL 4.5 through EGL" +
              (tried.empty() ? std::string(": EGL offers no device for it") : ":" + tried) +
              "\ninstall libegl1 and libgl1-mesa-dri (software), or a driver for the GPU" +
              (choice == RendererChoice::kAuto ? "" : ", or unset ROOMRADAR_RENDERER"));
}

GlContext::~GlContext() {
  // The display connection stays open: EGL returns the same one to every context of a device.
  if (eglGetCurrentContext() == context_) release();
  eglDestroyContext(display_, context_);
}

void GlContext::make_current() const {
  eglBindAPI(EGL_OPENGL_API);
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
    throw Error("cannot make the " + renderer_ +
                " context current: it may be current on another thread; release() it there first");
  }
}

void GlContext::release() const { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

void forget_gl_errors() {
  // a lost context never runs out of errors
  while (glGetError() != GL_NO_ERROR && glGetGraphicsResetStatus() == GL_NO_ERROR) {
  }
}

void require_drawn(const char* what) {
  if (eglGetCurrentContext() == EGL_NO_CONTEXT)
    throw Error(std::string(what) + ": the renderer's context is not current on this thread");
  const GLenum error = glGetError();
  const GLenum reset = glGetGraphicsResetStatus();
  if (error == GL_NO_ERROR && reset == GL_NO_ERROR) return;
  const char* why = reset != GL_NO_ERROR        ? "was reset, and what it held is lost; start again"
                    : error == GL_OUT_OF_MEMORY ? "has no memory left; close what else uses it"
                                                : "refused to draw; update the driver";
  throw Error(std::string(what) + ": the renderer " + why +
              ", or set ROOMRADAR_RENDERER=software to do without the GPU");
}

}  // namespace roomradar
