// manual_page.hpp: the manual page, made from the commands' own help, so that it cannot fall behind.
#pragma once
#include <string>

namespace CLI {
class App;
}

namespace roomradar {

/// roomradar(1) in man(7)'s macros: every command of `app` with its arguments and options as --help has them,
/// and what help does not say: sources, files, environment, examples. Options without a group are left out.
std::string manual_page(const CLI::App& app);

}  // namespace roomradar
