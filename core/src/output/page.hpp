// The frame of every page: one file that opens from disk, light or dark as its reader likes.
#pragma once

#include <string>
#include <string_view>

namespace grit {

/// From the doctype into the body, with page.css and then `style`. `head` is HTML that goes before the styles.
std::string page_begin(std::string_view title, std::string_view style, std::string_view head = {});

/// Closes what page_begin() opened.
inline constexpr std::string_view page_end = "</body></html>\n";

}  // namespace grit
