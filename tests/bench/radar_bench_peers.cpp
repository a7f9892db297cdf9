// radar_bench_peers.cpp: loads the peers' modules from the program's folder.
#include "radar_bench_peers.hpp"

#include <dlfcn.h>

#include <filesystem>

namespace roomradar::bench {

std::vector<std::unique_ptr<Peer>> load_peers(std::vector<std::string>& missing) {
  struct Module {
    const char* file;
    const char* library;
    const char* package;
  };
  constexpr Module kModules[] = {{"radar_bench_fcl.so", "FCL", "libfcl-dev"},
                                 {"radar_bench_embree.so", "Embree", "libembree-dev"}};
  std::vector<std::unique_ptr<Peer>> peers;
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  for (const Module& module : kModules) {
    void* const handle = dlopen((folder / module.file).c_str(), RTLD_NOW | RTLD_LOCAL);  // never unloaded
    void* const make = handle != nullptr ? dlsym(handle, "make_peers") : nullptr;
    if (make == nullptr) {
      missing.push_back(std::string(module.library) + " is left out: Debian's package " + module.package +
                        " brings it; build again with it installed (" + dlerror() + ")");
      continue;
    }
    reinterpret_cast<void (*)(std::vector<std::unique_ptr<Peer>>&)>(make)(peers);
  }
  return peers;
}

}  // namespace roomradar::bench
