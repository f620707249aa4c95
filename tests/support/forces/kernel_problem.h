#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "engine/kernels/kernels.h"
#include "engine/model/vec3_arrays.h"
#include "engine/support/aligned.h"
#include "tests/support/random.h"

namespace percale::test {

/// Random arguments for every kernel that works on slices. Entries are random vertices, padding, or vertices at the same place.
struct KernelProblem {
    int slices;
    std::size_t padded;
    std::vector<int> start = {0};
    AlignedVector<int> other;
    AlignedVector<double> stiffness, rest_length, damping;  // of entries
    AlignedVector<float> quads, sixes, weights;             // four, six and one number an entry
    Vec3Arrays x, v, y;
    AlignedVector<double> ground, free;
    AlignedVector<float> float_x, float_y, float_r, blocks;  // three, three, three and six arrays

    KernelProblem(unsigned seed, int slice_count)
        : slices(slice_count), padded(static_cast<std::size_t>(slice_count) * slice_lanes) {
        Random random(seed);
        for (int s = 0; s < slices; ++s) start.push_back(start.back() + slice_lanes * (s % 6));
        set_entries(random);
        set_vectors(random);
    }

    int vertex_of(int entry) const {
        const int slice = static_cast<int>(std::upper_bound(start.begin(), start.end(), entry) - start.begin()) - 1;
        return slice * slice_lanes + (entry - start[slice]) % slice_lanes;
    }
    EntryPattern pattern() const { return {start.data(), other.data()}; }
    SpringEntries springs() const { return {pattern(), stiffness.data(), rest_length.data(), damping.data()}; }
    Vec3 float_at(const AlignedVector<float>& from, int i) const { return {from[i], from[padded + i], from[2 * padded + i]}; }
    std::array<double, 4> quad(int entry) const {
        const float* value = &quads[4 * static_cast<std::size_t>(entry - entry % slice_lanes) + entry % slice_lanes];
        return {value[0], value[slice_lanes], value[2 * slice_lanes], value[3 * slice_lanes]};
    }
    Eigen::Matrix3d six(int entry) const {
        return symmetric(&sixes[6 * static_cast<std::size_t>(entry - entry % slice_lanes) + entry % slice_lanes], slice_lanes);
    }
    Eigen::Matrix3d block(int i) const { return symmetric(&blocks[i], padded); }

    static Eigen::Matrix3d symmetric(const float* m, std::size_t apart) {
        Eigen::Matrix3d result;
        result << m[0], m[apart], m[2 * apart], m[apart], m[3 * apart], m[4 * apart], m[2 * apart], m[4 * apart], m[5 * apart];
        return result;
    }

private:
    void set_entries(Random& random) {
        for (int e = 0; e < start.back(); ++e) {
            const bool padding = random.index(5) == 0;
            other.push_back(padding ? vertex_of(e) : random.index(static_cast<int>(padded)));
            stiffness.push_back(padding ? 0.0 : random.decades(10.0, 1e3));
            rest_length.push_back(padding ? 0.0 : random.number(0.1, 2.0));
            damping.push_back(padding ? 0.0 : random.number(0.0, 2.0));
            weights.push_back(padding ? 0.0f : static_cast<float>(random.number(0.0, 1.0)));
        }
        quads.resize(4 * other.size());
        for (float& value : quads) value = static_cast<float>(random.number(0.0, 1.0));
        sixes.resize(6 * other.size());
        for (std::size_t e = 0; e < other.size(); ++e)
            set_block(random, &sixes[6 * (e - e % slice_lanes) + e % slice_lanes], slice_lanes);
    }

    void set_vectors(Random& random) {
        for (auto* vectors : {&x, &v, &y}) {
            vectors->resize(static_cast<int>(padded));
            for (int i = 0; i < static_cast<int>(padded); ++i) vectors->set(i, random.point(1.0));
        }
        for (int e = 0; e < start.back(); e += 7) x.set(other[e], x.at(vertex_of(e)));
        for (std::size_t i = 0; i < padded; ++i) {
            ground.push_back(random.number(0.1, 1.0));
            free.push_back(random.index(4) == 0 ? 0.0 : 1.0);
        }
        for (auto* list : {&float_x, &float_y, &float_r}) {
            list->resize(3 * padded);
            for (float& value : *list) value = static_cast<float>(random.number(-1.0, 1.0));
        }
        blocks.resize(6 * padded);
        for (std::size_t i = 0; i < padded; ++i) set_block(random, &blocks[i], padded);
    }

    /// A symmetric positive definite block.
    static void set_block(Random& random, float* block, std::size_t apart) {
        const double size = random.number(0.2, 1.0);
        const Vec3 w = random.point(1.0);
        const std::array<double, 6> k = {size + w.x() * w.x(), w.x() * w.y(), w.x() * w.z(),
                                         size + w.y() * w.y(), w.y() * w.z(), size + w.z() * w.z()};
        for (std::size_t entry = 0; entry < 6; ++entry) block[entry * apart] = static_cast<float>(k[entry]);
    }
};

}  // namespace percale::test
