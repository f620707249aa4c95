#pragma once

#include <cstdint>
#include <span>
#include <string>

// How numbers and words are written in messages and tables.
namespace percale::scenes {

/// The shortest text that reads back as the same number: 0.3, 1e-6, inf.
std::string number_text(double value);

/// Three digits, or so many: 0.0167, 1.2e+07.
std::string short_number(double value, int digits = 3);

/// A fraction as a percentage: "12 %", "0.4 %".
std::string percent_text(double share);

/// Advice on a text that should be a number: "; decimals take a point: 0.005" for "0,005", "; a number is written without its
/// unit: 5" for "5 N", with mm, cm, g and ms converted to m, kg and s. "" where the text is no such number.
std::string number_advice(const std::string& text);

/// "1 step", "12 steps".
std::string counted(long count, const std::string& what);

/// "smallest distance 0.0032 m", or "never near" where it is infinite.
std::string nearness_text(double smallest_distance);

/// A hash or checksum as 16 digits, "00000000075bcd15".
std::string hexadecimal(std::uint64_t value);

/// "a, b, c".
std::string joined(std::span<const std::string> words);

/// 1, 2 or 5 times a power of ten, not below `min`: a step between the numbers of a scale.
double round_step(double min);
/// A multiple of such a step without the rounding of the product: 0.3, not 0.30000000000000004.
std::string multiple_text(double value, double step);

}  // namespace percale::scenes
