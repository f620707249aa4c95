#include "report/csv.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace percale::scenes {

std::string csv_number(double value) {
    char text[48];
    std::snprintf(text, sizeof text, "%.9g", value);
    return std::isfinite(value) ? text : "";
}

std::string csv_text(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
    return quoted + "\"";
}

std::vector<std::string> csv_cells(const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char letter : line) {
        if (letter == ',')
            cells.emplace_back();
        else
            cells.back() += letter;
    }
    return cells;
}

std::optional<std::size_t> csv_column(const std::vector<std::string>& header, const std::string& name) {
    const auto found = std::ranges::find(header, name);
    return found != header.end() ? std::optional(static_cast<std::size_t>(found - header.begin())) : std::nullopt;
}

}  // namespace percale::scenes
