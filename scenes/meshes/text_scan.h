#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "common/scene_file_error.h"

// The pieces that the readers of text mesh files share.
namespace percale::scenes {

/// A line of a text file, for messages.
struct TextPlace {
    const std::string& name;
    std::size_t line = 0;
};

[[noreturn]] inline void fail_at_line(const TextPlace& place, const std::string& message) {
    throw SceneFileError({.file = place.name, .line = static_cast<int>(place.line)}, message);
}

/// A word as it may stand in a message: cut to 40 characters, unprintable ones replaced.
inline std::string shown(std::string_view word) {
    std::string text(word.substr(0, 40));
    for (char& letter : text) letter = letter < ' ' || letter > '~' ? '?' : letter;
    return "\"" + text + (word.size() > 40 ? "...\"" : "\"");
}

/// Takes the next line off the front of a text, without its line end.
inline std::string_view take_line(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return line;
}

/// What a comment of an OBJ file begins with that ObjLayout writes and read_obj reads.
inline constexpr std::string_view obj_note = "#percale";

/// Takes the next line of an OBJ file off the text: a backslash before the line end joins lines, and comments end it.
inline std::string take_obj_line(std::string_view& text, std::size_t& line_number) {
    std::string joined;
    bool goes_on = true;
    while (goes_on && !text.empty()) {
        std::string_view line = take_line(text);
        ++line_number;
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        goes_on = !line.empty() && line.back() == '\\';
        if (goes_on) line.remove_suffix(1);
        joined.append(line).append(goes_on ? " " : "");
    }
    return joined.starts_with(obj_note) ? joined : joined.substr(0, joined.find('#'));
}

/// The shortest text that reads back as the same number.
template <typename Number>
void append_number(std::string& text, Number number) {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

/// Takes the next word off the front of a line; empty at its end.
inline std::string_view next_word(std::string_view& line) {
    constexpr std::string_view blank = " \t\r\f\v";
    const std::size_t start = line.find_first_not_of(blank);
    if (start == std::string_view::npos) return line = {};
    const std::size_t end = std::min(line.find_first_of(blank, start), line.size());
    const std::string_view word = line.substr(start, end - start);
    line.remove_prefix(end);
    return word;
}

/// A finite double; anything else throws with `what` naming the number.
inline double to_double(std::string_view word, const TextPlace& place, const char* what) {
    const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
    const char* end = word.data() + word.size();
    double value = 0.0;
    const auto [stop, status] = std::from_chars(word.data() + (plus ? 1 : 0), end, value);
    if (word.empty()) fail_at_line(place, std::string(what) + " is missing");
    if (status == std::errc::result_out_of_range) fail_at_line(place, std::string(what) + " is beyond a double: " + shown(word));
    if (status != std::errc() || stop != end) fail_at_line(place, std::string(what) + " is not a number: " + shown(word));
    if (!std::isfinite(value)) fail_at_line(place, std::string(what) + " is not finite: " + shown(word));
    return value;
}

/// A whole number; anything else throws with `what` naming the number.
inline long long to_integer(std::string_view word, const TextPlace& place, const char* what) {
    const char* end = word.data() + word.size();
    long long value = 0;
    const auto [stop, status] = std::from_chars(word.data(), end, value);
    if (word.empty()) fail_at_line(place, std::string(what) + " is missing");
    if (status != std::errc() || stop != end) fail_at_line(place, std::string(what) + " is not a whole number: " + shown(word));
    return value;
}

}  // namespace percale::scenes
