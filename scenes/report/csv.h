#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

// Tables, and the fields of a CSV file (RFC 4180).
namespace percale::scenes {

/// Nine digits; empty where the number is not finite.
std::string csv_number(double value);

/// The text, in quotes where it needs them.
std::string csv_text(const std::string& text);

/// A cell: numbers by csv_number or whole, yes or no, a text as it is.
inline std::string csv_cell(double value) { return csv_number(value); }
inline std::string csv_cell(int value) { return std::to_string(value); }
inline std::string csv_cell(long value) { return std::to_string(value); }
inline std::string csv_cell(bool value) { return value ? "yes" : "no"; }
inline std::string csv_cell(const char* text) { return text; }
inline std::string csv_cell(const std::string& text) { return text; }

/// Cells row by row, headings first.
using TableCells = std::vector<std::vector<std::string>>;

/// A line each row, its cells in quotes where they need them.
std::string csv_table(const TableCells& cells);

/// A line of these cells.
template <class... Values>
std::string csv_line(const Values&... values) {
    return csv_table({{csv_cell(values)...}});
}

/// A line each row, columns as wide as their widest cell. The first `left` of them begin at the left; others end at the right,
/// but for a last column of texts, which begins at the left and is not filled up.
std::string aligned_table(const TableCells& cells, std::size_t left, bool texts_last = false);

/// The cells of a line in which nothing is in quotes.
std::vector<std::string> csv_cells(const std::string& line);

/// Where a column stands in a header; nothing where it has none of that name.
std::optional<std::size_t> csv_column(const std::vector<std::string>& header, const std::string& name);

}  // namespace percale::scenes
