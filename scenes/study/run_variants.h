#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>

// The runner of all studies: variants of one thing, several at a time, each with its result at its place.
namespace percale::scenes {

/// A stop was asked for, and not all variants were run.
class StudyStopped : public std::runtime_error {
public:
    StudyStopped() : std::runtime_error("stopped") {}
};

/// How variants are run; each function may be empty.
struct VariantWork {
    int jobs = 1;                                 // variants at a time, each in a thread; 1: in the thread that calls
    std::function<bool()> stop_asked = {};        // asked by any of the threads before a variant; then no other is begun
    std::function<void(std::size_t)> ended = {};  // after each variant, for one at a time
};

/// Calls run(0) ... run(count - 1), begun in this order. What the first of them throws is thrown again after those that run have
/// ended, and no other is begun. False where a stop was asked for before the last was begun.
bool run_variants(std::size_t count, const VariantWork& work, const std::function<void(std::size_t)>& run);

}  // namespace percale::scenes
