// manifest_test.cpp: which lists of jobs are read, and how faults are named.
#include "app/farm/manifest.hpp"

#include <gtest/gtest.h>

#include "tests/support/error_of.hpp"

namespace roomradar::manifest_test {
namespace {

Manifest parsed(const std::string& text) { return parse_manifest(text, "/jobs.txt"); }
std::string fault_of(const std::string& text) {
  return test::error_of([&] { (void)parsed(text); });
}
void expect_fault(const std::string& text, const std::string& fault) {
  EXPECT_NE(fault_of(text).find(fault), std::string::npos) << text << "\n" << fault_of(text);
}

TEST(Manifest, HoldsJobsWithWordsCostsAndNeeds) {
  const Manifest manifest = parsed(
      "# two scans\n\n"
      "evening (cost 2.5): prescan 'a folder/x' --map {}/map\r\n"
      "  change:  map diff {morning}/map \"{evening}/map\" --html {}/a\"b c\"'d'.html  \n"
      "morning: prescan y --map {}/map");
  ASSERT_EQ(manifest.jobs.size(), 3U);
  EXPECT_EQ(manifest.jobs[0].name, "evening");
  EXPECT_EQ(manifest.jobs[0].cost, 2.5);
  EXPECT_EQ(manifest.jobs[0].line, 3);
  EXPECT_EQ(manifest.jobs[0].words, (std::vector<std::string>{"prescan", "a folder/x", "--map", "{}/map"}));
  EXPECT_EQ(manifest.jobs[1].words, (std::vector<std::string>{"map", "diff", "{morning}/map", "{evening}/map",
                                                              "--html", "{}/ab cd.html"}));
  EXPECT_EQ(manifest.jobs[1].needs, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(manifest.jobs[2].cost, 0.0);
  EXPECT_TRUE(manifest.jobs[2].needs.empty());
}

TEST(Manifest, FaultsNameFileLineAndCure) {
  expect_fault("", "/jobs.txt: contains no jobs");
  expect_fault("# nothing\n", "contains no jobs");
  expect_fault("a: prescan x --map {}/m\n\nb prescan y --map {}/m",
               "/jobs.txt, line 3: must begin with a name");
  expect_fault("../a: prescan x --map {}/m", "must begin with a name");
  expect_fault(".a: prescan x --map {}/m", "must begin with a name");
  expect_fault(std::string(101, 'a') + ": prescan x --map {}/m", "must begin with a name");
  expect_fault("a (cost -1): prescan x --map {}/m", "(cost NUMBER)");
  expect_fault("a (cost nan): prescan x --map {}/m", "(cost NUMBER)");
  expect_fault("a (soon): prescan x --map {}/m", "(cost NUMBER)");
  expect_fault("a: prescan 'x --map {}/m", "quotation mark");
  expect_fault("a: rm -rf {}", "'rm' is not a command");
  expect_fault("a: farm b --out {}", "'farm' is not a command");
  expect_fault("a:", "'' is not a command");
  expect_fault("a: prescan x --map m", "no word has {}");
  expect_fault("a: prescan x --map {}/m\na: prescan y --map {}/m",
               "line 2: the name 'a' is that of an earlier job");
  expect_fault("a: run x --map {b}/m --video {}/v.mp4", "{b} is not the name of a job");
  expect_fault("a: run x --map {a}/m --video {}/v.mp4", "own folder is {}");
}

TEST(Manifest, RefusesCircles) {
  const std::string circle =
      "free: prescan x --map {}/m\n"
      "a: run x --map {c}/m --video {}/v\nb: run x --map {a}/m --video {}/v\nc: run x --map {b}/m --video "
      "{}/v\n";
  expect_fault(circle, "wait for each other");
  EXPECT_NO_THROW((void)parsed("a: run x --map {b}/m --video {}/v\nb: prescan x --map {}/m"));
}

TEST(Manifest, DoubledBracesAreText) {
  const std::vector<WordPart> parts = parts_of("{{a}}{}b{c}}}d{e");
  ASSERT_EQ(parts.size(), 5U);
  EXPECT_EQ(parts[0].text, "{a}");
  EXPECT_TRUE(parts[1].is_folder && parts[1].text.empty());
  EXPECT_EQ(parts[2].text, "b");
  EXPECT_TRUE(parts[3].is_folder && parts[3].text == "c");
  EXPECT_EQ(parts[4].text, "}d{e");
}

}  // namespace
}  // namespace roomradar::manifest_test
