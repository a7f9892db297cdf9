// gl_context_test.cpp: a context is created and described, and failures have clear messages.
#include "radar/gl/gl_context.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "mapping/types/system/error.hpp"

namespace roomradar::gl_context_test {
namespace {

/// Sets an environment variable for one scope.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) {
      had_ = true;
      old_ = old;
    }
    setenv(name, value, 1);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  ~Environment() { had_ ? setenv(name_, old_.c_str(), 1) : unsetenv(name_); }

 private:
  const char* name_;
  bool had_ = false;
  std::string old_;
};

constexpr const char* kNoSoftware =
    "this machine has no software renderer; Debian's package libgl1-mesa-dri brings it";

bool has_software_renderer() {
  try {
    const GlContext software(RendererChoice::kSoftware);
    return true;
  } catch (const Error&) {
    return false;
  }
}

TEST(GlContext, SoftwareRendererNamesItself) {
  if (!has_software_renderer()) GTEST_SKIP() << kNoSoftware;
  const GlContext context(RendererChoice::kSoftware);
  EXPECT_TRUE(context.is_software());
  EXPECT_NE(context.renderer().find("llvmpipe"), std::string::npos) << context.renderer();
  EXPECT_NE(context.renderer().find("OpenGL 4."), std::string::npos) << context.renderer();
}

TEST(GlContext, ChoiceComesFromTheEnvironment) {
  {
    const Environment set("ROOMRADAR_RENDERER", "software");
    EXPECT_EQ(renderer_choice_from_environment(), RendererChoice::kSoftware);
  }
  {
    const Environment set("ROOMRADAR_RENDERER", "gpu");
    EXPECT_EQ(renderer_choice_from_environment(), RendererChoice::kGpu);
  }
  {
    const Environment set("ROOMRADAR_RENDERER", "");
    EXPECT_EQ(renderer_choice_from_environment(), RendererChoice::kAuto);
  }
}

TEST(GlContext, UnknownChoiceIsNamedInTheMessage) {
  const Environment set("ROOMRADAR_RENDERER", "hardware");
  try {
    renderer_choice_from_environment();
    FAIL() << "\"hardware\" was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("ROOMRADAR_RENDERER = \"hardware\""), std::string::npos);
  }
}

TEST(GlContext, GpuIsGivenOrRefusedWithWhatToDo) {
  try {
    const GlContext context(RendererChoice::kGpu);
    EXPECT_FALSE(context.is_software());
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("cannot get a GPU renderer with OpenGL 4.5 through EGL"), std::string::npos)
        << message;
    EXPECT_NE(message.find("driver for the GPU"), std::string::npos) << message;
  }
}

TEST(GlContext, WithoutEglDriversTheMessageSaysWhatToInstall) {
  // libglvnd finds vendors only in these folders; with an empty folder there is no EGL. Runs in its own
  // process, because EGL searches once.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "", 1);
        int status = 1;
        try {
          const GlContext context(RendererChoice::kAuto);
        } catch (const Error& error) {
          const std::string message = error.what();
          const bool says_all = message.find("EGL offers no device") != std::string::npos &&
                                message.find("libgl1-mesa-dri") != std::string::npos;
          status = says_all ? 0 : 2;
        }
        std::_Exit(status);
      },
      testing::ExitedWithCode(0), "");
}

TEST(GlContext, ADriverThatGivesLessThanAskedIsNamedWithWhatItGives) {
  // In processes of their own, because Mesa reads its settings once.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  int software_status = 0;
  const auto ends = [&](int status) {
    software_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return software_status == 0 || software_status == 3;
  };
  EXPECT_EXIT(std::_Exit(has_software_renderer() ? 0 : 3), ends, "");
  if (software_status != 0) GTEST_SKIP() << kNoSoftware;
  EXPECT_EXIT(
      {
        setenv("MESA_GL_VERSION_OVERRIDE", "3.3", 1);
        int status = 1;
        try {
          const GlContext context(RendererChoice::kSoftware);
        } catch (const Error& error) {
          const std::string message = error.what();
          const bool says_all =
              message.find("gives no OpenGL 4.5 core context, only 3.3") != std::string::npos &&
              message.find("libgl1-mesa-dri") != std::string::npos;
          if (!says_all) std::fprintf(stderr, "%s\n", error.what());
          status = says_all ? 0 : 2;
        }
        std::_Exit(status);
      },
      testing::ExitedWithCode(0), "");
}

TEST(GlContext, SecondContextLeavesTheFirstUsable) {
  const GlContext first;
  { const GlContext second; }
  EXPECT_NO_THROW(first.make_current());
}

}  // namespace
}  // namespace roomradar::gl_context_test
