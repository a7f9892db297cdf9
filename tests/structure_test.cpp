// structure_test.cpp: the layers of the modules: what each folder may include.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace roomradar::structure_test {
namespace {

namespace fs = std::filesystem;

/// The modules (folders) from the bottom up, one entry per layer. A module may include itself and modules of
/// lower layers only.
const std::vector<std::vector<std::string>> kLayers = {
    {"mapping/types/system", "mapping/types/json"},
    {"mapping/types"},
    {"mapping/types/codecs"},
    {"mapping/storage"},
    {"mapping/history", "mapping/mesh", "mapping/octree", "mapping/alignment", "radar/geometry", "dynamic/foreground",
     "dynamic/surface", "app/sources/formats", "app/sources/containers", "app/sources/video",
     "app/sim/solids"},
    {"app/sources/datasets", "app/sim/room"},
    {"mapping/surface", "mapping/surface/unknown", "mapping/revision", "mapping/localization",
     "mapping/coverage", "mapping/texture", "radar/exact", "radar/gl", "app/sources/decisions",
     "app/calibration", "app/sim/building"},
    {"app/sources/recordings"},
    {"mapping/odometry", "mapping/map", "radar/motion", "radar/depth", "radar/batch", "app/sources/kinect",
     "app/sim/sensor", "app/quality", "app/models"},
    {"mapping/building"},
    {"mapping", "app/sim/scenarios", "app/sim", "app/physics", "app/physics/placement", "app/render",
     "app/media", "app/page", "app/farm"},
    {"app/objects", "app/evaluation", "app/evaluation/pareto", "app/scan/live"},
    {"app/session/tiles"},
    {"app/session"},
    {"app/session/script", "app/c_api"},
    {"app/c_api/godot"},
    {"app/cli/options"},
    {"app/cli"},
    {"app/window/link", "app/scan", "app/start", "app/building", "app/evaluation/fallthrough", "app/python"},
    {"app/window/panes", "app/run", "app/serve", "app/evaluation/trade"},
    {"app/window"},
    {"app/window/scan", "app/window/start"},
    {"app/commands"},
    {"app", "app/programs"},
};

/// Folders that include only themselves and the folders named: finer than the layers.
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"mapping", {"mapping"}},
    {"radar", {"radar", "mapping/types"}},
    {"dynamic", {"dynamic", "mapping/types"}},
    {"app/sources", {"app/sources", "mapping/types", "mapping/alignment"}},
    {"app/calibration", {"app/calibration", "app/sources", "mapping/types"}},
    {"app/physics", {"app/physics", "radar", "mapping/types"}},
    {"app/farm", {"app/farm", "app/sources/formats", "mapping/storage", "mapping/types"}},
    {"app/models", {"app/models", "mapping/mesh", "mapping/types"}},
    {"app/c_api",
     {"app/c_api", "app/session", "app/objects", "app/quality", "app/sources", "mapping", "radar"}},
    {"app/sim/solids", {"app/sim", "mapping/types"}},
    {"app/sim/room", {"app/sim", "mapping/types"}},
    {"app/sim/building", {"app/sim", "mapping/types"}},
    {"app/sim/sensor", {"app/sim", "mapping/types"}},
    {"app/sim/scenarios", {"app/sim", "mapping/types"}},
};

struct Source {
  std::string path;  // relative to the project
  std::string module;
  std::vector<std::string> includes{};  // of the project, relative to it
};

std::vector<Source> all_sources() {
  const fs::path root = ROOMRADAR_SOURCE_DIR;
  std::vector<Source> sources;
  for (const char* top : {"mapping", "radar", "dynamic", "app"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / top)) {
      const fs::path extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp" && extension != ".h") continue;
      const fs::path relative = entry.path().lexically_relative(root);
      if (relative.string().find("/_skbuild/") != std::string::npos) continue;  // build folder of a wheel
      Source source{relative.generic_string(), relative.parent_path().generic_string()};
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        constexpr std::string_view kInclude = "#include \"";
        if (line.rfind(kInclude, 0) != 0) continue;
        const std::string named =
            line.substr(kInclude.size(), line.find('"', kInclude.size()) - kInclude.size());
        // Headers for C name those beside them, as they are installed.
        const bool is_beside = extension == ".h" && named.find('/') == std::string::npos;
        source.includes.push_back(is_beside ? source.module + "/" + named : named);
      }
      sources.push_back(std::move(source));
    }
  }
  return sources;
}

std::map<std::string, std::size_t> layer_of_modules() {
  std::map<std::string, std::size_t> layers;
  for (std::size_t layer = 0; layer < kLayers.size(); ++layer)
    for (const std::string& module : kLayers[layer]) layers[module] = layer;
  return layers;
}

bool is_within(const std::string& module, const std::string& folder) {
  return module == folder || module.rfind(folder + "/", 0) == 0;
}

TEST(Structure, EveryModuleHasALayer) {
  const auto layers = layer_of_modules();
  std::set<std::string> modules;
  for (const Source& source : all_sources()) modules.insert(source.module);
  for (const std::string& module : modules)
    EXPECT_TRUE(layers.contains(module)) << module << " is not in kLayers";
  for (const auto& [module, layer] : layers)
    EXPECT_TRUE(modules.contains(module)) << module << " holds no source";
}

TEST(Structure, EveryIncludeGoesToALowerLayer) {
  const auto layers = layer_of_modules();
  for (const Source& source : all_sources()) {
    for (const std::string& include : source.includes) {
      const std::string to = fs::path(include).parent_path().generic_string();
      if (to == source.module) continue;
      ASSERT_TRUE(layers.contains(to)) << source.path << " includes " << include << ", which is in no module";
      EXPECT_LT(layers.at(to), layers.at(source.module)) << source.path << " includes " << include;
      for (const auto& [folder, allowed] : kMayInclude) {
        if (!is_within(source.module, folder)) continue;
        EXPECT_TRUE(
            std::any_of(allowed.begin(), allowed.end(), [&](const auto& a) { return is_within(to, a); }))
            << source.path << " includes " << include << "; " << folder << " may not";
      }
    }
  }
}

TEST(Structure, TheRadarWithoutGlIncludesNoGl) {
  for (const Source& source : all_sources()) {
    if (source.module != "radar/geometry" && source.module != "radar/exact" &&
        source.module != "radar/motion")
      continue;
    for (const std::string& include : source.includes)
      EXPECT_FALSE(is_within(fs::path(include).parent_path().generic_string(), "radar/gl"))
          << source.path << ": " << include;
  }
}

}  // namespace
}  // namespace roomradar::structure_test
