#include "common/text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string_view>

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

std::string short_number(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

std::string percent_text(double share) {
    const double percent = 100.0 * share, size = std::abs(percent);
    if (!(size < 1e9)) return short_number(percent) + " %";
    return (size < 10.0 ? short_number(std::round(10.0 * percent) / 10.0) : std::to_string(std::lround(percent))) + " %";
}

std::string number_advice(const std::string& text) {
    static const std::map<std::string_view, std::pair<double, const char*>> factors = {
        {"mm", {1e-3, "m"}}, {"cm", {1e-2, "m"}}, {"g", {1e-3, "kg"}}, {"ms", {1e-3, "s"}}};
    constexpr std::string_view blanks = " \t\n\r", digits = "0123456789";
    constexpr std::size_t longest_number = 40;
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string::npos || text.size() > longest_number) return "";
    const std::string_view trimmed = std::string_view(text).substr(first, text.find_last_not_of(blanks) + 1 - first);
    const std::string_view unsigned_part = trimmed.substr(trimmed.front() == '+' || trimmed.front() == '-');
    if (unsigned_part.find_first_of(digits) > unsigned_part.starts_with('.')) return "";
    double value = 0.0;
    const char* end = std::from_chars(unsigned_part.data(), unsigned_part.data() + unsigned_part.size(), value).ptr;
    const std::string number(trimmed.data(), end);
    const std::string_view rest(end, static_cast<std::size_t>(trimmed.data() + trimmed.size() - end));
    if (rest.starts_with(',') && rest.size() > 1 && rest.find_first_not_of(digits, 1) == rest.npos &&
        number.find_first_of(".eE") == number.npos)
        return "; decimals take a point: " + number + "." + std::string(rest.substr(1));
    const std::string_view unit = rest.substr(std::min(rest.find_first_not_of(blanks), rest.size()));
    if (unit.empty() || !(std::isalpha(static_cast<unsigned char>(unit.front())) || unit.front() == '%')) return "";
    const auto factor = factors.find(unit);
    if (factor == factors.end()) return "; a number is written without its unit: " + number;
    const auto& [scale, base] = factor->second;
    return std::string("; a number is written without its unit, in ") + base + ": " +
           short_number(scale * std::strtod(number.c_str(), nullptr));
}

std::string counted(long count, const std::string& what) { return std::to_string(count) + " " + what + (count == 1 ? "" : "s"); }

std::string nearness_text(double smallest_distance) {
    return std::isinf(smallest_distance) ? "never near" : "smallest distance " + short_number(smallest_distance) + " m";
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

double round_step(double min) {
    constexpr double rounding = 1e-9;  // what is a round step up to rounding is one
    const double power = std::pow(10.0, std::floor(std::log10(min)));
    for (const double digit : {1.0, 2.0, 5.0})
        if (digit * power >= min * (1.0 - rounding)) return digit * power;
    return 10.0 * power;
}

std::string multiple_text(double value, double step) {
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 12);
    char text[48];
    if (std::abs(value) >= 1e6 || step < 1e-6) return short_number(value);
    std::snprintf(text, sizeof text, "%.*f", digits, value == 0.0 ? 0.0 : value);
    return text;
}

}  // namespace percale::scenes
