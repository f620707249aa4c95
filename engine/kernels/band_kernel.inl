// Springs whose ends are a fixed number of vertices apart, as on a grid: all memory is read and written in order, and each
// spring is evaluated once.

/// x y z of a copy with room before and behind (BandPattern).
struct GuardedDoubles {
    const double* data;
    std::size_t apart;
    PERCALE_INLINE WidePoint at(std::ptrdiff_t i) const {
        return {load_wide(data + i), load_wide(data + apart + i), load_wide(data + 2 * apart + i)};
    }
};
struct GuardedFloats {
    const float* data;
    std::size_t apart;
    PERCALE_INLINE FloatPoint at(std::ptrdiff_t i) const {
        return {load<FloatPack>(data + i), load<FloatPack>(data + apart + i), load<FloatPack>(data + 2 * apart + i)};
    }
};

PERCALE_INLINE GuardedDoubles guarded(const BandPattern& bands, const double* points) {
    return {points + bands.guard, bands.padded + 2 * bands.guard};
}
PERCALE_INLINE GuardedFloats guarded(const BandPattern& bands, const float* points) {
    return {points + bands.guard, bands.padded + 2 * bands.guard};
}

/// The numbers a wx wy wz of a band's places, `apart` from each other, with room before.
PERCALE_INLINE const float* band_values(const BandPattern& bands, const float* values, int band) {
    return values + 4 * static_cast<std::size_t>(band) * (bands.guard + bands.padded) + bands.guard;
}

struct FloatBlock {
    FloatPack a;
    FloatPoint w;
};
PERCALE_INLINE FloatBlock load_block(const float* value, std::size_t apart) {
    return {load<FloatPack>(value),
            {load<FloatPack>(value + apart), load<FloatPack>(value + 2 * apart), load<FloatPack>(value + 3 * apart)}};
}

PERCALE_INLINE WidePoint apply(FloatBlock block, WidePoint d) {
    const WidePoint w{widen(block.w.x), widen(block.w.y), widen(block.w.z)};
    return widen(block.a) * d + dot(w, d) * w;
}
PERCALE_INLINE FloatPoint apply(FloatBlock block, FloatPoint d) {
    const FloatPack along = block.w.x * d.x + block.w.y * d.y + block.w.z * d.z;
    return block.a * d + along * block.w;
}

void start_bands(const StartPass& pass, Slices range) {
    const BandPattern& bands = *pass.springs.pattern.bands;
    const GuardedDoubles x = guarded(bands, pass.points);
    const WidePack rate_scale = all_wide(1.0 / pass.dt);
    for (int band = 0; band < bands.count; ++band) {
        for (int i = range.first * slice_lanes; i < range.last * slice_lanes; i += float_lanes) {
            const std::size_t at = band * bands.padded + i;
            store_start(pass, at, x.at(i) - x.at(i + bands.offset[band]), rate_scale);
        }
    }
}

/// The springs of all bands at float_lanes places from i on: forces into the scratch, row by row of a range that begins with the
/// guard; returns twice their energy. Values are stored unless null.
template <SpringParts parts>
PERCALE_INLINE WidePack band_places(const SpringPass& pass, std::ptrdiff_t i, double* scratch, std::size_t row, float* values) {
    const SpringEntries& springs = pass.springs;
    const BandPattern& bands = *springs.pattern.bands;
    const GuardedDoubles points = guarded(bands, pass.points);
    const WidePoint own = points.at(i);
    WidePack energy = all_wide(0.0);
    for (int band = 0; band < bands.count; ++band) {
        const std::size_t at = band * bands.padded + i;
        SpringState state{.x = own - points.at(i + bands.offset[band]),
                          .stiffness = load_wide(springs.stiffness + at),
                          .rest = load_wide(springs.rest_length + at)};
        if constexpr (parts.bending) state.bending = load_wide(springs.bending + at);
        if constexpr (parts.motion) {
            const GuardedDoubles motion = guarded(bands, pass.motion);
            state.damping = load_wide(springs.damping + at);
            state.v = motion.at(i) - motion.at(i + bands.offset[band]);
        }
        const SpringPull pull = evaluate<parts>(state);
        energy = energy + pull.twice_energy;
        double* target = scratch + 3 * band * row;
        const WidePoint force = exerted<parts>(state, pull);
        store_wide(target, force.x);
        store_wide(target + row, force.y);
        store_wide(target + 2 * row, force.z);
        if constexpr (parts.matrix) {
            if (!values) continue;
            float* value = const_cast<float*>(band_values(bands, values, band)) + i;
            store_block<parts>(value, bands.guard + bands.padded, pass.dt, state, pull);
        }
    }
    return energy;
}

/// forces(i) += sum over bands of the forces of the springs beginning at i - offset less those of the springs beginning at i.
PERCALE_INLINE void sum_bands(const SpringPass& pass, std::ptrdiff_t i, const double* scratch, std::size_t row) {
    const BandPattern& bands = *pass.springs.pattern.bands;
    WidePoint force = load_wide(pass.forces, i);
    for (int band = 0; band < bands.count; ++band) {
        const GuardedDoubles exerted{scratch + 3 * band * row, row};
        force = force + (exerted.at(-bands.offset[band]) - exerted.at(0));
    }
    store_wide(pass.forces, i, force);
}

template <SpringParts parts>
PERCALE_INLINE double band_springs(const SpringPass& pass, Slices range) {
    const BandPattern& bands = *pass.springs.pattern.bands;
    const std::ptrdiff_t guard = bands.guard, first = static_cast<std::ptrdiff_t>(range.first) * slice_lanes;
    const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(range.last) * slice_lanes;
    const std::size_t row = guard + static_cast<std::size_t>(last - first);
    double* scratch = pass.scratch;
    std::ptrdiff_t i = first - guard;
    for (; i < 0; i += float_lanes) {
        for (int k = 0; k < 3 * bands.count; ++k) store_wide(scratch + k * row + (i - first + guard), all_wide(0.0));
    }
    for (; i < first; i += float_lanes) {
        band_places<parts>(pass, i, scratch + (i - first + guard), row, nullptr);
    }
    LaneSums energy;
    for (; i < last; i += float_lanes) {
        const WidePack twice = band_places<parts>(pass, i, scratch + (i - first + guard), row, pass.values);
        energy.add(static_cast<int>(i % slice_lanes), all_wide(0.5) * twice);
    }
    for (i = first; i < last; i += float_lanes) sum_bands(pass, i, scratch + (i - first + guard), row);
    return energy.total();
}

double multiply_bands(const BlockPass& pass, const double* points, const double* free, Axes y, Slices range) {
    const BandPattern& bands = *pass.pattern.bands;
    const GuardedDoubles x = guarded(bands, points);
    const std::size_t apart = bands.guard + bands.padded;
    LaneSums sums;
    for (std::ptrdiff_t i = range.first * slice_lanes; i < range.last * slice_lanes; i += float_lanes) {
        const WidePoint own = x.at(i);
        WidePoint result = load_wide(pass.ground + i) * own;
        for (int band = 0; band < bands.count; ++band) {
            const float* value = band_values(bands, pass.values, band) + i;
            const int offset = bands.offset[band];
            result = result + apply(load_block(value, apart), own - x.at(i + offset)) +
                     apply(load_block(value - offset, apart), own - x.at(i - offset));
        }
        result = load_wide(free + i) * result;
        sums.add(static_cast<int>(i % slice_lanes), dot(own, result));
        store_wide(y, i, result);
    }
    return sums.total();
}

void multiply_fine_bands(const FloatPass& pass, Slices range) {
    const BandPattern& bands = *pass.pattern.bands;
    const GuardedFloats x = guarded(bands, pass.points);
    const std::size_t apart = bands.guard + bands.padded;
    for (std::ptrdiff_t i = range.first * slice_lanes; i < range.last * slice_lanes; i += float_lanes) {
        const FloatPoint own = x.at(i);
        FloatPoint result = load<FloatPack>(pass.ground + i) * own;
        for (int band = 0; band < bands.count; ++band) {
            const float* value = band_values(bands, pass.values, band) + i;
            const int offset = bands.offset[band];
            result = result + apply(load_block(value, apart), own - x.at(i + offset)) +
                     apply(load_block(value - offset, apart), own - x.at(i - offset));
        }
        store_product(pass, i, result);
    }
}

PERCALE_INLINE WideBlock add_block(WideBlock m, FloatBlock block) {
    const WidePack a = widen(block.a), x = widen(block.w.x), y = widen(block.w.y), z = widen(block.w.z);
    return {m.xx + a + x * x, m.xy + x * y, m.xz + x * z, m.yy + a + y * y, m.yz + y * z, m.zz + a + z * z};
}

void band_diagonal(const DiagonalPass& pass, Slices range) {
    const BandPattern& bands = *pass.pattern.bands;
    const std::size_t apart = bands.guard + bands.padded;
    for (std::ptrdiff_t i = range.first * slice_lanes; i < range.last * slice_lanes; i += float_lanes) {
        const WidePack ground = load_wide(pass.ground + i), none = all_wide(0.0);
        WideBlock m{ground, none, none, ground, none, ground};
        for (int band = 0; band < bands.count; ++band) {
            const float* value = band_values(bands, pass.values, band) + i;
            m = add_block(add_block(m, load_block(value, apart)), load_block(value - bands.offset[band], apart));
        }
        if (pass.diagonal) store_diagonal(pass.diagonal + i, pass.padded, m);
        store_inverse(pass.inverse + i, pass.padded, m);
    }
}
