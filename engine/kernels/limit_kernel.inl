// Edges that resist beyond a length. Few pull: a pack of vertices is evaluated only where some edge of theirs is that long.

/// Whether any edge of a pack of vertices, whose first entries stand at `first`, pulls.
PERCALE_INLINE bool any_pulls(const LimitPass& pass, WidePoint own, int first, int last) {
    WidePack max = all_wide(-1.0);
    for (int e = first; e < last; e += slice_lanes) {
        const WidePoint x = own - gather_wide(pass.points, pass.pattern.other + e);
        max = larger(max, dot(x, x) - load_wide(pass.limits.slack_square + e));
    }
    double excess[float_lanes];
    store_wide(excess, max);
    bool any = false;
    for (const double one : excess) any = any || one > 0.0;
    return any;
}

/// Adds dt^2 T/l to a and dt^2 (k - T/l) d d^T to w w^T, which is along d, too, where T > 0.
PERCALE_INLINE void add_limit_block(float* value, double dt, WidePoint x, WidePack square, WidePack pull, WidePack stiffness) {
    const WidePack scale = all_wide(dt * dt), none = all_wide(0.0);
    const WidePoint w{widen(load<FloatPack>(value + slice_lanes)), widen(load<FloatPack>(value + 2 * slice_lanes)),
                      widen(load<FloatPack>(value + 3 * slice_lanes))};
    const WidePack gain = where_less(none, pull, larger(scale * (stiffness - pull), none), none);
    const WidePack along = root((dot(w, w) + gain) / square);
    store(value, load<FloatPack>(value) + narrow(scale * pull));
    // Edges that do not pull keep every bit: which others share their pack depends on the instruction set.
    store(value + slice_lanes, narrow(where_less(none, pull, along * x.x, w.x)));
    store(value + 2 * slice_lanes, narrow(where_less(none, pull, along * x.y, w.y)));
    store(value + 3 * slice_lanes, narrow(where_less(none, pull, along * x.z, w.z)));
}

template <bool with_matrix>
PERCALE_INLINE double limit_slices(const LimitPass& pass, Slices range) {
    const WidePack none = all_wide(0.0), quarter = all_wide(0.25), min_stiffness = all_wide(1e-30);
    LaneSums energy;
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const WidePoint own = load_wide(pass.positions, at);
            if (!any_pulls(pass, own, pass.pattern.start[s] + lane, pass.pattern.start[s + 1])) continue;
            WidePoint force{none, none, none};
            WidePack twice = none;
            for (int e = pass.pattern.start[s] + lane; e < pass.pattern.start[s + 1]; e += slice_lanes) {
                const WidePoint x = own - gather_wide(pass.points, pass.pattern.other + e);
                const WidePack square = larger(dot(x, x), all_wide(no_length_square)), length = root(square);
                const WidePack stiffness = load_wide(pass.limits.stiffness + e);
                const WidePack excess = length - load_wide(pass.limits.length + e);
                const WidePack tension = larger(load_wide(pass.limits.hold + e) + stiffness * excess, none);
                const WidePack pull = tension / length;
                twice = twice + tension * tension / larger(stiffness, min_stiffness);
                force = force - pull * x;
                if constexpr (with_matrix) {
                    float* value = pass.values + 4 * static_cast<std::size_t>(e - lane) + lane;
                    add_limit_block(value, pass.dt, x, square, pull, stiffness);
                }
            }
            energy.add(lane, quarter * twice);
            store_wide(pass.forces, at, load_wide(pass.forces, at) + force);
        }
    }
    return energy.total();
}

double limits(const LimitPass& pass, Slices range) {
    return pass.values ? limit_slices<true>(pass, range) : limit_slices<false>(pass, range);
}
