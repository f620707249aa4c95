#include "c/option_text.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

namespace percale::c_interface {
namespace {

/// Removes the number at the beginning of a text and returns it, in any locale.
double taken_number(std::string_view& text, std::string_view whole, std::string_view key) {
    double number = 0.0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (fault != std::errc() || !std::isfinite(number)) {
        throw SceneError(std::string(key), "\"" + std::string(whole) + "\" is not a finite number that a double holds");
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

}  // namespace

double number_of(std::string_view text, std::string_view key) {
    std::string_view rest = text;
    const double number = taken_number(rest, text, key);
    if (!rest.empty()) throw SceneError(std::string(key), "\"" + std::string(text) + "\" is not one number");
    return number;
}

std::vector<double> numbers_of(std::string_view text, std::string_view key) {
    std::vector<double> numbers;
    for (std::string_view rest = text;;) {
        numbers.push_back(taken_number(rest, text, key));
        if (rest.empty()) return numbers;
        const std::size_t gap = std::min(rest.find_first_not_of(" ,"), rest.size());
        if (gap == 0) throw SceneError(std::string(key), "\"" + std::string(text) + "\" is not a list of numbers");
        rest.remove_prefix(gap);
    }
}

std::string exact_text(double number) {
    char text[32];  // a double takes at most 24
    const auto [end, fault] = std::to_chars(text, text + sizeof text, number);
    static_cast<void>(fault);
    return {text, end};
}

void check_in_range(std::string_view key, double value, double lowest, double highest) {
    if (std::isfinite(value) && value >= lowest && value <= highest) return;
    std::ostringstream text;
    text << exact_text(value) << " is outside the allowed range " << lowest << " ... " << highest;
    throw SceneError(std::string(key), text.str());
}

int whole_number(std::string_view key, double value) {
    if (std::abs(value) <= 1e9 && std::trunc(value) == value) return static_cast<int>(value);
    throw SceneError(std::string(key), exact_text(value) + " is not a whole number of at most 1e9");
}

int word_index(std::string_view key, std::string_view word, std::span<const std::string_view> words) {
    std::string all;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == word) return static_cast<int>(i);
        all += (i == 0 ? "" : ", ") + std::string(words[i]);
    }
    throw SceneError(std::string(key), "\"" + std::string(word) + "\" is none of " + all);
}

}  // namespace percale::c_interface
