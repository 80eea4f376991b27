// The viewer's page as it was when this program was built.
#pragma once

#include <string_view>

namespace patchlight {

// The bytes of tools/page/page.html; CMake makes the source that holds them.
std::string_view page_html();

}  // namespace patchlight
