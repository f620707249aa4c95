#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "hash.h"

namespace percale {

/// Hashes lists of numbers and of arrays of them, without a copy.
class ListHash {
public:
    void add(int number) { hash_.add(number); }
    void add(double number) { hash_.add(number); }
    void add(const Eigen::Vector3d& x) { add_all(std::span<const double>(x.data(), 3)); }
    template <class Value, std::size_t count>
    void add(const std::array<Value, count>& values) {
        add_all(std::span<const Value>(values));
    }
    template <class Values>
    void add_all(const Values& values) {
        add(static_cast<int>(values.size()));
        for (const auto& value : values) add(value);
    }
    std::uint64_t value() const { return hash_.value(); }

private:
    Hash hash_;
};

}  // namespace percale
