// video_codecs.cpp: searches the module, loads it with dlopen(), and checks its version.
#include "app/sources/video/video_codecs.hpp"

#include <dlfcn.h>
#include <link.h>

#include <array>
#include <filesystem>
#include <string>
#include <system_error>

#include "mapping/types/system/error.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr char kFile[] = "roomradar-video.so";

/// Returns the folder of the program or library that contains this function.
fs::path own_folder() {
  Dl_info ignored{};
  link_map* own = nullptr;
  if (dladdr1(reinterpret_cast<const void*>(&own_folder), &ignored, reinterpret_cast<void**>(&own),
              RTLD_DL_LINKMAP) == 0)
    return {};
  // The program itself has no name in the list of libraries, and dli_fname is the word by which it was
  // called.
  const bool is_program = own->l_name == nullptr || own->l_name[0] == '\0';
  std::error_code fault;
  const fs::path file = fs::canonical(is_program ? "/proc/self/exe" : own->l_name, fault);
  return fault ? fs::path() : file.parent_path();
}

fs::path find_module() {
  const fs::path folder = own_folder(), libraries = ROOMRADAR_LIBDIR;
  std::array<fs::path, 5> places{folder, folder.parent_path() / libraries / "roomradar",
                                 folder.parent_path().parent_path() / libraries / "roomradar",
                                 fs::path(ROOMRADAR_PREFIX) / libraries / "roomradar",
                                 fs::path("/usr") / libraries / "roomradar"};
  std::error_code fault;
  for (const fs::path& place : places)
    if (place.is_absolute() && fs::is_regular_file(place / kFile, fault)) return place / kFile;
  throw Error("videos need the module " + std::string(kFile) + ", which the package roomradar installs in " +
              places.back().string() + "; it is missing");
}

const VideoCodecs& load() {
  const fs::path file = find_module();
  void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) throw Error("the module for videos cannot be loaded: " + std::string(dlerror()));
  const auto entry =
      reinterpret_cast<decltype(&roomradar_video_codecs)>(dlsym(module, "roomradar_video_codecs"));
  const VideoCodecs* const codecs = entry == nullptr ? nullptr : entry(kVersion);
  if (codecs == nullptr)
    throw Error(file.string() + ": is not of version " + kVersion + "; install the same version of both");
  return *codecs;
}

}  // namespace

const VideoCodecs& video_codecs() {
  static const VideoCodecs& codecs = load();  // again on the next call if it throws
  return codecs;
}

}  // namespace roomradar
