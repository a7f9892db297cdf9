// serve_command.hpp: options and execution of `roomradar serve`.
#pragma once
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace roomradar {

struct ServeOptions {
  std::vector<std::string> maps;  ///< folders of maps
  std::string listen = "127.0.0.1:8080";
  bool allow_remote = false;
  std::string token_file;
  std::string anchor;  ///< see parse_geo_anchor(); empty: none
  bool verbose = false;
};
/// Adds the options with their help texts and checks.
void add_options(CLI::App& command, ServeOptions& options);
/// Serves until Ctrl-C. Returns the exit status. Throws Error if a map cannot be read, or the address cannot
/// be used or is not allowed.
int run(const ServeOptions& options);

}  // namespace roomradar
