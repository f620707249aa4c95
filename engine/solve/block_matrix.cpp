#include "block_matrix.h"

namespace percale {
namespace {

constexpr int lanes = Vectors::lanes;

/// Inverse of a symmetric positive definite 3x3 block by cofactors; entries xx xy xz yy yz zz at index i.
void invert_block(const DiagonalBlocks& m, std::size_t i, DiagonalBlocks& inverse) {
    const double xx = m[0][i], xy = m[1][i], xz = m[2][i], yy = m[3][i], yz = m[4][i], zz = m[5][i];
    const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
    const double scale = 1.0 / (xx * cxx + xy * cxy + xz * cxz);
    inverse[0][i] = scale * cxx;
    inverse[1][i] = scale * cxy;
    inverse[2][i] = scale * cxz;
    inverse[3][i] = scale * (xx * zz - xz * xz);
    inverse[4][i] = scale * (xy * xz - xx * yz);
    inverse[5][i] = scale * (xx * yy - xy * xy);
}

/// y[i] = block[i] x[i] for all vertices.
void multiply_blocks(const DiagonalBlocks& block, const Vectors& x, Vectors& y) {
    for (std::size_t i = 0; i < x.padded_size(); ++i) {
        y.x[i] = block[0][i] * x.x[i] + block[1][i] * x.y[i] + block[2][i] * x.z[i];
        y.y[i] = block[1][i] * x.x[i] + block[3][i] * x.y[i] + block[4][i] * x.z[i];
        y.z[i] = block[2][i] * x.x[i] + block[4][i] * x.y[i] + block[5][i] * x.z[i];
    }
}

void subtract_couplings(const BlockMatrix& m, const Vectors& x, Vectors& y) {
    for (int s = 0; s < m.pattern->slices(); ++s) {
        const std::size_t base = static_cast<std::size_t>(s) * lanes;
        for (int e = m.pattern->start[s]; e < m.pattern->start[s + 1]; e += lanes) {
            for (int lane = 0; lane < lanes; ++lane) {
                const int at = e + lane, j = m.pattern->other[at];
                const double along = m.wx[at] * x.x[j] + m.wy[at] * x.y[j] + m.wz[at] * x.z[j];
                y.x[base + lane] -= m.a[at] * x.x[j] + m.wx[at] * along;
                y.y[base + lane] -= m.a[at] * x.y[j] + m.wy[at] * along;
                y.z[base + lane] -= m.a[at] * x.z[j] + m.wz[at] * along;
            }
        }
    }
}

void add_contact_product(std::span<const ContactBlock> contacts, const Vectors& x, Vectors& y) {
    for (const ContactBlock& block : contacts) {
        Vec3 u = Vec3::Zero();
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) u += block.weight[k] * x.at(block.vertex[k]);
        const auto& m = block.k;
        const Vec3 f(m[0] * u.x() + m[1] * u.y() + m[2] * u.z(), m[1] * u.x() + m[3] * u.y() + m[4] * u.z(),
                     m[2] * u.x() + m[4] * u.y() + m[5] * u.z());
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) y.add(block.vertex[k], block.weight[k] * f);
    }
}

}  // namespace

void set_pattern(const Adjacency& pattern, BlockMatrix& matrix) {
    matrix.pattern = &pattern;
    const std::size_t padded = static_cast<std::size_t>(pattern.slices()) * lanes;
    for (auto* list : {&matrix.a, &matrix.wx, &matrix.wy, &matrix.wz}) list->assign(pattern.other.size(), 0.0);
    for (auto* blocks : {&matrix.diagonal, &matrix.inverse}) {
        for (auto& list : *blocks) list.assign(padded, 0.0);
    }
    matrix.free.assign(padded, 0.0);
    for (int i = 0; i < pattern.vertex_count; ++i) matrix.free[i] = 1.0;
}

void fill_diagonal(std::span<const double> mass, const Adjacency& pattern, const SpringTerms& springs, DiagonalBlocks& d) {
    const std::size_t padded = static_cast<std::size_t>(pattern.slices()) * lanes;
    for (auto& list : d) list.assign(padded, 0.0);
    for (const int axis : {0, 3, 5}) {
        for (std::size_t i = 0; i < padded; ++i) d[axis][i] = i < mass.size() ? mass[i] : 1.0;
    }
    for (int s = 0; s < pattern.slices(); ++s) {
        for (int e = pattern.start[s]; e < pattern.start[s + 1]; ++e) {
            const int spring = pattern.spring[e];
            const std::size_t i = static_cast<std::size_t>(s) * lanes + (e - pattern.start[s]) % lanes;
            const double a = springs.a[spring], x = springs.wx[spring], y = springs.wy[spring], z = springs.wz[spring];
            d[0][i] += a + x * x;
            d[1][i] += x * y;
            d[2][i] += x * z;
            d[3][i] += a + y * y;
            d[4][i] += y * z;
            d[5][i] += a + z * z;
        }
    }
}

void fill_matrix(std::span<const double> mass, const SpringTerms& springs, BlockMatrix& matrix) {
    fill_diagonal(mass, *matrix.pattern, springs, matrix.diagonal);
    for (std::size_t e = 0; e < matrix.a.size(); ++e) {
        const int spring = matrix.pattern->spring[e];
        matrix.a[e] = springs.a[spring];
        matrix.wx[e] = springs.wx[spring];
        matrix.wy[e] = springs.wy[spring];
        matrix.wz[e] = springs.wz[spring];
    }
}

void set_contacts(std::span<const ContactBlock> contacts, BlockMatrix& matrix) {
    matrix.contacts = contacts;
    matrix.inverse = matrix.diagonal;
    for (const ContactBlock& block : contacts) {
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) {
            const double square = block.weight[k] * block.weight[k];
            for (int entry = 0; entry < 6; ++entry) matrix.inverse[entry][block.vertex[k]] += square * block.k[entry];
        }
    }
    for (std::size_t i = 0; i < matrix.free.size(); ++i) invert_block(matrix.inverse, i, matrix.inverse);
}

void multiply(const BlockMatrix& matrix, const Vectors& x, Vectors& y) {
    multiply_blocks(matrix.diagonal, x, y);
    subtract_couplings(matrix, x, y);
    add_contact_product(matrix.contacts, x, y);
}

void precondition(const BlockMatrix& matrix, const Vectors& r, Vectors& z) {
    multiply_blocks(matrix.inverse, r, z);
    filter(matrix, z);
}

void filter(const BlockMatrix& matrix, Vectors& x) {
    for (std::size_t i = 0; i < x.padded_size(); ++i) {
        x.x[i] *= matrix.free[i];
        x.y[i] *= matrix.free[i];
        x.z[i] *= matrix.free[i];
    }
}

}  // namespace percale
