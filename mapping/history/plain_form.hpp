// plain_form.hpp: files as bytes in which a local change stays local.
#pragma once
#include <string>
#include <string_view>

namespace roomradar {

/// Returns the file's bytes in a form in which a change of one place of the room changes few bytes: zstd
/// frames are unpacked, and the vertex indices of a binary PLY file are differences. from_plain_form()
/// restores the file bit by bit; a part for which it would not stays as it is.
std::string plain_form(std::string_view file);

/// Returns the file. Throws Error beginning with `where` if `plain` is damaged.
std::string from_plain_form(std::string_view plain, std::string_view where);

}  // namespace roomradar
