#include "page/page_text.h"

#include <ostream>
#include <set>
#include <stdexcept>

namespace percale::scenes {

std::string json_for_script(std::string json) {
    // In JSON a < occurs in strings only.
    std::string safe;
    safe.reserve(json.size());
    for (const char letter : json) {
        if (letter == '<')
            safe += "\\u003c";
        else
            safe += letter;
    }
    return safe;
}

void write_filled(std::ostream& out, std::string_view text, const PageParts& parts) {
    std::set<std::string> filled;
    for (std::size_t open = text.find("{{"); open != std::string_view::npos; open = text.find("{{")) {
        const std::size_t close = text.find("}}", open);
        const std::string name(text.substr(open + 2, close == std::string_view::npos ? close : close - open - 2));
        const auto part = parts.find(name);
        if (close == std::string_view::npos || part == parts.end()) throw std::logic_error("a page has no part '" + name + "'");
        out << text.substr(0, open);
        part->second(out);
        filled.insert(name);
        text.remove_prefix(close + 2);
    }
    out << text;
    for (const auto& [name, write] : parts)
        if (!filled.contains(name)) throw std::logic_error("a page has no place for its part '" + name + "'");
}

}  // namespace percale::scenes
