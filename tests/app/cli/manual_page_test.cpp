// manual_page_test.cpp: the parser accepts the script syntax that the manual page documents.
#include "app/cli/manual_page.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "app/session/script/script.hpp"

namespace roomradar::manual_page_test {
namespace {

TEST(ManualPage, ItsScriptIsOne) {
  std::istringstream page(std::regex_replace(manual_page(CLI::App()), std::regex(R"(\\-)"), "-"));
  std::string text;
  for (std::string line; std::getline(page, line);)
    if (std::regex_search(line, std::regex("^ *(frame|time) +[0-9]"))) text += line + "\n";
  std::set<std::size_t> actions;
  for (const ScriptEvent& event : parse_script(text, "roomradar.1").events)
    actions.insert(event.action.index());
  EXPECT_EQ(actions.size(), std::variant_size_v<Action>) << "an action is left out";
}

}  // namespace
}  // namespace roomradar::manual_page_test
