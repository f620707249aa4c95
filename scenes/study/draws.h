#pragma once

#include <cstdint>
#include <random>

namespace percale::scenes {

/// Random numbers that are the same with every standard library: its engines are laid down, its distributions are not.
class Draws {
public:
    explicit Draws(std::uint64_t seed) : engine_(seed) {}

    /// A uniform number in [0, 1) of 53 bits.
    double share();
    double uniform(double lowest, double highest) { return lowest + share() * (highest - lowest); }
    /// A number with a uniform logarithm; both > 0.
    double log_uniform(double lowest, double highest);
    /// A number of the normal distribution (Box and Muller 1958).
    double normal(double mean, double deviation);

private:
    std::mt19937_64 engine_;
};

}  // namespace percale::scenes
