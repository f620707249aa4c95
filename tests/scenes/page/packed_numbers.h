#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

// What pages pack, unpacked the other way round: letter by letter, without the packer's code.
namespace percale::scenes::test {

inline std::string bytes_of_base64(const std::string& text) {
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0, held = 0;
    for (const char letter : text) {
        if (letter == '=') break;
        const std::size_t value = letters.find(letter);
        if (value == std::string::npos) throw std::runtime_error("no base64");
        bits = bits << 6 | static_cast<unsigned>(value);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes += static_cast<char>(bits >> held & 255u);
    }
    return bytes;
}

/// Whole numbers of so many bytes each, the lowest byte first.
inline std::vector<std::uint32_t> numbers_of_base64(const std::string& text, std::size_t size) {
    const std::string bytes = bytes_of_base64(text);
    std::vector<std::uint32_t> numbers(bytes.size() / size, 0u);
    for (std::size_t i = 0; i < numbers.size() * size; ++i)
        numbers[i / size] |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * (i % size));
    return numbers;
}

}  // namespace percale::scenes::test
