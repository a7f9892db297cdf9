// folder_entries_test.cpp: litter of desktops in folders, and zeros in messages.
#include "mapping/types/system/folders.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "mapping/types/system/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::folder_entries_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLitter[] = {"._0001.png",   ".DS_Store",       "__MACOSX",        ".directory",
                                   "Thumbs.db",    "desktop.ini",     ".Trash-1000",     ".AppleDouble",
                                   ".fseventsd",   ".Spotlight-V100", ".TemporaryItems", ".Trashes",
                                   "$RECYCLE.BIN", ".nfs00000012"};

TEST(FolderEntries, ListsWithoutLitterAndHiddenFiles) {
  const test::TemporaryFolder folder;
  for (const char* name : kLitter) std::ofstream(folder.path() / name) << "x";
  std::error_code fault;
  EXPECT_TRUE(entries_of(folder.path()).empty());
  EXPECT_TRUE(is_empty_folder(folder.path(), fault));
  std::ofstream(folder.path() / ".gitignore") << "x";
  EXPECT_TRUE(entries_of(folder.path()).empty()) << "hidden";
  EXPECT_FALSE(is_empty_folder(folder.path(), fault)) << "someone's work";
  for (const char* name : {"b", "a", "10", "9"}) std::ofstream(folder.path() / name) << "x";
  const fs::path at = folder.path();
  EXPECT_EQ(entries_of(at), (std::vector<fs::path>{at / "10", at / "9", at / "a", at / "b"}));
}

TEST(FolderEntries, SaysThatAFolderIsMissing) {
  const test::TemporaryFolder folder;
  std::error_code fault;
  EXPECT_THROW((void)entries_of(folder.path() / "none"), fs::filesystem_error);
  EXPECT_TRUE(entries_of(folder.path() / "none", fault).empty());
  EXPECT_TRUE(fault);
  EXPECT_FALSE(is_empty_folder(folder.path() / "none", fault));
}

TEST(FolderEntries, TakesFilesOfRecordingsAndMapsForNoLitter) {
  for (const char* name : {"map.json", "0001.png", "frame-000001.depth.png", "thumbs.dbx", "a._b", "_x", ""})
    EXPECT_FALSE(is_litter(name) || is_hidden_file(name)) << name;
  EXPECT_TRUE(is_hidden_file(".git"));
  EXPECT_FALSE(is_litter(".git"));
}

TEST(ErrorMessage, DoesNotEndAtAZeroOfADamagedFile) {
  using namespace std::string_literals;
  const Error error("a.log, line 1: '\0\x05\x1b[2J' is not\ta number\nline 2 ä"s);
  EXPECT_STREQ(error.what(), "a.log, line 1: '???[2J' is not\ta number\nline 2 ä");
}

}  // namespace
}  // namespace roomradar::folder_entries_test
