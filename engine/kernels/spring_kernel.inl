// The springs as every vertex sees them. Each is evaluated from both of its ends: differences change sign exactly, so the two
// forces are exactly opposite.

/// Below this square a length gives no direction, m^2; above the other the state has diverged and the force is not a number.
constexpr double no_length_square = 1e-36;
constexpr double blown_up_square = 1e36;

/// One pack of springs.
struct SpringState {
    WidePoint x{};  // x_i - x_j
    WidePack stiffness{}, rest{};
    WidePack damping{};  // with the velocity v_i - v_j
    WidePoint v{};
    WidePack bending{};
};

/// Optional parts of the evaluation of springs.
struct SpringParts {
    bool matrix, motion, bending;
};

/// T/l, with which the force on i is -(T/l + b) x, and k (l - l_rest)^2 + b l^2.
struct SpringPull {
    WidePack pull, twice_energy, square, inverse;
};

template <SpringParts parts>
PERCALE_INLINE SpringPull evaluate(const SpringState& state) {
    const WidePack square = dot(state.x, state.x), safe = larger(square, all_wide(no_length_square));
    const WidePack length = root(safe), inverse = all_wide(1.0) / length;
    const WidePack stretch = length - state.rest;
    WidePack tension = state.stiffness * where_less(square, all_wide(blown_up_square), stretch, all_wide(__builtin_nan("")));
    WidePack twice_energy = tension * stretch;
    if constexpr (parts.bending) twice_energy = twice_energy + state.bending * square;
    if constexpr (parts.motion) tension = tension + state.damping * inverse * dot(state.v, state.x);
    return {tension * inverse, twice_energy, square, inverse};
}

/// The force that the spring exerts on its second end.
template <SpringParts parts>
PERCALE_INLINE WidePoint exerted(const SpringState& state, const SpringPull& pull) {
    if constexpr (parts.bending) return (pull.pull + state.bending) * state.x;
    return pull.pull * state.x;
}

/// -dt^2 Jq - dt Jv = along d d^T + across (I - d d^T) + dt^2 b I = (across + dt^2 b) I + (along - across) d d^T, as a and w.
template <SpringParts parts>
PERCALE_INLINE void store_block(float* values, std::size_t apart, double dt, const SpringState& state, const SpringPull& pull) {
    const WidePack none = all_wide(0.0), scale = all_wide(dt * dt);
    WidePack along = scale * state.stiffness;
    if constexpr (parts.motion) along = along + all_wide(dt) * state.damping;
    WidePack across = smaller(larger(scale * pull.pull, none), along);
    across = where_less(pull.square, all_wide(no_length_square), along, across);
    const FloatPack w = root(narrow(along - across)) * narrow(pull.inverse);
    if constexpr (parts.bending) across = across + scale * state.bending;
    store(values, narrow(across));
    store(values + apart, w * narrow(state.x.x));
    store(values + 2 * apart, w * narrow(state.x.y));
    store(values + 3 * apart, w * narrow(state.x.z));
}

/// k = ks + kd/dt and l = (ks l0 + kd l_n/dt)/k at a place.
PERCALE_INLINE void store_start(const StartPass& pass, std::size_t at, WidePoint x, WidePack rate_scale) {
    const WidePack length = root(larger(dot(x, x), all_wide(no_length_square)));
    const WidePack elastic = load_wide(pass.springs.stiffness + at), rate = rate_scale * load_wide(pass.springs.damping + at);
    const WidePack stiffness = elastic + rate;
    const WidePack divisor = where_less(all_wide(0.0), stiffness, stiffness, all_wide(1.0));
    const WidePack sum = elastic * load_wide(pass.springs.rest_length + at) + rate * length;
    store_wide(pass.stiffness + at, stiffness);
    store_wide(pass.rest + at, sum / divisor);
}

void start_slices(const StartPass& pass, Slices range) {
    const EntryPattern& pattern = pass.springs.pattern;
    const WidePack rate_scale = all_wide(1.0 / pass.dt);
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const WidePoint own = load_wide(pass.positions, static_cast<std::size_t>(s) * slice_lanes + lane);
            for (int e = pattern.start[s] + lane; e < pattern.start[s + 1]; e += slice_lanes) {
                store_start(pass, e, own - gather_wide(pass.points, pattern.other + e), rate_scale);
            }
        }
    }
}

template <SpringParts parts>
PERCALE_INLINE double spring_slices(const SpringPass& pass, Slices range) {
    const SpringEntries& springs = pass.springs;
    const EntryPattern& pattern = springs.pattern;
    const WidePack none = all_wide(0.0), quarter = all_wide(0.25);
    LaneSums energy;
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const WidePoint own = load_wide(pass.positions, at);
            WidePoint own_velocity{none, none, none};
            if constexpr (parts.motion) own_velocity = load_wide(pass.velocities, at);
            WidePoint force{none, none, none};
            WidePack twice = none;
            for (int e = pattern.start[s] + lane; e < pattern.start[s + 1]; e += slice_lanes) {
                SpringState state{.x = own - gather_wide(pass.points, pattern.other + e),
                                  .stiffness = load_wide(springs.stiffness + e),
                                  .rest = load_wide(springs.rest_length + e)};
                if constexpr (parts.motion) {
                    state.damping = load_wide(springs.damping + e);
                    state.v = own_velocity - gather_wide(pass.motion, pattern.other + e);
                }
                if constexpr (parts.bending) state.bending = load_wide(springs.bending + e);
                const SpringPull pull = evaluate<parts>(state);
                twice = twice + pull.twice_energy;
                force = force - exerted<parts>(state, pull);
                if constexpr (parts.matrix) {
                    float* value = pass.values + 4 * static_cast<std::size_t>(e - lane) + lane;
                    store_block<parts>(value, slice_lanes, pass.dt, state, pull);
                }
            }
            energy.add(lane, quarter * twice);
            store_wide(pass.forces, at, load_wide(pass.forces, at) + force);
        }
    }
    return energy.total();
}
