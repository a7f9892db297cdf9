// manual_page.hpp: generates the manual page from the commands' help.
#pragma once
#include <string>

namespace CLI {
class App;
}

namespace roomradar {

/// Returns the manual page roomradar(1) in man(7) macros. The page lists all commands of `app` with arguments
/// and options as in --help, and has sections on sources, files, environment and examples. Options without a
/// group are omitted.
std::string manual_page(const CLI::App& app);

}  // namespace roomradar
