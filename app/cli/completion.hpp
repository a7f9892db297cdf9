// completion.hpp: completion of commands and options for bash and zsh, generated from the command line.
#pragma once
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace roomradar {

/// Returns the completion script for a shell, `bash` or `zsh`: commands, their parts, options, the words of
/// options with a choice, topics of help, files elsewhere. Throws CLI::ValidationError for another shell.
std::string completion_script(const CLI::App& app, std::string_view shell);

}  // namespace roomradar
