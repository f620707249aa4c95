// Diagonal blocks, their inverses, the sums of coarser levels and the dense solve at the bottom.

struct WideBlock {
    WidePack xx, xy, xz, yy, yz, zz;
};

/// Inverse of a symmetric positive definite block by cofactors.
PERCALE_INLINE void store_inverse(float* inverse, std::size_t apart, WideBlock m) {
    const WidePack xx = m.yy * m.zz - m.yz * m.yz, xy = m.xz * m.yz - m.xy * m.zz, xz = m.xy * m.yz - m.xz * m.yy;
    const WidePack determinant = m.xx * xx + m.xy * xy + m.xz * xz;
    const WidePack scale{all_double(1.0) / determinant.low, all_double(1.0) / determinant.high};
    store(inverse, narrow(scale * xx));
    store(inverse + apart, narrow(scale * xy));
    store(inverse + 2 * apart, narrow(scale * xz));
    store(inverse + 3 * apart, narrow(scale * (m.xx * m.zz - m.xz * m.xz)));
    store(inverse + 4 * apart, narrow(scale * (m.xy * m.xz - m.xx * m.yz)));
    store(inverse + 5 * apart, narrow(scale * (m.xx * m.yy - m.xy * m.xy)));
}

PERCALE_INLINE void store_diagonal(double* diagonal, std::size_t apart, WideBlock m) {
    store_wide(diagonal, m.xx);
    store_wide(diagonal + apart, m.xy);
    store_wide(diagonal + 2 * apart, m.xz);
    store_wide(diagonal + 3 * apart, m.yy);
    store_wide(diagonal + 4 * apart, m.yz);
    store_wide(diagonal + 5 * apart, m.zz);
}

void slice_diagonal(const DiagonalPass& pass, Slices range) {
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const WidePack ground = load_wide(pass.ground + at), none = all_wide(0.0);
            WideBlock m{ground, none, none, ground, none, ground};
            for (int e = pass.pattern.start[s] + lane; e < pass.pattern.start[s + 1]; e += slice_lanes) {
                const float* value = pass.values + 4 * static_cast<std::size_t>(e - lane) + lane;
                const WidePack a = widen(load<FloatPack>(value)), x = widen(load<FloatPack>(value + slice_lanes));
                const WidePack y = widen(load<FloatPack>(value + 2 * slice_lanes));
                const WidePack z = widen(load<FloatPack>(value + 3 * slice_lanes));
                m = {m.xx + a + x * x, m.xy + x * y, m.xz + x * z, m.yy + a + y * y, m.yz + y * z, m.zz + a + z * z};
            }
            if (pass.diagonal) store_diagonal(pass.diagonal + at, pass.padded, m);
            store_inverse(pass.inverse + at, pass.padded, m);
        }
    }
}

void coarse_diagonal(const DiagonalPass& pass, Slices range) {
    for (int s = range.first; s < range.last; ++s) {
        for (int lane = 0; lane < slice_lanes; lane += float_lanes) {
            const std::size_t at = static_cast<std::size_t>(s) * slice_lanes + lane;
            const auto block = [](const float* from, std::size_t apart) {
                return WideBlock{widen(load<FloatPack>(from)),
                                 widen(load<FloatPack>(from + apart)),
                                 widen(load<FloatPack>(from + 2 * apart)),
                                 widen(load<FloatPack>(from + 3 * apart)),
                                 widen(load<FloatPack>(from + 4 * apart)),
                                 widen(load<FloatPack>(from + 5 * apart))};
            };
            WideBlock m = block(pass.blocks + at, pass.padded);
            for (int e = pass.pattern.start[s] + lane; e < pass.pattern.start[s + 1]; e += slice_lanes) {
                const WideBlock b = block(pass.values + 6 * static_cast<std::size_t>(e - lane) + lane, slice_lanes);
                m = {m.xx + b.xx, m.xy + b.xy, m.xz + b.xz, m.yy + b.yy, m.yz + b.yz, m.zz + b.zz};
            }
            store_inverse(pass.inverse + at, pass.padded, m);
        }
    }
}

void galerkin(const GalerkinPass& pass, int first, int last) {
    for (int e = first; e < last; ++e) {
        FourFloats low{}, high{};
        for (int k = pass.start[e]; k < pass.start[e + 1]; ++k) {
            const float* block = pass.fine + 8 * static_cast<std::size_t>(pass.pair[k]);
            low += pass.coefficient[k] * load<FourFloats>(block);
            high += pass.coefficient[k] * load<FourFloats>(block + 4);
        }
        store(pass.coarse + 8 * static_cast<std::size_t>(e), low);
        store(pass.coarse + 8 * static_cast<std::size_t>(e) + 4, high);
    }
}

/// row -= factor * other, whole packs.
PERCALE_INLINE void subtract_row(double* row, double factor, const double* other, int stride) {
    const DoublePack f = all_double(factor);
    for (int k = 0; k < stride; k += double_lanes) {
        store(row + k, load<DoublePack>(row + k) - f * load<DoublePack>(other + k));
    }
}

/// Gauss-Jordan elimination without pivoting, which a positive definite matrix allows.
void invert(double* matrix, int size, int stride) {
    for (int pivot = 0; pivot < size; ++pivot) {
        double* row = matrix + static_cast<std::size_t>(pivot) * stride;
        const double inverse = 1.0 / row[pivot];
        row[pivot] = 1.0;
        for (int k = 0; k < stride; ++k) row[k] *= inverse;
        for (int other = 0; other < size; ++other) {
            if (other == pivot) continue;
            double* target = matrix + static_cast<std::size_t>(other) * stride;
            const double factor = target[pivot];
            target[pivot] = 0.0;
            subtract_row(target, factor, row, stride);
        }
    }
}

/// y = A x; A is symmetric, so its rows are its columns.
void dense_multiply(const float* matrix, int size, int stride, const float* x, float* y) {
    for (int k = 0; k < stride; k += float_lanes) {
        FloatPack sum = all(0.0f);
        for (int column = 0; column < size; ++column) {
            sum += x[column] * load<FloatPack>(matrix + static_cast<std::size_t>(column) * stride + k);
        }
        store(y + k, sum);
    }
}
