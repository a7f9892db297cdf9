// page_template.hpp: page.html as a string constant; CMake generates its source file.
#pragma once
#include <string_view>

namespace roomradar {

/// The page's HTML. kPageRoom marks the position of the room's data.
extern const std::string_view kPageTemplate;
inline constexpr std::string_view kPageRoom = "@ROOM@";

}  // namespace roomradar
