#include "subset_system.h"

#include <algorithm>

#include "matrix_entries.h"

namespace percale {
namespace {

/// Iterations that end a subset's linear solve. More: accuracy that the next state makes useless.
constexpr int max_subset_linear_iterations = 200;

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
    return sum;
}

}  // namespace

void SubsetSystem::fill(const BlockMatrix& matrix, std::span<const int> vertices) {
    for (const int v : vertices_) number_[v] = -1;
    number_.resize(matrix.padded(), -1);
    vertices_.assign(vertices.begin(), vertices.end());
    for (std::size_t i = 0; i < vertices_.size(); ++i) number_[vertices_[i]] = static_cast<int>(i);
    start_.assign(1, 0);
    column_.clear();
    block_.clear();
    diagonal_.resize(vertices_.size());
    inverse_.resize(vertices_.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        const int v = vertices_[i];
        diagonal_[i] = matrix.diagonal.block(v);
        for (std::size_t k = 0; k < 6; ++k) inverse_[i][k] = matrix.inverse[k * matrix.padded() + v];
        for_each_entry(matrix, v, [&](int other, const Eigen::Matrix3d& block) {
            if (number_[other] < 0) return;
            column_.push_back(number_[other]);
            block_.push_back(block);
        });
        start_.push_back(static_cast<int>(column_.size()));
    }
    add_coupled(matrix);
    add_outer(matrix);
}

void SubsetSystem::add_coupled(const BlockMatrix& matrix) {
    coupled_.clear();
    for (std::size_t number = 0; number < matrix.coupled.size(); ++number) {
        CoupledBlock block = matrix.coupled[number];
        bool touches = false;
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) {
            block.vertex[k] = number_[block.vertex[k]];
            touches = touches || block.vertex[k] >= 0;
        }
        if (touches) coupled_.push_back(block);
    }
}

void SubsetSystem::add_outer(const BlockMatrix& matrix) {
    outer_.clear();
    const OuterBlocks& blocks = matrix.of_forces->outer;
    for (int number = 0; number < blocks.size(); ++number) {
        const OuterBlocks::Block block = blocks[number];
        const auto count = std::ranges::count_if(block.vertex, [&](int v) { return number_[v] >= 0; });
        if (count == 0) continue;
        const OuterBlocks::NewBlock own = outer_.add(static_cast<int>(count));
        std::size_t next = 0;
        for (std::size_t k = 0; k < block.vertex.size(); ++k) {
            if (number_[block.vertex[k]] < 0) continue;
            own.vertex[next] = number_[block.vertex[k]];
            own.gradient[next++] = block.gradient[k];
        }
    }
}

void SubsetSystem::multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y) const {
    for (std::size_t i = 0; i < x.size(); ++i) {
        y[i] = block_times(diagonal_[i], x[i]);
        for (int e = start_[i]; e < start_[i + 1]; ++e) y[i] += block_[e] * x[column_[e]];
    }
    for (const CoupledBlock& block : coupled_) {
        Vec3 u = Vec3::Zero();
        for (int k = 0; k < 4; ++k) {
            if (block.vertex[k] >= 0) u += block.weight[k] * x[block.vertex[k]];
        }
        const Vec3 f = block_times(block.k, u);
        for (int k = 0; k < 4; ++k) {
            if (block.vertex[k] >= 0) y[block.vertex[k]] += block.weight[k] * f;
        }
    }
    for (int number = 0; number < outer_.size(); ++number) {
        const OuterBlocks::Block block = outer_[number];
        double along = 0.0;
        for (std::size_t k = 0; k < block.vertex.size(); ++k) along += block.gradient[k].dot(x[block.vertex[k]]);
        for (std::size_t k = 0; k < block.vertex.size(); ++k) y[block.vertex[k]] += along * block.gradient[k];
    }
}

/// z = D^-1 r; returns r . z
double SubsetSystem::precondition() {
    for (std::size_t i = 0; i < r_.size(); ++i) z_[i] = block_times(inverse_[i], r_[i]);
    return dot(r_, z_);
}

int SubsetSystem::solve(const Vec3Arrays& b, double ratio, Vec3Arrays& x) {
    const std::size_t size = vertices_.size();
    x_.assign(size, Vec3::Zero());
    r_.resize(size);
    for (std::size_t i = 0; i < size; ++i) r_[i] = b.at(vertices_[i]);
    z_.resize(size);
    q_.resize(size);
    const double enough = ratio * ratio * dot(r_, r_);
    double rz = precondition();
    p_ = z_;
    int iterations = 0;
    for (; iterations < max_subset_linear_iterations && dot(r_, r_) > enough; ++iterations) {
        multiply(p_, q_);
        const double curvature = dot(p_, q_);
        if (!(curvature > 0.0)) break;
        const double alpha = rz / curvature;
        for (std::size_t i = 0; i < size; ++i) {
            x_[i] += alpha * p_[i];
            r_[i] -= alpha * q_[i];
        }
        const double next = precondition(), beta = next / rz;
        for (std::size_t i = 0; i < size; ++i) p_[i] = z_[i] + beta * p_[i];
        rz = next;
    }
    for (std::size_t i = 0; i < size; ++i) x.set(vertices_[i], x_[i]);
    return iterations;
}

}  // namespace percale
