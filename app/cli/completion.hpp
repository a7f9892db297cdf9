// completion.hpp: completion scripts for bash and zsh, generated from the definition of the command line.
#pragma once
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace roomradar {

/// Returns the completion script for `bash` or `zsh`. The script completes commands, subcommands, options,
/// enumerated option values and help topics. Everywhere else, the script completes file names. Throws
/// CLI::ValidationError for another shell.
std::string completion_script(const CLI::App& app, std::string_view shell);

}  // namespace roomradar
