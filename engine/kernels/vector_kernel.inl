// Vectors of the linear solve.

void pack_points(ConstAxes from, double* points, Slices range) {
    for (std::size_t i = static_cast<std::size_t>(range.first) * slice_lanes;
         i < static_cast<std::size_t>(range.last) * slice_lanes; ++i) {
        store(points + 4 * i, FourDoubles{from.x[i], from.y[i], from.z[i], 0.0});
    }
}

void pack_float_points(FloatVec3Arrays from, float* points, Slices range) {
    for (std::size_t i = static_cast<std::size_t>(range.first) * slice_lanes;
         i < static_cast<std::size_t>(range.last) * slice_lanes; i += 4) {
        const FourFloats x = load<FourFloats>(from.data + i), y = load<FourFloats>(from.data + from.padded + i);
        const FourFloats z = load<FourFloats>(from.data + 2 * from.padded + i), none{};
        const FourFloats xy = __builtin_shufflevector(x, y, 0, 4, 1, 5), xy_high = __builtin_shufflevector(x, y, 2, 6, 3, 7);
        const FourFloats zw = __builtin_shufflevector(z, none, 0, 4, 1, 5),
                         zw_high = __builtin_shufflevector(z, none, 2, 6, 3, 7);
        store(points + 4 * i, __builtin_shufflevector(xy, zw, 0, 1, 4, 5));
        store(points + 4 * i + 4, __builtin_shufflevector(xy, zw, 2, 3, 6, 7));
        store(points + 4 * i + 8, __builtin_shufflevector(xy_high, zw_high, 0, 1, 4, 5));
        store(points + 4 * i + 12, __builtin_shufflevector(xy_high, zw_high, 2, 3, 6, 7));
    }
}

/// body(place, first lane of the slice) for every pack of the range.
template <class Body>
PERCALE_INLINE void for_packs(Slices range, Body body) {
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) body(static_cast<std::size_t>(s) * slice_lanes + lane, lane);
    }
}

double dot_range(ConstAxes a, ConstAxes b, Slices range) {
    LaneSums sums;
    for_packs(range, [&](std::size_t at, int lane) { sums.add(lane, dot(load_wide(a, at), load_wide(b, at))); });
    return sums.total();
}

double advance(double alpha, ConstAxes p, ConstAxes q, Axes x, Axes r, Slices range) {
    LaneSums sums;
    const WidePack factor = all_wide(alpha);
    for_packs(range, [&](std::size_t at, int lane) {
        store_wide(x, at, load_wide(x, at) + factor * load_wide(p, at));
        const WidePoint residual = load_wide(r, at) - factor * load_wide(q, at);
        store_wide(r, at, residual);
        sums.add(lane, dot(residual, residual));
    });
    return sums.total();
}

void turn(double beta, ConstAxes z, Axes p, Slices range) {
    const WidePack factor = all_wide(beta);
    for_packs(range, [&](std::size_t at, int) { store_wide(p, at, load_wide(z, at) + factor * load_wide(p, at)); });
}

void jacobi(const float* inverse, std::size_t padded, ConstAxes r, Axes z, Slices range) {
    for_packs(range, [&](std::size_t at, int) {
        const WidePoint v = load_wide(r, at);
        const auto entry = [&](int k) { return widen(load<FloatPack>(inverse + k * padded + at)); };
        const WidePack xy = entry(1), xz = entry(2), yz = entry(4);
        store_wide(
            z, at,
            {entry(0) * v.x + xy * v.y + xz * v.z, xy * v.x + entry(3) * v.y + yz * v.z, xz * v.x + yz * v.y + entry(5) * v.z});
    });
}

void to_float(double scale, ConstAxes from, FloatVec3Arrays to, Slices range) {
    const WidePack factor = all_wide(scale);
    for_packs(range, [&](std::size_t at, int) {
        const WidePoint v = factor * load_wide(from, at);
        store_float(to, at, {narrow(v.x), narrow(v.y), narrow(v.z)});
    });
}

void add_float(double scale, FloatVec3Arrays from, Axes to, Slices range) {
    const WidePack factor = all_wide(scale);
    for_packs(range, [&](std::size_t at, int) {
        const FloatPoint v = load_float(from, at);
        store_wide(to, at, load_wide(to, at) + factor * WidePoint{widen(v.x), widen(v.y), widen(v.z)});
    });
}

PERCALE_INLINE FloatPack dot(FloatPoint a, FloatPoint b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

double float_dot(FloatVec3Arrays a, FloatVec3Arrays b, Slices range) {
    LaneSums sums;
    for_packs(range, [&](std::size_t at, int lane) { sums.add(lane, widen(dot(load_float(a, at), load_float(b, at)))); });
    return sums.total();
}

double float_advance(float alpha, FloatVec3Arrays p, FloatVec3Arrays q, FloatVec3Arrays x, FloatVec3Arrays r, Slices range) {
    LaneSums sums;
    const FloatPack factor = all(alpha);
    for_packs(range, [&](std::size_t at, int lane) {
        store_float(x, at, load_float(x, at) + factor * load_float(p, at));
        const FloatPoint residual = load_float(r, at) - factor * load_float(q, at);
        store_float(r, at, residual);
        sums.add(lane, widen(dot(residual, residual)));
    });
    return sums.total();
}

void float_turn(float beta, FloatVec3Arrays z, FloatVec3Arrays p, Slices range) {
    const FloatPack factor = all(beta);
    for_packs(range, [&](std::size_t at, int) { store_float(p, at, load_float(z, at) + factor * load_float(p, at)); });
}
