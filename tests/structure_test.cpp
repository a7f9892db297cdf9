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

/// The rooms from the bottom up, a line per floor. A room may include itself, rooms of lower floors, and
/// nothing else.
const std::vector<std::vector<std::string>> kFloors = {
    {"mapping/types/system", "mapping/types/json"},
    {"mapping/types"},
    {"mapping/types/codecs"},
    {"mapping/storage"},
    {"mapping/mesh", "mapping/octree", "mapping/alignment", "radar/geometry", "dynamic/foreground",
     "dynamic/surface", "app/sources/formats", "app/sources/containers", "app/sources/video",
     "app/sim/solids"},
    {"app/sources/datasets", "app/sim/room"},
    {"mapping/surface", "mapping/surface/unknown", "mapping/revision", "mapping/localization", "mapping/coverage", "mapping/texture",
     "radar/exact", "radar/gl", "app/sources/decisions", "app/calibration", "app/sim/building"},
    {"app/sources/recordings"},
    {"mapping/odometry", "mapping/map", "radar/motion", "radar/depth", "radar/batch", "app/sources/kinect",
     "app/sim/sensor", "app/quality", "app/models"},
    {"mapping/building"},
    {"mapping", "app/sim/scenarios", "app/sim", "app/physics", "app/physics/placement",
     "app/render", "app/media", "app/page", "app/farm"},
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
    {"app"},
};

/// Folders that include only themselves and the folders named: finer than the floors.
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
  std::string room;
  std::vector<std::string> includes{};  // of the project, relative to it
};

std::vector<Source> sources_of_the_house() {
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
        source.includes.push_back(is_beside ? source.room + "/" + named : named);
      }
      sources.push_back(std::move(source));
    }
  }
  return sources;
}

std::map<std::string, std::size_t> floor_of_rooms() {
  std::map<std::string, std::size_t> floors;
  for (std::size_t floor = 0; floor < kFloors.size(); ++floor)
    for (const std::string& room : kFloors[floor]) floors[room] = floor;
  return floors;
}

bool is_within(const std::string& room, const std::string& folder) {
  return room == folder || room.rfind(folder + "/", 0) == 0;
}

TEST(Structure, EveryRoomHasAFloor) {
  const auto floors = floor_of_rooms();
  std::set<std::string> rooms;
  for (const Source& source : sources_of_the_house()) rooms.insert(source.room);
  for (const std::string& room : rooms) EXPECT_TRUE(floors.contains(room)) << room << " is not in kFloors";
  for (const auto& [room, floor] : floors) EXPECT_TRUE(rooms.contains(room)) << room << " holds no source";
}

TEST(Structure, EveryIncludeGoesToALowerFloor) {
  const auto floors = floor_of_rooms();
  for (const Source& source : sources_of_the_house()) {
    for (const std::string& include : source.includes) {
      const std::string to = fs::path(include).parent_path().generic_string();
      if (to == source.room) continue;
      ASSERT_TRUE(floors.contains(to)) << source.path << " includes " << include << ", which is in no room";
      EXPECT_LT(floors.at(to), floors.at(source.room)) << source.path << " includes " << include;
      for (const auto& [folder, allowed] : kMayInclude) {
        if (!is_within(source.room, folder)) continue;
        EXPECT_TRUE(
            std::any_of(allowed.begin(), allowed.end(), [&](const auto& a) { return is_within(to, a); }))
            << source.path << " includes " << include << "; " << folder << " may not";
      }
    }
  }
}

TEST(Structure, TheRadarWithoutGlIncludesNoGl) {
  for (const Source& source : sources_of_the_house()) {
    if (source.room != "radar/geometry" && source.room != "radar/exact" && source.room != "radar/motion")
      continue;
    for (const std::string& include : source.includes)
      EXPECT_FALSE(is_within(fs::path(include).parent_path().generic_string(), "radar/gl"))
          << source.path << ": " << include;
  }
}

}  // namespace
}  // namespace roomradar::structure_test
