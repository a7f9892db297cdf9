// run_sandboxed.hpp: runs third-party code on untrusted files in a separate process.
#pragma once
#include <functional>
#include <string>

namespace roomradar {

/// Runs `work` in a forked child process and returns its result. Crashes, endless loops and excessive memory
/// use of `work` do not affect this process. The child works on a copy of this process's memory, so its
/// changes to memory are lost. An Error that `work` throws is rethrown in this process.
/// @param complaint  start of the error message if the child does not finish, such as "a.obj: cannot be read;
///                   is it damaged?"
/// @param most_s     max processor time, s; the max elapsed time is ten times this
/// @param max_bytes  max memory of the child, in addition to this process's present memory
/// @throws Error with the complaint and, in brackets, the reason why the child ended. Also throws if the
///         child cannot be started
std::string run_sandboxed(const std::function<std::string()>& work, const std::string& complaint,
                          unsigned most_s, std::size_t max_bytes);

}  // namespace roomradar
