#pragma once

#include <array>
#include <span>
#include <vector>

#include "model/vec3_arrays.h"
#include "percale/mesh.h"

namespace percale {

/// A symmetric 3x3 matrix: xx xy xz yy yz zz.
using SymmetricBlock = std::array<double, 6>;

/// n.K n
inline double quadratic_form(const SymmetricBlock& k, const Vec3& n) {
    return n.x() * (k[0] * n.x() + 2.0 * k[1] * n.y() + 2.0 * k[2] * n.z()) + n.y() * (k[3] * n.y() + 2.0 * k[4] * n.z()) +
           k[5] * n.z() * n.z();
}

/// The product K u.
inline Vec3 block_times(const SymmetricBlock& k, const Vec3& u) {
    return {k[0] * u.x() + k[1] * u.y() + k[2] * u.z(), k[1] * u.x() + k[3] * u.y() + k[4] * u.z(),
            k[2] * u.x() + k[4] * u.y() + k[5] * u.z()};
}

/// K += factor n n^T
inline void add_normal_block(SymmetricBlock& k, double factor, const Vec3& n) {
    int entry = 0;
    for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) k[entry++] += factor * n[a] * n[b];
    }
}

/// K += factor (I - n n^T - t t^T), n a unit vector, t one at right angles to it or zero.
inline void add_tangent_block(SymmetricBlock& k, double factor, const Vec3& n, const Vec3& t) {
    int entry = 0;
    for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) k[entry++] += factor * ((a == b ? 1.0 : 0.0) - n[a] * n[b] - t[a] * t[b]);
    }
}

/// The part of v at right angles to the unit vector n.
inline Vec3 tangential(const Vec3& v, const Vec3& n) { return v - n * n.dot(v); }

/// The block diagonal of a step matrix: six arrays xx xy xz yy yz zz, kg.
struct DiagonalBlocks {
    AlignedVector<double> data;
    std::size_t padded = 0;

    void resize(std::size_t padded_size) {
        padded = padded_size;
        data.assign(6 * padded, 0.0);
    }
    const double* operator[](int entry) const { return data.data() + entry * padded; }
    SymmetricBlock block(int i) const {
        SymmetricBlock k;
        for (std::size_t entry = 0; entry < 6; ++entry) k[entry] = data[entry * padded + i];
        return k;
    }
};

/// A part of the step matrix that joins up to four vertices: w_k w_l K between vertices k and l, K symmetric, kg.
struct CoupledBlock {
    std::array<int, 4> vertex;  // -1 = unused
    std::array<double, 4> weight;
    SymmetricBlock k;
    int constraint = -1;  // contact constraint; -1: of a force, or friction of a vertex with all its constraints
};

/// The coupled blocks of forces and then those of contact, viewed as one list.
class CoupledBlocks {
public:
    CoupledBlocks() = default;
    CoupledBlocks(std::span<const CoupledBlock> of_forces, std::span<const CoupledBlock> of_contact)
        : of_forces_(of_forces), of_contact_(of_contact) {}

    std::size_t size() const { return of_forces_.size() + of_contact_.size(); }
    const CoupledBlock& operator[](std::size_t k) const {
        return k < of_forces_.size() ? of_forces_[k] : of_contact_[k - of_forces_.size()];
    }

private:
    std::span<const CoupledBlock> of_forces_, of_contact_;
};

/// Parts g g^T of the step matrix, kg: the vertices of each block, any number of them, and their parts of g. The energy
/// 1/2 k (V - V_0)^2 of one number V of the configuration, such as an area or a volume, has g = dt sqrt(k) dV/dx.
class OuterBlocks {
public:
    struct Block {
        std::span<const int> vertex;
        std::span<const Vec3> gradient;  // kg^1/2
    };
    struct NewBlock {
        std::span<int> vertex;
        std::span<Vec3> gradient;  // 0 at first
    };

    void clear() {
        end_.clear();
        vertex_.clear();
        gradient_.clear();
    }
    /// Appends a block of `count` vertices, which the caller sets, each of them once.
    NewBlock add(int count) {
        const std::size_t first = vertex_.size(), size = static_cast<std::size_t>(count);
        vertex_.resize(first + size);
        gradient_.resize(first + size, Vec3::Zero());
        end_.push_back(first + size);
        return {{&vertex_[first], size}, {&gradient_[first], size}};
    }
    int size() const { return static_cast<int>(end_.size()); }
    Block operator[](int number) const {
        const std::size_t first = number > 0 ? end_[number - 1] : 0, size = end_[number] - first;
        return {{&vertex_[first], size}, {&gradient_[first], size}};
    }

private:
    std::vector<std::size_t> end_;  // of each block, in the two lists
    std::vector<int> vertex_;
    std::vector<Vec3> gradient_;
};

/// g . x of a block
inline double dot(const OuterBlocks::Block& block, const Vec3Arrays& x) {
    double sum = 0.0;
    for (std::size_t k = 0; k < block.vertex.size(); ++k) sum += block.gradient[k].dot(x.at(block.vertex[k]));
    return sum;
}

/// The load stiffness of a triangle under pressure, which follows it: as its vertices a, b, c move by x, the force on each
/// changes by (x_b - x_a) x second + first x (x_c - x_a). With first, second = dt^2 p/6 times -(b - a), -(c - a) this is
/// the part -dt^2 p d^2V/dx^2 of the step matrix, with the volume V within a closed cloth. It has negative eigenvalues.
struct LoadTriangle {
    Triangle vertex;
    Vec3 first, second;  // kg/m
};

/// What forces add to the step matrix besides springs and membranes. All blocks but loads are positive semidefinite.
struct ForceBlocks {
    std::vector<CoupledBlock> coupled;
    OuterBlocks outer;
    std::vector<LoadTriangle> loads;

    void clear() {
        coupled.clear();
        outer.clear();
        loads.clear();
    }
};

}  // namespace percale
