// page_template.hpp: page.html as text in the program; CMake makes the source from it.
#pragma once
#include <string_view>

namespace roomradar {

/// The page's HTML, with kPageRoom in place of the room's data.
extern const std::string_view kPageTemplate;
inline constexpr std::string_view kPageRoom = "@ROOM@";

}  // namespace roomradar
