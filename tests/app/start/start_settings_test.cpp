// start_settings_test.cpp: settings are kept, and damaged ones give a sentence and the defaults.
#include "app/start/start_settings.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::test::start_settings_test {
namespace {

namespace fs = std::filesystem;

TEST(StartSettings, AreReadAsTheyWereWritten) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "config/roomradar/start.json";
  EXPECT_EQ(read_start_settings(file).settings, StartSettings{});  // missing
  const StartSettings settings{"maps/Küche \"1\"", "kinect:0", 1.25};
  write_start_settings(settings, file);
  const ReadSettings read = read_start_settings(file);
  EXPECT_EQ(read.settings, settings);
  EXPECT_EQ(read.fault, "");
  write_start_settings({}, file);
  EXPECT_EQ(read_start_settings(file).settings, StartSettings{});
}

TEST(StartSettings, ADamagedFileGivesASentenceAndTheDefaults) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "start.json";
  for (const std::string& text :
       {std::string("nonsense"), std::string("[]"), std::string(R"({"last_map": 3})"),
        std::string(R"({"last_map": "maps/a", "ui_scale": "huge"})"), std::string(R"({"ui_scale": 1e9})"),
        std::string(R"({"ui_scale": -1})"), std::string(R"({"last_source": "a\u0000b"})"),
        R"({"last_map": ")" + std::string(5000, 'a') + "\"}", std::string(70000, '{'),
        std::string(70000, ' ')}) {
    std::ofstream(file) << text;
    const ReadSettings read = read_start_settings(file);
    EXPECT_EQ(read.settings, StartSettings{}) << text.substr(0, 80);
    EXPECT_EQ(read.fault.rfind(file.string() + ": ", 0), 0U) << read.fault;
    EXPECT_NE(read.fault.find("the default settings are used"), std::string::npos) << read.fault;
  }
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_NE(read_start_settings(file).fault, "");
}

TEST(StartSettings, AFolderThatCannotBeMadeIsNamed) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "config") << "a file";
  const fs::path file = folder.path() / "config/roomradar/start.json";
  EXPECT_NE(error_of([&] { write_start_settings({}, file); }).find("config"), std::string::npos);
  EXPECT_NE(error_of([&] { write_start_settings({}, {}); }).find("XDG_CONFIG_HOME"), std::string::npos);
}

TEST(StartSettings, LieInTheConfigurationFolder) {
  setenv("XDG_CONFIG_HOME", "/a/config", 1);
  EXPECT_EQ(start_settings_file(), "/a/config/roomradar/start.json");
  setenv("HOME", "/home/someone", 1);
  setenv("XDG_CONFIG_HOME", "relative", 1);
  EXPECT_EQ(start_settings_file(), "/home/someone/.config/roomradar/start.json");
  unsetenv("XDG_CONFIG_HOME");
  unsetenv("HOME");
  EXPECT_EQ(start_settings_file(), "");
}

}  // namespace
}  // namespace roomradar::test::start_settings_test
