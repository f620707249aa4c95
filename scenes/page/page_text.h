#pragma once

#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <string_view>

namespace percale::scenes {

/// JSON as it may stand in a <script> of a page: nothing in it ends or opens an element.
std::string json_for_script(std::string json);

/// What is written in place of each {{name}} of a template.
using PageParts = std::map<std::string, std::function<void(std::ostream&)>, std::less<>>;

/// Writes a template with its parts in their places. Throws std::logic_error for a place that no part has, and for a part
/// without a place.
void write_filled(std::ostream& out, std::string_view text, const PageParts& parts);

}  // namespace percale::scenes
