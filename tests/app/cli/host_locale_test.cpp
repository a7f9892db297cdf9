// host_locale_test.cpp: a program that loads the library may have set a locale with decimal commas and words
// of its own: no file and no message changes.
#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <locale>
#include <map>
#include <string>

#include "app/building/building_summary.hpp"
#include "app/cli/open_source.hpp"
#include "app/cli/report.hpp"
#include "app/page/room_page.hpp"
#include "app/quality/presets.hpp"
#include "app/session/script/script.hpp"
#include "app/sim/simulate.hpp"
#include "app/sources/formats/camera_rig.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/coverage/holes.hpp"
#include "mapping/map/map_export.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/prescan.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/saved_building.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::host_locale_test {
namespace {

namespace fs = std::filesystem;

/// Numbers of German: 1.234,5.
struct GermanNumbers : std::numpunct<char> {
  [[nodiscard]] char do_decimal_point() const override { return ','; }
  [[nodiscard]] char do_thousands_sep() const override { return '.'; }
  [[nodiscard]] std::string do_grouping() const override { return "\3"; }
};

/// The locale of a German host program, for C and C++; the classic one again at the end.
class GermanHost {
 public:
  GermanHost() {
    const std::string command =
        "localedef -i de_DE -f UTF-8 '" + (folder_.path() / "de_DE.UTF-8").string() + "' > /dev/null 2>&1";
    (void)!std::system(command.c_str());
    ::setenv("LOCPATH", folder_.path().c_str(), 1);
    is_set_ = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
    std::locale::global(std::locale(std::locale::classic(), new GermanNumbers));
  }
  GermanHost(const GermanHost&) = delete;
  GermanHost& operator=(const GermanHost&) = delete;
  ~GermanHost() {
    std::setlocale(LC_ALL, "C");
    std::locale::global(std::locale::classic());
    ::unsetenv("LOCPATH");
  }
  /// False: the system has no source of the locale (Debian: package locales).
  [[nodiscard]] bool is_set() const { return is_set_; }

 private:
  test::TemporaryFolder folder_;
  bool is_set_ = false;
};

using Texts = std::map<std::string, std::string>;

Texts files_below(const fs::path& folder) {
  Texts files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder).string()] = read_bytes(entry.path(), "a file");
  return files;
}

/// Without the temporary folder's name.
std::string message_of(const fs::path& folder, const std::function<void()>& act) {
  std::string message = test::error_of(act);
  for (std::size_t at; (at = message.find(folder.string())) != std::string::npos;)
    message.replace(at, folder.string().size(), "HERE");
  return message;
}

/// Scans, exports, records and fails in `folder`. Returns all sentences and the content of all files.
Texts work_in(const fs::path& folder) {
  Texts texts;
  const std::string spec = "sim:table?frames=14&width=160&seed=3&noise=0.5";
  SourceOptions options;
  options.cache_simulated = true;
  const auto source = open_source(spec, {}, {}, options);
  PrescanConfig config;
  config.resolution_m = 0.03;
  StageTimes times;
  const PrescanResult scanned = prescan(*source, config, times, {}, {});
  save_map(folder / "map", scanned.map);
  const SavedMap map = load_map(folder / "map");
  texts["map"] = describe(map.info);
  for (const Hole& hole : scanned.holes) texts["holes"] += describe(hole) + "\n";
  for (const char* name : {"a.ot", "a.bt", "a.ply", "a.obj", "a.stl", "a.glb"})
    export_map(folder / "map", folder / name);
  write_map_page(map, "map", folder / "map.html");
  texts["trajectory"] = std::to_string(read_trajectory(folder / "map/trajectory.txt").size());

  const SimOptions sim = parse_sim_spec("sim:wall?frames=3&width=640&rate=29.5");
  for (const auto& [name, format] :
       {std::pair("tum", RecordingFormat::kTum), std::pair("7scenes", RecordingFormat::kSevenScenes),
        std::pair("fakenect", RecordingFormat::kFakenect), std::pair("rosbag", RecordingFormat::kRosBag)}) {
    simulate(folder / name, sim, format);
    const auto recording = open_folder(folder / name);
    Frame frame;
    while (recording->next(frame).status != ReadStatus::kEnd) {
      texts[std::string("frames of ") + name] +=
          std::to_string(std::lround(1e6 * frame.stamp_s)) + " " +
          std::to_string(std::lround(1e3 * static_cast<double>(frame.depth_m.pixels[99]))) + " " +
          std::to_string(std::lround(1e3 * frame.depth_camera.fx_px)) + "\n";
    }
  }
  (void)test::write_small_building(folder / "building", "sim:table?seed=1&frames=20&rate=5&width=160");

  Report report;
  report.results["ratio"] = 1234.5;
  auto json = to_json(report);
  for (const char* measured : {"wall_s", "peak_rss_mb", "cpu_ms"}) json.erase(measured);
  texts["report"] = json.dump();
  const Script script =
      parse_script("frame 0 add pot teapot\ntime 1.5 drop pot at 0.25 -1.5 0.75\n", "s.txt");
  for (const ScriptEvent& event : script.events) texts["script"] += to_line(event) + "\n";
  texts["faults"] =
      message_of(folder,
                 [] { parse_script("frame 0 add pot teapot\ntime 1 drop pot at 1e9 0 0\n", "s.txt"); }) +
      "\n" + message_of(folder, [&] { (void)read_bytes(folder / "none", "a file"); }) + "\n" +
      message_of(folder, [&] { (void)load_map(folder / "none"); }) + "\n" +
      message_of(folder, [&] { (void)open_folder(folder / "tum/depth.txt/x"); }) + "\n" +
      message_of(folder, [&] { export_map(folder / "map", "/proc/none/a.ply"); }) + "\n" +
      message_of(folder, [] { parse_sim_spec("sim:table?noise=1,5"); }) + "\n" + message_of(folder, [&] {
        PrescanConfig wrong;
        wrong.resolution_m = 1234.5;
        (void)prescan(*source, wrong, times, {}, {});
      });
  texts.merge(files_below(folder));
  return texts;
}

TEST(HostLocale, ChangesNoFileAndNoMessage) {
  const test::TemporaryFolder here, there;
  const Texts classic = work_in(here.path());
  {
    const GermanHost host;
    if (!host.is_set()) GTEST_SKIP() << "install the package locales, which has the locale de_DE";
    char text[20];
    std::snprintf(text, sizeof text, "%.1f", 1.5);
    ASSERT_STREQ(text, "1,5") << "the host's locale";
    const Texts german = work_in(there.path());
    ASSERT_EQ(german.size(), classic.size());
    for (const auto& [name, content] : classic) {
      const auto other = german.find(name);
      ASSERT_NE(other, german.end()) << name;
      const bool is_text = content.find('\0') == std::string::npos && content.size() < 4000;
      EXPECT_TRUE(other->second == content)
          << name << (is_text ? ":\n" + content + "\n" + other->second : "");
    }
  }
  EXPECT_GT(classic.size(), 40U);
  EXPECT_FALSE(classic.at("faults").empty());
}

TEST(HostLocale, IsNotAskedByTheSources) {
  for (const char* part : {"app", "mapping", "dynamic", "radar"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ROOMRADAR_SOURCE_DIR) / part)) {
      const std::string extension = entry.path().extension().string();
      if ((extension != ".cpp" && extension != ".hpp") || entry.path().stem() == "classic_locale") continue;
      const std::string source = read_bytes(entry.path(), "a source");
      for (const char* call : {"snprintf(", "strerror(", "strtod(", "stod(", "stof(", "atof("})
        EXPECT_EQ(source.find(call), std::string::npos)
            << entry.path() << ": " << call
            << "...) depends on the locale of the host; use format_classic(), system_reason() or "
               "parse_number()";
    }
}

}  // namespace
}  // namespace roomradar::host_locale_test
