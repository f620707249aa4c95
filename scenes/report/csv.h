#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

// Fields of a CSV file (RFC 4180).
namespace percale::scenes {

/// Nine digits; empty where the number is not finite.
std::string csv_number(double value);

/// The text, in quotes where it needs them.
std::string csv_text(const std::string& text);

/// The cells of a line in which nothing is in quotes.
std::vector<std::string> csv_cells(const std::string& line);

/// Where a column stands in a header; nothing where it has none of that name.
std::optional<std::size_t> csv_column(const std::vector<std::string>& header, const std::string& name);

}  // namespace percale::scenes
