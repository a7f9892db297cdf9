// shell_line_test.cpp: words that a shell reads back.
#include "app/cli/shell_line.hpp"

#include <gtest/gtest.h>

namespace roomradar::shell_line_test {
namespace {

using Words = std::vector<std::string>;

TEST(ShellLine, QuotesWhatAShellWouldSplitOrExpand) {
  EXPECT_EQ(shell_line({"roomradar", "prescan", "kinect:0", "--map=maps/a-b_c.d", "0,-1,0"}),
            "roomradar prescan kinect:0 --map=maps/a-b_c.d 0,-1,0");
  EXPECT_EQ(shell_line({"a b", "it's", "", "$x", "sim:table?frames=3", "~", "küche"}),
            R"('a b' 'it'\''s' '' '$x' 'sim:table?frames=3' '~' 'küche')");
}

TEST(ShellLine, LeavesAnOptionOut) {
  EXPECT_EQ(without_option({"a", "--m", "1", "--n", "2", "--m=3", "--mm", "4", "--m"}, "--m"),
            (Words{"a", "--n", "2", "--mm", "4"}));
}

}  // namespace
}  // namespace roomradar::shell_line_test
