// Triangles of membranes: forces edge by edge, each evaluated from both of its ends with the same bits; couplings between the
// edges of a triangle in the matrix from each of its vertices.

/// The edges at one pack of entries.
struct EdgeState {
    WidePoint x{};  // x_i - x_j
    WidePack square{}, half_pull{};
};

PERCALE_INLINE EdgeState edge_state(const MembranePass& pass, WidePoint own, int e) {
    const auto number = [&](int k) { return load_wide(pass.edges.numbers[k] + e); };
    const WidePoint other = gather_wide(pass.points, pass.pattern.other + e);
    EdgeState edge{.x = own - other};
    edge.square = dot(edge.x, edge.x);
    const auto triangle = [&](int side) {
        const WidePoint opposite = gather_wide(pass.points, pass.edges.opposite[side] + e);
        const WidePoint near = own - opposite, far = other - opposite;
        return number(2 + 2 * side) * dot(near, near) + number(3 + 2 * side) * dot(far, far);
    };
    edge.half_pull = number(1) * edge.square + triangle(0) + triangle(1) - number(6);
    return edge;
}

/// Adds dt^2 max(t, 0) to a, and 4 dt^2 K_ee x x^T to w w^T, which is along x, too.
PERCALE_INLINE void add_edge_block(const MembranePass& pass, const EdgeState& edge, WidePack stiffness, float* value) {
    const WidePack scale = all_wide(2.0 * pass.dt * pass.dt), none = all_wide(0.0);
    const WidePoint w{widen(load<FloatPack>(value + slice_lanes)), widen(load<FloatPack>(value + 2 * slice_lanes)),
                      widen(load<FloatPack>(value + 3 * slice_lanes))};
    const WidePack inverse = all_wide(1.0) / root(larger(edge.square, all_wide(no_length_square)));
    const FloatPack along = root(narrow(all_wide(2.0) * scale * stiffness + dot(w, w) * inverse * inverse));
    store(value, load<FloatPack>(value) + narrow(larger(scale * edge.half_pull, none)));
    store(value + slice_lanes, along * narrow(edge.x.x));
    store(value + 2 * slice_lanes, along * narrow(edge.x.y));
    store(value + 3 * slice_lanes, along * narrow(edge.x.z));
}

template <bool with_matrix>
PERCALE_INLINE double membrane_slices(const MembranePass& pass, Slices range) {
    const WidePack none = all_wide(0.0), two = all_wide(2.0), quarter = all_wide(0.25);
    LaneSums energy;
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const WidePoint own = load_wide(pass.positions, at);
            WidePoint force{none, none, none};
            WidePack sum = none;
            for (int e = pass.pattern.start[s] + lane; e < pass.pattern.start[s + 1]; e += slice_lanes) {
                const EdgeState edge = edge_state(pass, own, e);
                sum = sum + (edge.square - load_wide(pass.edges.numbers[0] + e)) * edge.half_pull;
                force = force - (two * edge.half_pull) * edge.x;
                if constexpr (with_matrix) {
                    float* value = pass.values + 4 * static_cast<std::size_t>(e - lane) + lane;
                    add_edge_block(pass, edge, load_wide(pass.edges.numbers[1] + e), value);
                }
            }
            energy.add(lane, quarter * sum);
            store_wide(pass.forces, at, load_wide(pass.forces, at) + force);
        }
    }
    return energy.total();
}

double membrane(const MembranePass& pass, Slices range) {
    return pass.values ? membrane_slices<true>(pass, range) : membrane_slices<false>(pass, range);
}

PERCALE_INLINE std::size_t corner_place(int e, int lane) {
    return corner_values * static_cast<std::size_t>(e - lane) + static_cast<std::size_t>(lane);
}

PERCALE_INLINE void store_corner_edge(float* value, WidePoint x) {
    store(value, narrow(x.x));
    store(value + slice_lanes, narrow(x.y));
    store(value + 2 * slice_lanes, narrow(x.z));
}

void fill_corners(const CornerFillPass& pass, Slices range) {
    const WidePack scale = all_wide(4.0 * pass.dt * pass.dt);
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const WidePoint own = load_wide(pass.positions, static_cast<std::size_t>(s) * slice_lanes + lane);
            for (int e = pass.corners.start[s] + lane; e < pass.corners.start[s + 1]; e += slice_lanes) {
                const WidePoint first = gather_wide(pass.points, pass.corners.other[0] + e);
                const WidePoint second = gather_wide(pass.points, pass.corners.other[1] + e);
                float* value = pass.values + corner_place(e, lane);
                store_corner_edge(value, first - own);
                store_corner_edge(value + 3 * slice_lanes, second - own);
                store_corner_edge(value + 6 * slice_lanes, second - first);
                const double* coupling = pass.corners.coupling + 3 * static_cast<std::size_t>(e - lane) + lane;
                for (int k = 0; k < 3; ++k) {
                    store(value + (9 + k) * slice_lanes, narrow(scale * load_wide(coupling + k * slice_lanes)));
                }
            }
        }
    }
}

PERCALE_INLINE FloatPoint corner_edge(const float* value) {
    return {load<FloatPack>(value), load<FloatPack>(value + slice_lanes), load<FloatPack>(value + 2 * slice_lanes)};
}
PERCALE_INLINE WidePoint wide_corner_edge(const float* value) {
    const FloatPoint edge = corner_edge(value);
    return {widen(edge.x), widen(edge.y), widen(edge.z)};
}
PERCALE_INLINE WidePack wide_number(const float* value, int k) { return widen(load<FloatPack>(value + k * slice_lanes)); }

double multiply_corners(const CornerProduct& pass, const WideProduct& product, Slices range) {
    const WidePack none = all_wide(0.0);
    LaneSums sums;
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const WidePoint own = load_wide(product.x, at);
            WidePoint sum{none, none, none};
            for (int e = pass.corners.start[s] + lane; e < pass.corners.start[s + 1]; e += slice_lanes) {
                const float* value = pass.values + corner_place(e, lane);
                const WidePoint p = wide_corner_edge(value), q = wide_corner_edge(value + 3 * slice_lanes);
                const WidePoint first = gather_wide(product.points, pass.corners.other[0] + e);
                const WidePoint second = gather_wide(product.points, pass.corners.other[1] + e);
                const WidePack along_r = dot(wide_corner_edge(value + 6 * slice_lanes), second - first);
                const WidePack pq = wide_number(value, 9);
                const WidePack pull_p = pq * dot(q, second - own) + wide_number(value, 10) * along_r;
                const WidePack pull_q = pq * dot(p, first - own) + wide_number(value, 11) * along_r;
                sum = sum - (pull_p * p + pull_q * q);
            }
            sum = load_wide(product.free + at) * sum;
            sums.add(lane, dot(own, sum));
            store_wide(product.y, at, load_wide(product.y, at) + sum);
        }
    }
    return sums.total();
}

void multiply_float_corners(const CornerProduct& pass, const FloatPass& product, Slices range) {
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const FloatPoint own = load_float(product.x, at);
            FloatPoint sum{all(0.0f), all(0.0f), all(0.0f)};
            for (int e = pass.corners.start[s] + lane; e < pass.corners.start[s + 1]; e += slice_lanes) {
                const float* value = pass.values + corner_place(e, lane);
                const FloatPoint p = corner_edge(value), q = corner_edge(value + 3 * slice_lanes);
                const FloatPoint r = corner_edge(value + 6 * slice_lanes);
                const FloatPoint first = gather_float(product.points, pass.corners.other[0] + e);
                const FloatPoint second = gather_float(product.points, pass.corners.other[1] + e);
                const FloatPoint dp = first - own, dq = second - own, dr = second - first;
                const FloatPack along_r = r.x * dr.x + r.y * dr.y + r.z * dr.z, pq = load<FloatPack>(value + 9 * slice_lanes);
                const FloatPack pull_p =
                    pq * (q.x * dq.x + q.y * dq.y + q.z * dq.z) + load<FloatPack>(value + 10 * slice_lanes) * along_r;
                const FloatPack pull_q =
                    pq * (p.x * dp.x + p.y * dp.y + p.z * dp.z) + load<FloatPack>(value + 11 * slice_lanes) * along_r;
                sum = sum + (pull_p * p + pull_q * q);
            }
            const FloatPoint before = load_float(product.y, at);
            store_float(product.y, at, product.right ? before + sum : before - sum);
        }
    }
}

/// c (p q^T + q p^T)
PERCALE_INLINE void add_mixed(WideBlock& sum, WidePack c, WidePoint p, WidePoint q) {
    const WidePack twice = c + c;
    sum.xx = sum.xx + twice * p.x * q.x;
    sum.xy = sum.xy + c * (p.x * q.y + p.y * q.x);
    sum.xz = sum.xz + c * (p.x * q.z + p.z * q.x);
    sum.yy = sum.yy + twice * p.y * q.y;
    sum.yz = sum.yz + c * (p.y * q.z + p.z * q.y);
    sum.zz = sum.zz + twice * p.z * q.z;
}

void corner_diagonal(const CornerProduct& pass, const DiagonalSums& sums, Slices range) {
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const auto entry = [&](std::size_t k) { return load_wide(sums.diagonal + k * sums.padded + at); };
            WideBlock sum{entry(0), entry(1), entry(2), entry(3), entry(4), entry(5)};
            for (int e = pass.corners.start[s] + lane; e < pass.corners.start[s + 1]; e += slice_lanes) {
                const float* value = pass.values + corner_place(e, lane);
                add_mixed(sum, wide_number(value, 9), wide_corner_edge(value), wide_corner_edge(value + 3 * slice_lanes));
            }
            store_diagonal(sums.diagonal + at, sums.padded, sum);
            store_inverse(sums.inverse + at, sums.padded, sum);
        }
    }
}
