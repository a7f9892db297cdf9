// manual_page.hpp: generates the manual page from the commands' own help.
#pragma once
#include <string>

namespace CLI {
class App;
}

namespace roomradar {

/// Returns the manual page roomradar(1) in man(7) macros. It has every command of `app` with its arguments
/// and options as in --help, and sections on sources, files, environment and examples. Options without a
/// group are omitted.
std::string manual_page(const CLI::App& app);

}  // namespace roomradar
