#pragma once

#include <bit>
#include <cstdint>

namespace percale {

/// Order-dependent 64-bit hash over words (FNV-1a on whole words, with a final mix), for comparing runs bit by bit.
class Hash {
public:
    void add(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001b3ULL ^ (value_ >> 29); }
    void add(int number) { add(static_cast<std::uint64_t>(static_cast<std::int64_t>(number))); }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    std::uint64_t value() const {
        std::uint64_t x = value_;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
        return x ^ (x >> 31);
    }

private:
    std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace percale
