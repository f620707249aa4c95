#include "multigrid.h"

#include <algorithm>
#include <cmath>

#include "tolerances.h"

namespace percale {
namespace {

/// Factor of the damping at vertices sewn to points, whose eigenvalues go up to 3. 1: conjugate gradient takes hundreds of
/// iterations where sewn points are stiffer than the cloth.
constexpr float sewn_point_easing = 2.0f / 3.0f;

/// Times the stiffness of their vertex, along all axes together: constraints between cloths that are stiffer get the sweeps of
/// constraint_sweeps. Cost alone: softer constraints gain less than the sweeps take.
constexpr double stiff_constraint_factor = 1.0;

/// Pairs in a thread's part, and from which number on the work is divided. Cost alone.
constexpr int pair_grain = 512, min_shared_pairs = 2048;

using Block = std::array<double, 6>;

Block block_product(const Block& a, const Block& b) {
    // Symmetric because a is a function of b here: both have the same eigenvectors.
    return {a[0] * b[0] + a[1] * b[1] + a[2] * b[2], a[0] * b[1] + a[1] * b[3] + a[2] * b[4],
            a[0] * b[2] + a[1] * b[4] + a[2] * b[5], a[1] * b[1] + a[3] * b[3] + a[4] * b[4],
            a[1] * b[2] + a[3] * b[4] + a[4] * b[5], a[2] * b[2] + a[4] * b[4] + a[5] * b[5]};
}

double trace(const Block& a) { return a[0] + a[3] + a[5]; }

/// (A : B)/trace B: the size of A along B.
double size_along(const Block& a, const Block& b) {
    const double product = a[0] * b[0] + a[3] * b[3] + a[5] * b[5] + 2.0 * (a[1] * b[1] + a[2] * b[2] + a[4] * b[4]);
    return product / trace(b);
}

/// S = d (d I + K)^-1 with the size d of a vertex's own block along K.
Block softening(const Block& own, const Block& k) {
    const double d = size_along(own, k);
    Block sum = k;
    for (const int entry : {0, 3, 5}) sum[entry] += d;
    Block result = inverse_block(sum);
    for (double& entry : result) entry *= d;
    return result;
}

std::array<float, 6> to_float(const Block& a) {
    std::array<float, 6> result;
    for (int k = 0; k < 6; ++k) result[k] = static_cast<float>(a[k]);
    return result;
}

}  // namespace

Multigrid::Multigrid(const Compute& compute, const Adjacency& pattern, std::span<const Vec3> rest)
    : compute_(compute), adjacency_(pattern) {
    SpringGraph graph{.positions = {rest.begin(), rest.end()}, .pairs = {}, .strength = {}};
    // Pairs in the order of their vertices: neighbours are then near in memory, too.
    pair_of_spring_.assign(pattern.place.size(), -1);
    for (int s = 0; s < pattern.slices(); ++s) {
        for (int lane = 0; lane < slice_lanes; ++lane) {
            for (int e = pattern.start[s] + lane; e < pattern.start[s + 1]; e += slice_lanes) {
                const std::size_t spring = pattern.spring[e];
                if (spring >= pair_of_spring_.size() || pair_of_spring_[spring] >= 0) continue;
                pair_of_spring_[spring] = static_cast<int>(graph.pairs.size());
                graph.pairs.push_back({s * slice_lanes + lane, pattern.other[e]});
                graph.strength.push_back(pattern.strength(static_cast<int>(spring)));
                pair_value_.push_back(pattern.value_place(static_cast<int>(spring)));
            }
        }
    }
    patterns_ = make_hierarchy(std::move(graph));
    Level fine = sized_level(pattern.pattern(), pattern.slices());
    fine.ground.resize(fine.padded);
    fine.inverse.resize(6 * fine.padded);
    fine.blocks.assign(8 * (pair_value_.size() + 1), 0.0f);
    guarded_.assign(pattern.bands.count > 0 ? pattern.point_count() : 0, 0.0f);
    levels_.push_back(std::move(fine));
    for (const LevelPattern& coarser : patterns_) add_level(coarser);
    find_eased();
    if (patterns_.empty() || patterns_.back().vertices > dense_vertices) return;
    bottom_size_ = 3 * patterns_.back().vertices;
    bottom_stride_ = (bottom_size_ + slice_lanes - 1) / slice_lanes * slice_lanes;
    bottom_.resize(static_cast<std::size_t>(bottom_size_) * bottom_stride_);
    bottom_inverse_.resize(bottom_.size());
    for (auto* list : {&bottom_x_, &bottom_y_}) list->assign(bottom_stride_, 0.0f);
}

void Multigrid::add_level(const LevelPattern& pattern) {
    Level level = sized_level(pattern.pattern(), pattern.slices());
    level.own_values.resize(6 * pattern.other.size());
    level.values = level.own_values.data();
    level.blocks.assign(8 * (pattern.pairs.size() + 1), 0.0f);
    level.ground.resize(6 * level.padded);
    level.inverse.resize(6 * level.padded);
    levels_.push_back(std::move(level));
}

/// Finds the ends of springs of sewn points, and the coarser vertices that they depend on.
void Multigrid::find_eased() {
    const auto sort_out = [](std::vector<int>& list) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    std::vector<bool> sewn(adjacency_.place.size(), false);
    for (const int spring : adjacency_.sewn) sewn[spring] = true;
    std::vector<int>& finest = levels_[0].eased;
    for (std::size_t e = 0; e < adjacency_.other.size(); ++e) {
        const std::size_t spring = adjacency_.spring[e];
        if (spring < sewn.size() && sewn[spring]) finest.push_back(adjacency_.other[e]);
    }
    sort_out(finest);
    for (int k = 1; k < levels(); ++k) {
        std::vector<int>& own = levels_[k].eased;
        for (const int vertex : levels_[k - 1].eased) {
            const InterpolationRow& row = patterns_[k - 1].rows[vertex];
            own.insert(own.end(), row.vertex.begin(), row.vertex.begin() + row.count);
        }
        sort_out(own);
    }
}

/// The block w w^T K of a vertex sewn to a point has three times its part of the diagonal as eigenvalue; a spring has twice that.
void Multigrid::ease(Level& level) const {
    for (const int vertex : level.eased) {
        for (std::size_t entry = 0; entry < 6; ++entry) level.inverse[entry * level.padded + vertex] *= sewn_point_easing;
    }
}

Multigrid::Level Multigrid::sized_level(EntryPattern pattern, int slices) const {
    Level level;
    level.pattern = pattern;
    level.slices = slices;
    level.padded = static_cast<std::size_t>(level.slices) * slice_lanes;
    for (auto* list : {&level.x, &level.b, &level.r}) list->assign(3 * level.padded, 0.0f);
    for (auto* list : {&level.points, &level.handed}) list->assign(4 * level.padded, 0.0f);
    return level;
}

void Multigrid::fill(const BlockMatrix& matrix, Coarser coarser) {
    Level& fine = levels_[0];
    fine.values = matrix.springs->values.data();
    fine.corners = matrix.springs->corners.empty() ? nullptr : matrix.springs->corners.data();
    for_each_vertex(compute_, fine.slices, [&](std::size_t i) {
        fine.ground[i] = static_cast<float>(matrix.mass[i]);
        for (std::size_t entry = 0; entry < 6; ++entry) {
            fine.inverse[entry * fine.padded + i] = matrix.inverse[entry * fine.padded + i];
        }
    });
    ease(fine);
    coupled_ = matrix.coupled;
    outer_.clear();
    for (const int number : matrix.local_outer) outer_.push_back(matrix.of_forces->outer[number]);
    find_exact(matrix);
    set_filters(matrix);
    set_rows(matrix);
    if (coarser == Coarser::kept) return;
    expand_blocks(*matrix.springs);
    expand_outer();
    for (int k = 1; k < levels(); ++k) fill_level(k);
    if (bottom_size_ > 0) fill_bottom();
}

/// Finds the constraints between cloths, if some of them are stiffer than their vertex, and the outer blocks.
void Multigrid::find_exact(const BlockMatrix& matrix) {
    exact_rows_.clear();
    sweeps_ = false;
    if (levels() == 1) return;
    for (std::size_t row = 0; row < coupled_.size(); ++row) {
        const CoupledBlock& block = coupled_[row];
        if (!between_cloths(block)) continue;
        exact_rows_.push_back(static_cast<int>(row));
        const int i = block.vertex[0];
        const double own = matrix.diagonal[0][i] + matrix.diagonal[3][i] + matrix.diagonal[5][i];
        sweeps_ = sweeps_ || trace(block.k) > stiff_constraint_factor * own;
    }
    if (!sweeps_) exact_rows_.clear();
    if (sweeps_) change_.assign(3 * padded(), 0.0f);  // 0 at all entries that no sweep sets
    for (std::size_t k = 0; k < outer_.size(); ++k) exact_rows_.push_back(static_cast<int>(coupled_.size() + k));
}

bool Multigrid::is_exact(std::size_t row) const {
    return row < coupled_.size() ? sweeps_ && between_cloths(coupled_[row]) : levels() > 1;
}

/// Sets VertexBlocks::coupled of each vertex without the constraints between cloths that are taken exactly.
void Multigrid::set_held_alone(const BlockMatrix& matrix) {
    held_.assign(matrix.by_vertex.size(), {});
    if (!sweeps_) {
        std::ranges::transform(matrix.by_vertex, held_.begin(), &VertexBlocks::coupled);
        return;
    }
    for (std::size_t row = 0; row < coupled_.size(); ++row) {
        const CoupledBlock& block = coupled_[row];
        if (between_cloths(block)) continue;
        for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) {
            const int slot = matrix.slot[block.vertex[k]];
            const double weight = std::abs(block.weight[k]);
            for (int entry = 0; entry < 6 && slot >= 0; ++entry) held_[slot][entry] += weight * block.k[entry];
        }
    }
}

void Multigrid::set_filters(const BlockMatrix& matrix) {
    filtered_.clear();
    filter_of_slot_.assign(matrix.by_vertex.size(), -1);
    for (int i = 0; i < adjacency_.vertex_count; ++i) {
        if (matrix.free[i] > 0.0) continue;
        Block ground = matrix.diagonal.block(i);
        for (const int k : {0, 3, 5}) ground[k] -= matrix.mass[i];
        filtered_.push_back({.vertex = i, .filter = {}, .contact = {}, .ground = ground});
    }
    prescribed_ = static_cast<int>(filtered_.size());
    set_held_alone(matrix);
    for (std::size_t slot = 0; slot < filter_of_slot_.size(); ++slot) {
        const auto& [i, coupled, outer] = matrix.by_vertex[slot];
        const bool is_coupled = trace(coupled) > 0.0;
        if (!is_coupled && !(trace(outer) > 0.0)) continue;
        filter_of_slot_[slot] = static_cast<int>(filtered_.size());
        Filtered vertex{
            .vertex = i, .filter = {1.0f, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f}, .contact = to_float(held_[slot]), .ground = {}};
        if (is_coupled) {
            const Block soft = softening(matrix.diagonal.block(i), coupled);
            vertex.ground = block_product(soft, coupled);
            if (held_[slot] == coupled) vertex.filter = to_float(soft);
        }
        if (held_[slot] != coupled && trace(held_[slot]) > 0.0)
            vertex.filter = to_float(softening(matrix.diagonal.block(i), held_[slot]));
        filtered_.push_back(vertex);
    }
    by_vertex_.clear();
    int next = 0;
    for (int i = 0; i < adjacency_.vertex_count; ++i) {
        if (next < prescribed_ && filtered_[next].vertex == i) by_vertex_.push_back(next++);
        const int slot = matrix.slot[i];
        if (slot >= 0 && filter_of_slot_[slot] >= 0) by_vertex_.push_back(filter_of_slot_[slot]);
    }
    before_.resize(filtered_.size());
}

/// Lists rows vertex by vertex in their order, so that sums over a vertex do not depend on the thread; those that are taken
/// exactly come first.
void Multigrid::set_rows(const BlockMatrix& matrix) {
    const std::size_t rows = coupled_.size() + outer_.size();
    row_force_.resize(rows);
    const auto for_row_ends = [&](std::size_t row, auto work) {
        const auto at = [&](int i, const FloatVec& factor) {
            const int slot = matrix.slot[i];
            if (slot < 0 || filter_of_slot_[slot] < 0 || factor == FloatVec{}) return;
            work(filtered_[filter_of_slot_[slot]], RowEnd{static_cast<int>(row), factor});
        };
        if (row < coupled_.size()) {
            const CoupledBlock& block = coupled_[row];
            for (int k = 0; k < 4 && block.vertex[k] >= 0; ++k) {
                const float weight = static_cast<float>(block.weight[k]);
                at(block.vertex[k], {weight, weight, weight});
            }
            return;
        }
        const OuterBlocks::Block& block = outer_[row - coupled_.size()];
        for (std::size_t k = 0; k < block.vertex.size(); ++k) {
            const Vec3& g = block.gradient[k];
            at(block.vertex[k], {static_cast<float>(g.x()), static_cast<float>(g.y()), static_cast<float>(g.z())});
        }
    };
    for (std::size_t row = 0; row < rows; ++row)
        for_row_ends(row, [exact = is_exact(row)](Filtered& vertex, const RowEnd&) { ++(exact ? vertex.exact : vertex.rows); });
    int first = 0;
    exact_.clear();
    for (std::size_t number = 0; number < filtered_.size(); ++number) {
        Filtered& vertex = filtered_[number];
        if (vertex.exact > 0) exact_.push_back(static_cast<int>(number));
        vertex.first_row = first;
        first += vertex.exact + vertex.rows;
        vertex.rows = 0;
    }
    row_ends_.resize(first);
    for (const bool exact : {true, false}) {
        for (std::size_t row = 0; row < rows; ++row) {
            if (is_exact(row) != exact) continue;
            for_row_ends(row, [&](Filtered& vertex, const RowEnd& end) { row_ends_[vertex.first_row + vertex.rows++] = end; });
        }
    }
}

void Multigrid::expand_blocks(const SpringTerms& springs) {
    const int pairs = static_cast<int>(pair_value_.size());
    parallel_for_chunks(compute_, pairs, pair_grain, pairs >= min_shared_pairs,
                        [&](int first, int last, int) { expand_stretch(springs, first, last); });
}

void Multigrid::expand_stretch(const SpringTerms& springs, int first_pair, int last_pair) {
    float* block = &levels_[0].blocks[8 * static_cast<std::size_t>(first_pair)];
    for (int k = first_pair; k < last_pair; ++k) {
        const auto& [first, apart] = pair_value_[k];
        const float* value = &springs.values[first];
        const float a = value[0], x = value[apart], y = value[2 * apart], z = value[3 * apart];
        block[0] = a + x * x;
        block[1] = x * y;
        block[2] = x * z;
        block[3] = a + y * y;
        block[4] = y * z;
        block[5] = a + z * z;
        block += 8;
    }
}

/// The number of the pair of two vertices; -1: no spring joins them.
int Multigrid::pair_between(int first, int second) const {
    const int slice = first / slice_lanes, lane = first % slice_lanes;
    for (int e = adjacency_.start[slice] + lane; e < adjacency_.start[slice + 1]; e += slice_lanes) {
        if (adjacency_.other[e] == second && second != first) return pair_of_spring_[adjacency_.spring[e]];
    }
    return -1;
}

/// Adds the local outer blocks to those of the pairs among their vertices.
void Multigrid::expand_outer() {
    const auto expand = [&](const OuterBlocks::Block& outer, std::size_t k, std::size_t l) {
        const int pair = pair_between(outer.vertex[k], outer.vertex[l]);
        if (pair < 0) return;
        const double count = static_cast<double>(outer.vertex.size());
        SymmetricBlock block{};
        add_normal_block(block, 0.5 * count * (count - 1.0), (outer.gradient[k] - outer.gradient[l]) / count);
        float* sum = &levels_[0].blocks[8 * static_cast<std::size_t>(pair)];
        for (int entry = 0; entry < 6; ++entry) sum[entry] += static_cast<float>(block[entry]);
    };
    for (const OuterBlocks::Block& outer : outer_) {
        for (std::size_t k = 0; k < outer.vertex.size(); ++k) {
            for (std::size_t l = k + 1; l < outer.vertex.size(); ++l) expand(outer, k, l);
        }
    }
}

void Multigrid::fill_level(int k) {
    const LevelPattern& pattern = patterns_[k - 1];
    Level &level = levels_[k], &finer = levels_[k - 1];
    const GalerkinPass sums{.start = pattern.term_start.data(),
                            .pair = pattern.term_pair.data(),
                            .coefficient = pattern.coefficient.data(),
                            .fine = finer.blocks.data(),
                            .coarse = level.blocks.data()};
    const int pairs = static_cast<int>(pattern.pairs.size()), entries = static_cast<int>(pattern.entry_pair.size());
    parallel_for_chunks(compute_, pairs, pair_grain, pairs >= min_shared_pairs,
                        [&](int first, int last, int) { compute_.kernels->galerkin(sums, first, last); });
    parallel_for_chunks(compute_, entries, pair_grain, entries >= min_shared_pairs, [&](int first, int last, int) {
        for (std::size_t e = first; e < static_cast<std::size_t>(last); ++e) {
            const float* block = &level.blocks[8 * static_cast<std::size_t>(pattern.entry_pair[e])];
            float* value = &level.own_values[6 * (e - e % slice_lanes) + e % slice_lanes];
            for (int entry = 0; entry < 6; ++entry) value[entry * slice_lanes] = block[entry];
        }
    });
    restrict_ground(k);
    const DiagonalPass pass{.pattern = level.pattern,
                            .values = level.values,
                            .ground = nullptr,
                            .blocks = level.ground.data(),
                            .diagonal = nullptr,
                            .inverse = level.inverse.data(),
                            .padded = level.padded};
    for_chunks(compute_, level.slices, [&](Slices range) { compute_.kernels->coarse_diagonal(pass, range); });
    ease(level);
}

/// Row sums: what holds a finer vertex holds the coarser ones by its weights.
void Multigrid::restrict_ground(int k) {
    Level& level = levels_[k];
    if (k == 1) {
        restrict_mass();
    } else {
        Level& finer = levels_[k - 1];
        for (const std::size_t half : {0, 3}) {
            const FloatVec3Arrays from{finer.ground.data() + half * finer.padded, finer.padded};
            for_chunks(compute_, finer.slices,
                       [&](Slices range) { compute_.kernels->pack_float_points(from, finer.handed.data(), range); });
            const FloatVec3Arrays to{level.ground.data() + half * level.padded, level.padded};
            for_chunks(compute_, level.slices,
                       [&](Slices range) { transfer(patterns_[k - 1].restriction, finer.handed, to, false, range); });
        }
    }
    for (const std::size_t entry : {0, 3, 5}) {
        for (std::size_t i = patterns_[k - 1].vertices; i < level.padded; ++i) level.ground[entry * level.padded + i] = 1.0f;
    }
}

/// Restricts masses at the finest level, and what holds the filtered vertices.
void Multigrid::restrict_mass() {
    Level &fine = levels_[0], &level = levels_[1];
    for_each_vertex(compute_, fine.slices, [&](std::size_t i) {
        for (std::size_t axis = 0; axis < 3; ++axis) fine.handed[4 * i + axis] = fine.ground[i];
    });
    for_chunks(compute_, level.slices, [&](Slices range) {
        transfer(patterns_[0].restriction, fine.handed, {level.ground.data(), level.padded}, false, range);
    });
    for_each_vertex(compute_, level.slices, [&](std::size_t i) {
        for (const std::size_t entry : {3, 5}) level.ground[entry * level.padded + i] = level.ground[i];
        for (const std::size_t entry : {1, 2, 4}) level.ground[entry * level.padded + i] = 0.0f;
    });
    const std::vector<InterpolationRow>& rows = patterns_[0].rows;
    for (const Filtered& vertex : filtered_) {
        const InterpolationRow& row = rows[vertex.vertex];
        for (int k = 0; k < row.count; ++k) {
            for (std::size_t entry = 0; entry < 6; ++entry) {
                level.ground[entry * level.padded + row.vertex[k]] += static_cast<float>(row.weight[k] * vertex.ground[entry]);
            }
        }
    }
}

void Multigrid::fill_bottom() {
    const Level& level = levels_.back();
    const LevelPattern& pattern = patterns_.back();
    std::fill(bottom_.begin(), bottom_.end(), 0.0);
    const auto add = [&](int i, int j, double sign, const auto& block) {
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b) {
                bottom_[static_cast<std::size_t>(3 * i + a) * bottom_stride_ + 3 * j + b] += sign * block(symmetric_entry[a][b]);
            }
        }
    };
    for (int i = 0; i < pattern.vertices; ++i) {
        add(i, i, 1.0, [&](int entry) { return level.ground[entry * level.padded + i]; });
    }
    for (std::size_t p = 0; p < pattern.pairs.size(); ++p) {
        const auto [i, j] = pattern.pairs[p];
        const auto block = [&](int entry) { return level.blocks[8 * p + entry]; };
        add(i, i, 1.0, block);
        add(j, j, 1.0, block);
        add(i, j, -1.0, block);
        add(j, i, -1.0, block);
    }
    compute_.kernels->invert(bottom_.data(), bottom_size_, bottom_stride_);
    std::transform(bottom_.begin(), bottom_.end(), bottom_inverse_.begin(),
                   [](double value) { return static_cast<float>(value); });
}

}  // namespace percale
