#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "kernels/compute.h"
#include "percale/mesh.h"
#include "support/aligned.h"

namespace percale {

/// One 3-vector a vertex as three arrays (structure of arrays), padded with zeros to whole slices.
struct Vec3Arrays {
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

/// to(i) = value(a_i, b_i) for each number of the three axes, on all threads; `to` may be a or b.
template <class Value>
void set_each(const Compute& compute, const Vec3Arrays& a, const Vec3Arrays& b, Vec3Arrays& to, Value value) {
    if (to.padded_size() != a.padded_size()) to.resize(static_cast<int>(a.padded_size()));
    for_chunks(compute, a.slices(), [&](Slices range) {
        const std::size_t first = static_cast<std::size_t>(range.first) * slice_lanes;
        const std::size_t last = static_cast<std::size_t>(range.last) * slice_lanes;
        for (auto axis : {&Vec3Arrays::x, &Vec3Arrays::y, &Vec3Arrays::z}) {
            const double *p = (a.*axis).data(), *q = (b.*axis).data();
            double* r = (to.*axis).data();
            for (std::size_t i = first; i < last; ++i) r[i] = value(p[i], q[i]);
        }
    });
}

inline void set_zero(const Compute& compute, Vec3Arrays& to, int count) {
    const std::size_t padded = static_cast<std::size_t>((count + slice_lanes - 1) / slice_lanes) * slice_lanes;
    if (to.padded_size() != padded) return to.resize(count);
    for_chunks(compute, to.slices(), [&](Slices range) {
        const std::size_t first = static_cast<std::size_t>(range.first) * slice_lanes;
        const std::size_t last = static_cast<std::size_t>(range.last) * slice_lanes;
        for (auto* axis : {&to.x, &to.y, &to.z}) std::fill(axis->begin() + first, axis->begin() + last, 0.0);
    });
}

inline void copy(const Compute& compute, const Vec3Arrays& from, Vec3Arrays& to) {
    set_each(compute, from, from, to, [](double value, double) { return value; });
}

/// y += factor x
inline void add_scaled(Vec3Arrays& y, double factor, const Vec3Arrays& x) {
    const auto add = [factor](AlignedVector<double>& to, const AlignedVector<double>& from) {
        for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
    };
    add(y.x, x.x);
    add(y.y, x.y);
    add(y.z, x.z);
}

inline double dot(const Compute& compute, const Vec3Arrays& a, const Vec3Arrays& b) {
    return sum_chunks(compute, a.slices(), [&](Slices range) { return compute.kernels->dot(a.axes(), b.axes(), range); });
}

/// Sum of term(i) for i = first ... first + count - 1: eight sums side by side, so that no addition waits for the previous one;
/// their order depends on count alone.
template <class Term>
double sum_terms(int first, int count, Term term) {
    double sums[8] = {};
    const int last = first + count;
    int i = first;
    for (; i + 8 <= last; i += 8) {
        for (int k = 0; k < 8; ++k) sums[k] += term(i + k);
    }
    for (int k = 0; i < last; ++i, ++k) sums[k] += term(i);
    return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
}

/// Largest of term(i) >= 0 for i = first ... first + count - 1; 0 if there is none.
template <class Term>
double largest_term(int first, int count, Term term) {
    double largest[4] = {};
    const int last = first + count;
    int i = first;
    for (; i + 4 <= last; i += 4) {
        for (int k = 0; k < 4; ++k) {
            const double value = term(i + k);
            largest[k] = value > largest[k] ? value : largest[k];
        }
    }
    for (; i < last; ++i) largest[0] = std::max(largest[0], term(i));
    return std::max(std::max(largest[0], largest[1]), std::max(largest[2], largest[3]));
}

/// The same on all threads. Beyond a chunk the sum is that of the chunks' sums.
template <class Term>
double sum_terms(const Compute& compute, int first, int count, Term term) {
    constexpr int vertices = chunk_slices * slice_lanes;
    return sum_chunks(compute, (count + slice_lanes - 1) / slice_lanes, [&](Slices range) {
        const int from = range.first * slice_lanes;
        return sum_terms(first + from, std::min(count - from, vertices), term);
    });
}

template <class Term>
double largest_term(const Compute& compute, int first, int count, Term term) {
    constexpr int vertices = chunk_slices * slice_lanes;
    const int slices = (count + slice_lanes - 1) / slice_lanes;
    if (!compute.workers || slices < min_shared_slices) return largest_term(first, count, term);
    auto& parts = compute.sums;
    parts.resize((count + vertices - 1) / vertices);
    parallel_for_chunks(compute, slices, chunk_slices, true, [&](int begin, int, int) {
        const int from = begin * slice_lanes;
        parts[begin / chunk_slices][0] = largest_term(first + from, std::min(count - from, vertices), term);
    });
    double largest = 0.0;
    for (const auto& part : parts) largest = std::max(largest, part[0]);
    return largest;
}

/// |a_i - b_i|^2
inline double square_between(const Vec3Arrays& a, const Vec3Arrays& b, int i) {
    const double x = a.x[i] - b.x[i], y = a.y[i] - b.y[i], z = a.z[i] - b.z[i];
    return x * x + y * y + z * z;
}
inline double square_at(const Vec3Arrays& a, int i) { return a.x[i] * a.x[i] + a.y[i] * a.y[i] + a.z[i] * a.z[i]; }

inline void copy_out(const Vec3Arrays& from, std::span<Vec3> to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = {from.x[i], from.y[i], from.z[i]};
}

inline void copy_out(const Compute& compute, const Vec3Arrays& from, std::span<Vec3> to) {
    for_chunks(compute, from.slices(), [&](Slices range) {
        const std::size_t last = std::min(static_cast<std::size_t>(range.last) * slice_lanes, to.size());
        for (std::size_t i = static_cast<std::size_t>(range.first) * slice_lanes; i < last; ++i) {
            to[i] = {from.x[i], from.y[i], from.z[i]};
        }
    });
}

inline void copy_in(std::span<const Vec3> from, Vec3Arrays& to) {
    for (std::size_t i = 0; i < from.size(); ++i) to.set(static_cast<int>(i), from[i]);
}

}  // namespace percale
