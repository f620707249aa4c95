#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

// Numbers as binary files hold them, whatever the machine.
namespace percale::scenes {

/// The bytes of a whole number, the lowest first.
template <class Whole>
void append_little(std::string& bytes, Whole number) {
    static_assert(std::is_unsigned_v<Whole>);
    for (std::size_t k = 0; k < sizeof number; ++k) bytes += static_cast<char>(static_cast<std::uint8_t>(number >> (8 * k)));
}

/// The same, the highest byte first.
template <class Whole>
void append_big(std::string& bytes, Whole number) {
    static_assert(std::is_unsigned_v<Whole>);
    for (std::size_t k = sizeof number; k-- > 0;) bytes += static_cast<char>(static_cast<std::uint8_t>(number >> (8 * k)));
}

inline void append_float(std::string& bytes, double number) {
    append_little(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(number)));
}
inline void append_big_float(std::string& bytes, double number) {
    append_big(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(number)));
}
inline void append_double(std::string& bytes, double number) { append_little(bytes, std::bit_cast<std::uint64_t>(number)); }

/// A number that starts at `bytes`, the lowest first.
template <class Whole>
Whole little_at(const char* bytes) {
    Whole number = 0;
    for (std::size_t k = 0; k < sizeof number; ++k) number |= static_cast<Whole>(static_cast<std::uint8_t>(bytes[k])) << (8 * k);
    return number;
}
inline float float_at(const char* bytes) { return std::bit_cast<float>(little_at<std::uint32_t>(bytes)); }

}  // namespace percale::scenes
