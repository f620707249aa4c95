#include "common/text.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <regex>

namespace percale::scenes {

std::string number_text(double value) {
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    std::string text(digits, end);
    const std::size_t exponent = text.find('e');
    if (exponent == std::string::npos || !std::isfinite(value)) return text;
    // 1e+06 and 1e-06 read better as 1e6 and 1e-6
    const std::size_t first = text.find_first_not_of("+-0", exponent + 1);
    const std::string sign = text[exponent + 1] == '-' ? "-" : "";
    return text.substr(0, exponent + 1) + sign + text.substr(first);
}

std::string short_number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

std::string percent_text(double share) {
    const double percent = 100.0 * share, size = std::abs(percent);
    if (!(size < 1e9)) return short_number(percent) + " %";
    return (size < 10.0 ? short_number(std::round(10.0 * percent) / 10.0) : std::to_string(std::lround(percent))) + " %";
}

std::string number_advice(const std::string& text) {
    static const std::regex comma(R"(\s*([+-]?\d+),(\d+)\s*)"),
        with_unit(R"(\s*([+-]?\d*\.?\d+(?:[eE][+-]?\d+)?)\s*([A-Za-z%].*))");
    static const std::map<std::string, std::pair<double, const char*>> factors = {
        {"mm", {1e-3, "m"}}, {"cm", {1e-2, "m"}}, {"g", {1e-3, "kg"}}, {"ms", {1e-3, "s"}}};
    // A regex takes a call for each letter: long texts, which are no numbers either, would exhaust the stack.
    constexpr std::size_t longest_number = 40;
    if (text.size() > longest_number) return "";
    std::smatch part;
    if (std::regex_match(text, part, comma)) return "; decimals take a point: " + part.str(1) + "." + part.str(2);
    if (!std::regex_match(text, part, with_unit)) return "";
    const auto factor = factors.find(part.str(2));
    if (factor == factors.end()) return "; a number is written without its unit: " + part.str(1);
    const auto& [scale, unit] = factor->second;
    return std::string("; a number is written without its unit, in ") + unit + ": " +
           short_number(scale * std::strtod(part.str(1).c_str(), nullptr));
}

std::string counted(long count, const std::string& what) { return std::to_string(count) + " " + what + (count == 1 ? "" : "s"); }

std::string nearness_text(double smallest_distance) {
    if (std::isinf(smallest_distance)) return "never near";
    char text[64];
    std::snprintf(text, sizeof text, "smallest distance %.3g m", smallest_distance);
    return text;
}

std::string hexadecimal(std::uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

std::string joined(std::span<const std::string> words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

}  // namespace percale::scenes
