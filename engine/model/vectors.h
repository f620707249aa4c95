#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kernels/compute.h"
#include "percale/mesh.h"
#include "support/aligned.h"

namespace percale {

/// One 3-vector a vertex as three arrays (structure of arrays), padded with zeros to whole slices.
struct Vectors {
    static constexpr int lanes = slice_lanes;
    AlignedVector<double> x, y, z;

    void resize(int count) {
        const std::size_t padded = static_cast<std::size_t>((count + lanes - 1) / lanes) * lanes;
        for (auto* axis : {&x, &y, &z}) axis->assign(padded, 0.0);
    }
    std::size_t padded_size() const { return x.size(); }
    int slices() const { return static_cast<int>(x.size() / lanes); }
    Axes axes() { return {x.data(), y.data(), z.data()}; }
    ConstAxes axes() const { return {x.data(), y.data(), z.data()}; }
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

/// y += factor x
inline void add_scaled(Vectors& y, double factor, const Vectors& x) {
    const auto add = [factor](AlignedVector<double>& to, const AlignedVector<double>& from) {
        for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
    };
    add(y.x, x.x);
    add(y.y, x.y);
    add(y.z, x.z);
}

inline double dot(const Compute& compute, const Vectors& a, const Vectors& b) {
    return sum_chunks(compute, a.slices(), [&](Slices range) { return compute.kernels->dot(a.axes(), b.axes(), range); });
}

inline void copy_out(const Vectors& from, std::span<Vec3> to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = {from.x[i], from.y[i], from.z[i]};
}

inline void copy_in(std::span<const Vec3> from, Vectors& to) {
    for (std::size_t i = 0; i < from.size(); ++i) to.set(static_cast<int>(i), from[i]);
}

}  // namespace percale
