// The springs as every vertex sees them. Each is evaluated from both of its ends: differences change sign exactly, so the two forces
// are exactly opposite.

/// Below this square a length gives no direction, m^2.
constexpr double no_length_square = 1e-36;

/// 1/sqrt(a), a > 0: from the single-precision root, two Newton steps y (3 - a y^2)/2.
PERCALE_INLINE WidePack inverse_root(WidePack a) {
    WidePack y = widen(all(1.0f) / root(narrow(a)));
    const WidePack half = all_wide(0.5) * a, three_halves = all_wide(1.5);
    y = y * (three_halves - half * (y * y));
    return y * (three_halves - half * (y * y));
}

void start_springs(const StartPass& pass, Slices range) {
    const SpringEntries& springs = pass.springs;
    const WidePack rate_scale = all_wide(1.0 / pass.dt), smallest = all_wide(no_length_square), one = all_wide(1.0);
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const WidePoint own = load_wide(pass.positions, static_cast<std::size_t>(s) * slice_lanes + lane);
            for (int e = springs.pattern.start[s] + lane; e < springs.pattern.start[s + 1]; e += slice_lanes) {
                const WidePoint x = own - gather_wide(pass.points, springs.pattern.other + e);
                const WidePack square = larger(dot(x, x), smallest);
                const WidePack length = square * inverse_root(square);
                const WidePack elastic = load_wide(springs.stiffness + e), rate = rate_scale * load_wide(springs.damping + e);
                const WidePack stiffness = elastic + rate;
                const WidePack divisor = where_less(all_wide(0.0), stiffness, stiffness, one);
                const WidePack sum = elastic * load_wide(springs.rest_length + e) + rate * length;
                store_wide(pass.stiffness + e, stiffness);
                store_wide(pass.rest + e, {sum.low / divisor.low, sum.high / divisor.high});
            }
        }
    }
}

/// -dt^2 Jq - dt Jv = along d d^T + across (I - d d^T) = across I + (along - across) d d^T, as a and w.
PERCALE_INLINE void store_block(float* values, WidePack along, WidePack across, WidePoint d) {
    const FloatPack w = root(narrow(along - across));
    store(values, narrow(across));
    store(values + slice_lanes, w * narrow(d.x));
    store(values + 2 * slice_lanes, w * narrow(d.y));
    store(values + 3 * slice_lanes, w * narrow(d.z));
}

template <bool with_matrix, bool with_motion>
PERCALE_INLINE double spring_slices(const SpringPass& pass, Slices range) {
    const SpringEntries& springs = pass.springs;
    const WidePack none = all_wide(0.0), smallest = all_wide(no_length_square), quarter = all_wide(0.25);
    const WidePack stiffness_scale = all_wide(pass.dt * pass.dt);
    const WidePack damping_scale = all_wide(pass.dt);
    LaneSums energy;
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const WidePoint own = load_wide(pass.positions, at);
            WidePoint own_velocity{none, none, none};
            if constexpr (with_motion) own_velocity = load_wide(pass.velocities, at);
            WidePoint force{none, none, none};
            WidePack sum = none;
            for (int e = springs.pattern.start[s] + lane; e < springs.pattern.start[s + 1]; e += slice_lanes) {
                const WidePoint x = own - gather_wide(pass.points, springs.pattern.other + e);
                const WidePack square = dot(x, x), safe = larger(square, smallest);
                const WidePack inverse = inverse_root(safe);
                const WidePoint d = inverse * x;
                const WidePack stiffness = load_wide(springs.stiffness + e);
                const WidePack stretch = safe * inverse - load_wide(springs.rest_length + e);
                WidePack tension = stiffness * stretch, along = stiffness_scale * stiffness;
                sum = sum + tension * stretch;
                if constexpr (with_motion) {
                    const WidePack damping = load_wide(springs.damping + e);
                    const WidePoint v = own_velocity - gather_wide(pass.motion, springs.pattern.other + e);
                    tension = tension + damping * dot(v, d);
                    along = along + damping_scale * damping;
                }
                force = force - tension * d;
                if constexpr (with_matrix) {
                    const WidePack across = smaller(larger(stiffness_scale * (tension * inverse), none), along);
                    store_block(pass.values + 4 * static_cast<std::size_t>(e - lane) + lane, along,
                                where_less(square, smallest, along, across), d);
                }
            }
            energy.add(lane, quarter * sum);
            const ConstAxes before{pass.forces.x, pass.forces.y, pass.forces.z};
            store_wide(pass.forces, at, load_wide(before, at) + force);
        }
    }
    return energy.total();
}

double springs(const SpringPass& pass, Slices range) {
    if (pass.values && pass.motion) return spring_slices<true, true>(pass, range);
    if (pass.values) return spring_slices<true, false>(pass, range);
    if (pass.motion) return spring_slices<false, true>(pass, range);
    return spring_slices<false, false>(pass, range);
}
