#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "percale/mesh.h"

namespace percale {

/// One 3-vector a vertex as three arrays (structure of arrays), padded with zeros to whole lanes.
struct Vectors {
    static constexpr int lanes = 8;
    std::vector<double> x, y, z;

    void resize(int count) {
        const std::size_t padded = static_cast<std::size_t>((count + lanes - 1) / lanes) * lanes;
        for (auto* axis : {&x, &y, &z}) axis->assign(padded, 0.0);
    }
    std::size_t padded_size() const { return x.size(); }
    Vec3 at(int i) const { return {x[i], y[i], z[i]}; }
    void set(int i, const Vec3& value) {
        x[i] = value.x();
        y[i] = value.y();
        z[i] = value.z();
    }
    void add(int i, const Vec3& value) {
        x[i] += value.x();
        y[i] += value.y();
        z[i] += value.z();
    }
};

inline double dot(const Vectors& a, const Vectors& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.padded_size(); ++i) sum += a.x[i] * b.x[i] + a.y[i] * b.y[i] + a.z[i] * b.z[i];
    return sum;
}

/// y += factor x
inline void add_scaled(Vectors& y, double factor, const Vectors& x) {
    for (std::size_t i = 0; i < y.padded_size(); ++i) {
        y.x[i] += factor * x.x[i];
        y.y[i] += factor * x.y[i];
        y.z[i] += factor * x.z[i];
    }
}

inline void copy_out(const Vectors& from, std::span<Vec3> to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = {from.x[i], from.y[i], from.z[i]};
}

inline void copy_in(std::span<const Vec3> from, Vectors& to) {
    for (std::size_t i = 0; i < from.size(); ++i) to.set(static_cast<int>(i), from[i]);
}

}  // namespace percale
