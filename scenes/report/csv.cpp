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

std::string csv_table(const TableCells& cells) {
    std::string text;
    for (const std::vector<std::string>& row : cells)
        for (std::size_t k = 0; k < row.size(); ++k) text += csv_text(row[k]) + (k + 1 < row.size() ? "," : "\n");
    return text;
}

std::string aligned_table(const TableCells& cells, std::size_t left, bool texts_last) {
    std::vector<std::size_t> widths(cells.front().size(), 0);
    for (const std::vector<std::string>& row : cells)
        for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
    std::string text;
    for (const std::vector<std::string>& row : cells) {
        for (std::size_t k = 0; k < row.size(); ++k) {
            const bool last = k + 1 == row.size();
            const std::string fill(last && texts_last ? 0 : widths[k] - row[k].size(), ' ');
            text += (k < left ? row[k] + fill : fill + row[k]) + (last ? "\n" : "  ");
        }
    }
    return text;
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
