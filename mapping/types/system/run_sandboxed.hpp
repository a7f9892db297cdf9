// run_apart.hpp: other people's code, given files that cannot be trusted, in a process of its own.
#pragma once
#include <functional>
#include <string>

namespace roomradar {

/// What `work` returns, computed in a child of this process, so that it cannot harm this one: not by a crash,
/// nor by a loop without an end, nor by the memory that it takes. It sees this process's memory as it is now,
/// and changes nothing in it. What it throws as Error is thrown here.
/// @param complaint  what to say if the child does not come to its end: "a.obj: cannot be read; is it
/// damaged?"
/// @param most_s     processor time; in all it may take ten times as long
/// @param most_bytes of memory, beside what this process has
/// @throws Error with the complaint and, in brackets, what became of the child; or if it cannot be started
std::string run_apart(const std::function<std::string()>& work, const std::string& complaint, unsigned most_s,
                      std::size_t most_bytes);

}  // namespace roomradar
