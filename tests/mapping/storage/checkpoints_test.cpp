// checkpoints_test.cpp: states on disk are complete or absent; the newest intact one of the same scan is
// resumed.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "mapping/storage/checkpoints.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::checkpoints_test {
namespace {

namespace fs = std::filesystem;
using test::error_of;

const std::map<std::string, std::string> kScan = {{"source", "sim:table"}, {"resolution", "0.01"}};

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class CheckpointsTest : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path folder() const { return temporary_.path() / "map.unfinished"; }
  /// Writes checkpoints 1 .. count, each with its number in `state`, and a `same` that is carried over.
  void write(int count) const {
    Checkpoints checkpoints(folder(), kScan, 0.0);
    for (int i = 1; i <= count; ++i) {
      checkpoints.write("track", [i](const fs::path& into, const fs::path& previous) {
        std::ofstream(into / "state") << i;
        fs::create_directory(into / "below");
        if (!carry_over(previous / "below/same", into / "below/same"))
          std::ofstream(into / "below/same") << "large";
      });
    }
  }

 private:
  test::TemporaryFolder temporary_;
};

TEST_F(CheckpointsTest, TheNewestIsReadBackAndOneMoreIsKept) {
  write(5);
  Checkpoints checkpoints(folder(), kScan, 0.0);
  const auto newest = checkpoints.resume();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->stage, "track");
  EXPECT_EQ(text_of(newest->folder / "state"), "5");
  EXPECT_TRUE(checkpoints.faults().empty());
  EXPECT_TRUE(fs::exists(folder() / "checkpoint-4"));
  EXPECT_FALSE(fs::exists(folder() / "checkpoint-3"));
  checkpoints.remove();
  EXPECT_FALSE(fs::exists(folder()));
}

TEST_F(CheckpointsTest, WhatHasNotChangedIsTheSameFile) {
  write(3);
  EXPECT_TRUE(fs::equivalent(folder() / "checkpoint-2/below/same", folder() / "checkpoint-3/below/same"));
  EXPECT_EQ(text_of(folder() / "checkpoint-3/below/same"), "large");
}

TEST_F(CheckpointsTest, NothingIsThereBeforeTheFirst) {
  Checkpoints checkpoints(folder(), kScan, 3600.0);
  EXPECT_FALSE(checkpoints.resume());
  EXPECT_FALSE(checkpoints.is_due());
  EXPECT_FALSE(fs::exists(folder()));
}

TEST_F(CheckpointsTest, WorkAboutToStopGetsOneMoreBeforeItsTime) {
  Checkpoints checkpoints(folder(), kScan, 1000.0);
  const auto write = [&] {
    checkpoints.write("track", [](const fs::path& into, const fs::path&) { std::ofstream(into / "state"); });
  };
  EXPECT_FALSE(checkpoints.is_due());
  EXPECT_FALSE(checkpoints.is_due_at_end());
  checkpoints.write_soon();
  EXPECT_TRUE(checkpoints.is_due_at_end());
  ASSERT_TRUE(checkpoints.is_due());
  write();
  EXPECT_FALSE(checkpoints.is_due()) << "one is enough";
  checkpoints.write_soon();
  EXPECT_TRUE(checkpoints.is_due()) << "also while one is being written";
  EXPECT_TRUE(checkpoints.has_any());
}

TEST_F(CheckpointsTest, TheEndOfAStageDoesNotWaitForAWriterIfNoOtherIsDue) {
  const fs::path go_on = folder().parent_path() / "go_on";
  Checkpoints checkpoints(folder(), kScan, 1000.0);
  checkpoints.write("fuse", [&](const fs::path& into, const fs::path&) {
    for (int tenths = 0; tenths < 100 && !fs::exists(go_on); ++tenths)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::ofstream(into / "state") << "7";
  });
  EXPECT_FALSE(checkpoints.is_due_at_end());
  EXPECT_FALSE(fs::exists(folder() / "checkpoint-1")) << "it is still being written";
  std::ofstream(go_on) << "";
  EXPECT_TRUE(checkpoints.has_any());
}

TEST_F(CheckpointsTest, AFolderWithNothingToGoOnFromGoes) {
  { Checkpoints(folder(), kScan, 0.0).ensure_folder(); }
  EXPECT_FALSE(fs::exists(folder()));
  {
    Checkpoints checkpoints(folder(), kScan, 0.0);
    checkpoints.ensure_folder();
    EXPECT_FALSE(checkpoints.has_any());
    std::ofstream(folder() / "spool") << "a live scan";
  }
  EXPECT_TRUE(fs::exists(folder() / "spool"));
  fs::remove(folder() / "spool");
  write(1);
  EXPECT_TRUE(fs::exists(folder() / "checkpoint-1"));
}

TEST_F(CheckpointsTest, WhatSomebodyElseKeepsInTheFolderIsNamed) {
  EXPECT_NO_THROW(require_checkpoints_only(folder(), "spool"));
  write(2);
  std::ofstream(folder() / "spool") << "a live scan";
  EXPECT_NO_THROW(require_checkpoints_only(folder(), "spool"));
  EXPECT_NE(error_of([&] { require_checkpoints_only(folder(), "x"); }).find("spool"), std::string::npos);
  std::ofstream(folder() / "thesis.txt") << "years of work";
  EXPECT_NE(error_of([&] { require_checkpoints_only(folder(), "spool"); }).find("thesis.txt"),
            std::string::npos);
}

TEST_F(CheckpointsTest, LitterOfDesktopsDoesNotHinder) {
  {
    Checkpoints checkpoints(folder(), kScan, 0.0);
    checkpoints.ensure_folder();
    test::add_litter(folder());
  }
  EXPECT_FALSE(fs::exists(folder())) << "there was nothing to resume";
  write(2);
  test::add_litter(folder());
  EXPECT_NO_THROW(require_checkpoints_only(folder(), ""));
  Checkpoints checkpoints(folder(), kScan, 0.0);
  const auto newest = checkpoints.resume();
  ASSERT_TRUE(newest);
  EXPECT_EQ(text_of(newest->folder / "state"), "2");
  EXPECT_TRUE(checkpoints.faults().empty());
}

TEST_F(CheckpointsTest, TheStateIsThatOfTheMomentWhateverTheWorkDoesMeanwhile) {
  int state = 7;
  {
    Checkpoints checkpoints(folder(), kScan, 0.0);
    checkpoints.write("fuse", [&](const fs::path& into, const fs::path&) {
      std::ofstream(into / "state") << state;
      state = 100;  // in the writer process's memory only
    });
    EXPECT_EQ(state, 7);
    state = 8;
  }
  EXPECT_EQ(text_of(folder() / "checkpoint-1/state"), "7");
}

TEST_F(CheckpointsTest, AWriterThatFailsLeavesTheOneBefore) {
  write(1);
  Checkpoints checkpoints(folder(), kScan, 0.0);
  std::vector<std::string> told;
  checkpoints.tell_failure([&](const std::string& sentence) { told.push_back(sentence); });
  ASSERT_TRUE(checkpoints.resume());
  for (int failures = 1; failures <= 2; ++failures) {
    checkpoints.write("track", [](const fs::path& into, const fs::path&) {
      std::ofstream(into / "state") << "half";
      throw std::runtime_error("disk full");
    });
    EXPECT_TRUE(checkpoints.is_due_at_end());
    EXPECT_EQ(checkpoints.failures(), failures);
    ASSERT_EQ(told.size(), 1U);  // reported immediately, and only once
  }
  EXPECT_NE(told[0].find("the previous checkpoint"), std::string::npos) << told[0];
  const auto newest = checkpoints.resume();
  ASSERT_TRUE(newest);
  EXPECT_EQ(text_of(newest->folder / "state"), "1");
}

TEST_F(CheckpointsTest, ADamagedOneIsPassedOverAndNamed) {
  for (const char* file : {"state", "below/same", "manifest.json"}) {
    for (const int how : {0, 1, 2}) {
      fs::remove_all(folder());
      write(3);
      // `same` is one hard-linked file in both, so a copy replaces it before it is damaged in one.
      const fs::path path = folder() / "checkpoint-3" / file;
      std::string bytes = text_of(path);
      fs::remove(path);
      if (how == 0) bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
      if (how == 1) bytes.resize(bytes.size() / 2);
      if (how != 2) std::ofstream(path, std::ios::binary) << bytes;
      Checkpoints checkpoints(folder(), kScan, 0.0);
      const auto newest = checkpoints.resume();
      ASSERT_TRUE(newest) << file << how;
      EXPECT_EQ(text_of(newest->folder / "state"), "2") << file << how;
      ASSERT_EQ(checkpoints.faults().size(), 1U) << file << how;
      EXPECT_NE(checkpoints.faults().front().find("checkpoint-3"), std::string::npos);
    }
  }
}

TEST_F(CheckpointsTest, AManifestCannotNameWhatLiesOutside) {
  write(1);
  std::ofstream(folder().parent_path() / "secret") << "s";
  std::string manifest = text_of(folder() / "checkpoint-1/manifest.json");
  manifest.replace(manifest.find("\"state\""), 7, "\"../../secret\"");
  std::ofstream(folder() / "checkpoint-1/manifest.json") << manifest;
  Checkpoints checkpoints(folder(), kScan, 0.0);
  EXPECT_FALSE(checkpoints.resume());
  EXPECT_EQ(checkpoints.faults().size(), 1U);
}

TEST_F(CheckpointsTest, OtherWorkIsRefusedAndTheDifferenceNamed) {
  write(1);
  const std::string message = error_of([&] {
    Checkpoints(folder(), {{"source", "sim:table"}, {"resolution", "0.02"}}, 0.0).resume();
  });
  EXPECT_NE(message.find("resolution"), std::string::npos) << message;
  EXPECT_NE(message.find("0.01"), std::string::npos) << message;
  EXPECT_NE(message.find("0.02"), std::string::npos) << message;
  EXPECT_TRUE(fs::exists(folder() / "checkpoint-1"));
  std::ofstream(folder() / "work.json") << "{";
  EXPECT_NE(error_of([&] { Checkpoints(folder(), kScan, 0.0).resume(); }).find("work.json"),
            std::string::npos);
}

TEST_F(CheckpointsTest, OnlyOneAtATimeMayHaveTheFolder) {
  Checkpoints first(folder(), kScan, 0.0);
  first.ensure_folder();
  const std::string message = error_of([&] { Checkpoints(folder(), kScan, 0.0).ensure_folder(); });
  EXPECT_NE(message.find("another roomradar"), std::string::npos) << message;
}

}  // namespace
}  // namespace roomradar::checkpoints_test
