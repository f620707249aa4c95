// Products with the step matrix. Springs act on differences x_i - x_j, so a common motion of all vertices costs no accuracy,
// whatever the stiffness.

double multiply_slices(const BlockPass& pass, ConstAxes x, const double* points, const double* free, Axes y, Slices range) {
    LaneSums sums;
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const WidePoint own = load_wide(x, at);
            WidePoint result = load_wide(pass.ground + at) * own;
            for (int e = pass.pattern.start[s] + lane; e < pass.pattern.start[s + 1]; e += slice_lanes) {
                const WidePoint d = own - gather_wide(points, pass.pattern.other + e);
                const float* value = pass.values + 4 * static_cast<std::size_t>(e - lane) + lane;
                const WidePack a = widen(load<FloatPack>(value));
                const WidePoint w{widen(load<FloatPack>(value + slice_lanes)), widen(load<FloatPack>(value + 2 * slice_lanes)),
                                  widen(load<FloatPack>(value + 3 * slice_lanes))};
                result = result + a * d + dot(w, d) * w;
            }
            result = load_wide(free + at) * result;
            sums.add(lane, dot(own, result));
            store_wide(y, at, result);
        }
    }
    return sums.total();
}

/// y = sum, or b - sum.
PERCALE_INLINE void store_product(const FloatPass& pass, std::size_t at, FloatPoint sum) {
    if (pass.right) {
        const FloatVec3Arrays right{const_cast<float*>(pass.right), pass.y.padded};
        sum = load_float(right, at) - sum;
    }
    store_float(pass.y, at, sum);
}

void multiply_fine_slices(const FloatPass& pass, Slices range) {
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const FloatPoint own = load_float(pass.x, at);
            FloatPoint result = load<FloatPack>(pass.ground + at) * own;
            for (int e = pass.pattern.start[s] + lane; e < pass.pattern.start[s + 1]; e += slice_lanes) {
                const FloatPoint d = own - gather_float(pass.points, pass.pattern.other + e);
                const float* value = pass.values + 4 * static_cast<std::size_t>(e - lane) + lane;
                const FloatPoint w{load<FloatPack>(value + slice_lanes), load<FloatPack>(value + 2 * slice_lanes),
                                   load<FloatPack>(value + 3 * slice_lanes)};
                const FloatPack along = w.x * d.x + w.y * d.y + w.z * d.z;
                result = result + load<FloatPack>(value) * d + along * w;
            }
            store_product(pass, at, result);
        }
    }
}

/// A symmetric block xx xy xz yy yz zz times a vector.
PERCALE_INLINE FloatPoint block_times(const float* block, std::size_t apart, FloatPoint d) {
    const FloatPack xy = load<FloatPack>(block + apart), xz = load<FloatPack>(block + 2 * apart);
    const FloatPack yz = load<FloatPack>(block + 4 * apart);
    return {load<FloatPack>(block) * d.x + xy * d.y + xz * d.z, xy * d.x + load<FloatPack>(block + 3 * apart) * d.y + yz * d.z,
            xz * d.x + yz * d.y + load<FloatPack>(block + 5 * apart) * d.z};
}

void multiply_coarse(const FloatPass& pass, Slices range) {
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const FloatPoint own = load_float(pass.x, at);
            FloatPoint result = block_times(pass.ground + at, pass.x.padded, own);
            for (int e = pass.pattern.start[s] + lane; e < pass.pattern.start[s + 1]; e += slice_lanes) {
                const FloatPoint d = own - gather_float(pass.points, pass.pattern.other + e);
                result = result + block_times(pass.values + 6 * static_cast<std::size_t>(e - lane) + lane, slice_lanes, d);
            }
            store_product(pass, at, result);
        }
    }
}

void smooth(const SmoothPass& pass, Slices range) {
    const FloatPack factor = all(pass.factor);
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const FloatPoint change = factor * block_times(pass.inverse + at, pass.r.padded, load_float(pass.r, at));
            store_float(pass.x, at, pass.fresh ? change : load_float(pass.x, at) + change);
        }
    }
}

void transfer(const TransferPass& pass, Slices range) {
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            FloatPoint result{all(0.0f), all(0.0f), all(0.0f)};
            if (pass.add) result = load_float(pass.y, at);
            for (int e = pass.pattern.start[s] + lane; e < pass.pattern.start[s + 1]; e += slice_lanes) {
                result = result + load<FloatPack>(pass.weights + e) * gather_float(pass.points, pass.pattern.other + e);
            }
            store_float(pass.y, at, result);
        }
    }
}
