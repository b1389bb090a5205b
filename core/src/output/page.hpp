// The frame of every HTML page: self-contained, light or dark by the reader's preference.
#pragma once

#include <string>
#include <string_view>

namespace grit {

/// From the doctype to the start of the body, with page.css followed by `style`. `head`: HTML before the styles.
std::string page_begin(std::string_view title, std::string_view style, std::string_view head = {});

/// Closes what page_begin() opened.
inline constexpr std::string_view page_end = "</body></html>\n";

}  // namespace grit
