// svg_plot_test.cpp: numbers and texts in pages.
#include "app/media/svg_plot.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace roomradar::svg_plot_test {
namespace {

TEST(ReadableNumber, IsWrittenAsPeopleWriteIt) {
  EXPECT_EQ(readable_number(2250.0), "2,250");
  EXPECT_EQ(readable_number(-0.0), "0");
  EXPECT_EQ(readable_number(2260.0, 2), "2,300");
  EXPECT_EQ(readable_number(1234567.0), "1,230,000");
  EXPECT_EQ(readable_number(-987654.0), "-988,000");
  EXPECT_EQ(readable_number(999.0), "999");
  EXPECT_EQ(readable_number(0.00012345), "0.000123");
  EXPECT_EQ(readable_number(1234.5, 6), "1,234.5");
  EXPECT_EQ(readable_number(12.5), "12.5");
  EXPECT_EQ(readable_number(100.0), "100");
  EXPECT_EQ(readable_number(0.0), "0");
  EXPECT_EQ(readable_number(1e-9), "0.000000001");
  EXPECT_EQ(readable_number(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(readable_number(std::numeric_limits<double>::infinity()), "inf");
}

TEST(NamedCells, EachCellHasTheHeadingOfItsColumn) {
  EXPECT_EQ(
      named_cells("<table><tr><th>a</th><th>b</th></tr>\n<tr><td>1</td><td class=\"x\">2</td></tr>\n"
                  "<tr><td>3</td><td>4</td><td>5</td></tr>"),
      "<table><tr><th>a</th><th>b</th></tr>\n<tr><td data-name=\"a\">1</td><td data-name=\"b\" "
      "class=\"x\">2</td></tr>\n<tr><td data-name=\"a\">3</td><td data-name=\"b\">4</td><td>5</td></tr>");
}

TEST(PercentPlot, IsNoWiderThanAPhoneSoThatItsTextCanBeRead) {
  const std::string svg = percent_plot("a long title", "mm", 0.1, 1000.0, {{"x", "red", {{1.0, 50.0}}}});
  EXPECT_NE(svg.find("viewBox=\"0 0 400 "), std::string::npos);
  EXPECT_EQ(svg.rfind("<p class=\"t\">a long title</p>", 0), 0U) << "text that the page wraps";
}

}  // namespace
}  // namespace roomradar::svg_plot_test
