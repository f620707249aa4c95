// Packs: the contents of a vector register of PERCALE_PACK_BYTES bytes. Included by kernel_table.cpp only, inside an unnamed
// namespace: the same functions are compiled once per instruction set and must not be merged by the linker. For that reason
// nothing of the standard library is called here.

constexpr int pack_bytes = PERCALE_PACK_BYTES;
constexpr int float_lanes = pack_bytes / 4;
constexpr int double_lanes = pack_bytes / 8;

using FloatPack = float __attribute__((vector_size(PERCALE_PACK_BYTES)));
using DoublePack = double __attribute__((vector_size(PERCALE_PACK_BYTES)));
using FourFloats = float __attribute__((vector_size(16)));
using TwoDoubles = double __attribute__((vector_size(16)));
using FourDoubles = double __attribute__((vector_size(32)));
using EightFloats = float __attribute__((vector_size(32)));

/// As many doubles as a FloatPack has floats.
struct WidePack {
    DoublePack low, high;
};

template <class Pack, class Number>
PERCALE_INLINE Pack load(const Number* from) {
    Pack pack;
    __builtin_memcpy(&pack, from, sizeof(Pack));
    return pack;
}

template <class Pack, class Number>
PERCALE_INLINE void store(Number* to, Pack pack) {
    __builtin_memcpy(to, &pack, sizeof(Pack));
}

PERCALE_INLINE FloatPack all(float value) { return FloatPack{} + value; }
PERCALE_INLINE DoublePack all_double(double value) { return DoublePack{} + value; }
PERCALE_INLINE WidePack all_wide(double value) { return {all_double(value), all_double(value)}; }

PERCALE_INLINE WidePack operator+(WidePack a, WidePack b) { return {a.low + b.low, a.high + b.high}; }
PERCALE_INLINE WidePack operator-(WidePack a, WidePack b) { return {a.low - b.low, a.high - b.high}; }
PERCALE_INLINE WidePack operator*(WidePack a, WidePack b) { return {a.low * b.low, a.high * b.high}; }
PERCALE_INLINE WidePack operator/(WidePack a, WidePack b) { return {a.low / b.low, a.high / b.high}; }

PERCALE_INLINE WidePack load_wide(const double* from) { return {load<DoublePack>(from), load<DoublePack>(from + double_lanes)}; }
PERCALE_INLINE void store_wide(double* to, WidePack pack) {
    store(to, pack.low);
    store(to + double_lanes, pack.high);
}

PERCALE_INLINE WidePack larger(WidePack a, WidePack b) {
    return {a.low > b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
}
PERCALE_INLINE WidePack smaller(WidePack a, WidePack b) {
    return {a.low < b.low ? a.low : b.low, a.high < b.high ? a.high : b.high};
}
/// `yes` where a < b, `no` elsewhere.
PERCALE_INLINE WidePack where_less(WidePack a, WidePack b, WidePack yes, WidePack no) {
    return {a.low < b.low ? yes.low : no.low, a.high < b.high ? yes.high : no.high};
}

PERCALE_INLINE DoublePack root(DoublePack a) {
#if PERCALE_PACK_BYTES == 64
    return reinterpret_cast<DoublePack>(_mm512_maskz_sqrt_pd(0xff, reinterpret_cast<__m512d>(a)));
#elif PERCALE_PACK_BYTES == 32
    return reinterpret_cast<DoublePack>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(a)));
#elif defined(__SSE2__)
    return reinterpret_cast<DoublePack>(_mm_sqrt_pd(reinterpret_cast<__m128d>(a)));
#else
    DoublePack result;
    for (int lane = 0; lane < double_lanes; ++lane) result[lane] = __builtin_sqrt(a[lane]);
    return result;
#endif
}
PERCALE_INLINE WidePack root(WidePack a) { return {root(a.low), root(a.high)}; }

PERCALE_INLINE FloatPack root(FloatPack a) {
#if PERCALE_PACK_BYTES == 64
    return reinterpret_cast<FloatPack>(_mm512_maskz_sqrt_ps(0xffff, reinterpret_cast<__m512>(a)));
#elif PERCALE_PACK_BYTES == 32
    return reinterpret_cast<FloatPack>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a)));
#elif defined(__SSE2__)
    return reinterpret_cast<FloatPack>(_mm_sqrt_ps(reinterpret_cast<__m128>(a)));
#else
    FloatPack result;
    for (int lane = 0; lane < float_lanes; ++lane) result[lane] = __builtin_sqrtf(a[lane]);
    return result;
#endif
}

// g++ 12 converts halves of registers where these are written as conversions of vectors.
#if PERCALE_PACK_BYTES == 64

PERCALE_INLINE FloatPack narrow(WidePack a) {
    const auto half = [](DoublePack pack) {
        return reinterpret_cast<EightFloats>(_mm512_maskz_cvtpd_ps(0xff, reinterpret_cast<__m512d>(pack)));
    };
    const EightFloats low = half(a.low), high = half(a.high);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

PERCALE_INLINE WidePack widen(FloatPack a) {
    const EightFloats low = __builtin_shufflevector(a, a, 0, 1, 2, 3, 4, 5, 6, 7);
    const EightFloats high = __builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15);
    const auto half = [](EightFloats floats) {
        return reinterpret_cast<DoublePack>(_mm512_maskz_cvtps_pd(0xff, reinterpret_cast<__m256>(floats)));
    };
    return {half(low), half(high)};
}

PERCALE_INLINE FloatPack four_rows(const float* points, const int* index) {
    const auto pair = [&](int k) {
        return __builtin_shufflevector(load<FourFloats>(points + 4 * static_cast<std::size_t>(index[k])),
                                       load<FourFloats>(points + 4 * static_cast<std::size_t>(index[k + 4])), 0, 1, 2, 3, 4, 5, 6,
                                       7);
    };
    return __builtin_shufflevector(pair(0), pair(8), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

/// x, y and z of the points with the given numbers: rows of (x y z 0), transposed in registers.
PERCALE_INLINE void gather(const float* points, const int* index, FloatPack& x, FloatPack& y, FloatPack& z) {
    const FloatPack a = four_rows(points, index), b = four_rows(points, index + 1);
    const FloatPack c = four_rows(points, index + 2), d = four_rows(points, index + 3);
    const FloatPack ab = __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
    const FloatPack cd = __builtin_shufflevector(c, d, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
    const FloatPack ab_z = __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
    const FloatPack cd_z = __builtin_shufflevector(c, d, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
    x = __builtin_shufflevector(ab, cd, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
    y = __builtin_shufflevector(ab, cd, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
    z = __builtin_shufflevector(ab_z, cd_z, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
}

PERCALE_INLINE DoublePack two_rows(const double* points, const int* index) {
    return __builtin_shufflevector(load<FourDoubles>(points + 4 * static_cast<std::size_t>(index[0])),
                                   load<FourDoubles>(points + 4 * static_cast<std::size_t>(index[4])), 0, 1, 2, 3, 4, 5, 6, 7);
}

PERCALE_INLINE void gather(const double* points, const int* index, DoublePack& x, DoublePack& y, DoublePack& z) {
    const DoublePack a = two_rows(points, index), b = two_rows(points, index + 1);
    const DoublePack c = two_rows(points, index + 2), d = two_rows(points, index + 3);
    const DoublePack ab = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    const DoublePack cd = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
    const DoublePack ab_y = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    const DoublePack cd_y = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
    x = __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13);
    z = __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15);
    y = __builtin_shufflevector(ab_y, cd_y, 0, 1, 8, 9, 4, 5, 12, 13);
}

#elif PERCALE_PACK_BYTES == 32

PERCALE_INLINE FloatPack narrow(WidePack a) {
    const auto half = [](DoublePack pack) {
        return reinterpret_cast<FourFloats>(_mm256_cvtpd_ps(reinterpret_cast<__m256d>(pack)));
    };
    const FourFloats low = half(a.low), high = half(a.high);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

PERCALE_INLINE WidePack widen(FloatPack a) {
    const FourFloats low = __builtin_shufflevector(a, a, 0, 1, 2, 3), high = __builtin_shufflevector(a, a, 4, 5, 6, 7);
    const auto half = [](FourFloats floats) {
        return reinterpret_cast<DoublePack>(_mm256_cvtps_pd(reinterpret_cast<__m128>(floats)));
    };
    return {half(low), half(high)};
}

PERCALE_INLINE FloatPack two_rows(const float* points, const int* index) {
    return __builtin_shufflevector(load<FourFloats>(points + 4 * static_cast<std::size_t>(index[0])),
                                   load<FourFloats>(points + 4 * static_cast<std::size_t>(index[4])), 0, 1, 2, 3, 4, 5, 6, 7);
}

PERCALE_INLINE void gather(const float* points, const int* index, FloatPack& x, FloatPack& y, FloatPack& z) {
    const FloatPack a = two_rows(points, index), b = two_rows(points, index + 1);
    const FloatPack c = two_rows(points, index + 2), d = two_rows(points, index + 3);
    const FloatPack ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const FloatPack cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const FloatPack ab_z = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const FloatPack cd_z = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    x = __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13);
    y = __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15);
    z = __builtin_shufflevector(ab_z, cd_z, 0, 1, 8, 9, 4, 5, 12, 13);
}

PERCALE_INLINE void gather(const double* points, const int* index, DoublePack& x, DoublePack& y, DoublePack& z) {
    const auto row = [&](int k) { return load<FourDoubles>(points + 4 * static_cast<std::size_t>(index[k])); };
    const DoublePack a = row(0), b = row(1), c = row(2), d = row(3);
    const DoublePack ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const DoublePack ab_y = __builtin_shufflevector(a, b, 1, 5, 3, 7), cd_y = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    x = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
    z = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
    y = __builtin_shufflevector(ab_y, cd_y, 0, 1, 4, 5);
}

#else

PERCALE_INLINE FloatPack narrow(WidePack a) {
    return FloatPack{static_cast<float>(a.low[0]), static_cast<float>(a.low[1]), static_cast<float>(a.high[0]),
                     static_cast<float>(a.high[1])};
}

PERCALE_INLINE WidePack widen(FloatPack a) { return {DoublePack{a[0], a[1]}, DoublePack{a[2], a[3]}}; }

PERCALE_INLINE void gather(const float* points, const int* index, FloatPack& x, FloatPack& y, FloatPack& z) {
    const auto row = [&](int k) { return load<FourFloats>(points + 4 * static_cast<std::size_t>(index[k])); };
    const FloatPack a = row(0), b = row(1), c = row(2), d = row(3);
    const FloatPack ab = __builtin_shufflevector(a, b, 0, 4, 1, 5), cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const FloatPack ab_z = __builtin_shufflevector(a, b, 2, 6, 3, 7), cd_z = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    x = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
    y = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
    z = __builtin_shufflevector(ab_z, cd_z, 0, 1, 4, 5);
}

PERCALE_INLINE void gather(const double* points, const int* index, DoublePack& x, DoublePack& y, DoublePack& z) {
    const double* a = points + 4 * static_cast<std::size_t>(index[0]);
    const double* b = points + 4 * static_cast<std::size_t>(index[1]);
    const TwoDoubles low_a = load<TwoDoubles>(a), low_b = load<TwoDoubles>(b);
    x = __builtin_shufflevector(low_a, low_b, 0, 2);
    y = __builtin_shufflevector(low_a, low_b, 1, 3);
    z = DoublePack{a[2], b[2]};
}

#endif

struct FloatPoint {
    FloatPack x, y, z;
};
struct WidePoint {
    WidePack x, y, z;
};

PERCALE_INLINE FloatPoint gather_float(const float* points, const int* index) {
    FloatPoint result;
    gather(points, index, result.x, result.y, result.z);
    return result;
}

PERCALE_INLINE WidePoint gather_wide(const double* points, const int* index) {
    WidePoint result;
    gather(points, index, result.x.low, result.y.low, result.z.low);
    gather(points, index + double_lanes, result.x.high, result.y.high, result.z.high);
    return result;
}

PERCALE_INLINE WidePoint load_wide(ConstAxes from, std::size_t at) {
    return {load_wide(from.x + at), load_wide(from.y + at), load_wide(from.z + at)};
}
PERCALE_INLINE void store_wide(Axes to, std::size_t at, WidePoint p) {
    store_wide(to.x + at, p.x);
    store_wide(to.y + at, p.y);
    store_wide(to.z + at, p.z);
}
PERCALE_INLINE FloatPoint load_float(FloatVec3Arrays from, std::size_t at) {
    return {load<FloatPack>(from.data + at), load<FloatPack>(from.data + from.padded + at),
            load<FloatPack>(from.data + 2 * from.padded + at)};
}
PERCALE_INLINE void store_float(FloatVec3Arrays to, std::size_t at, FloatPoint p) {
    store(to.data + at, p.x);
    store(to.data + to.padded + at, p.y);
    store(to.data + 2 * to.padded + at, p.z);
}

PERCALE_INLINE WidePoint operator-(WidePoint a, WidePoint b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
PERCALE_INLINE WidePoint operator+(WidePoint a, WidePoint b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
PERCALE_INLINE WidePoint operator*(WidePack f, WidePoint a) { return {f * a.x, f * a.y, f * a.z}; }
PERCALE_INLINE WidePack dot(WidePoint a, WidePoint b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
PERCALE_INLINE FloatPoint operator-(FloatPoint a, FloatPoint b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
PERCALE_INLINE FloatPoint operator+(FloatPoint a, FloatPoint b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
PERCALE_INLINE FloatPoint operator*(FloatPack f, FloatPoint a) { return {f * a.x, f * a.y, f * a.z}; }

/// Sums of sixteen lanes whatever the width of a pack, so that their order is always the same.
struct LaneSums {
    double lane[slice_lanes] = {};
    PERCALE_INLINE void add(int first, WidePack value) { store_wide(lane + first, load_wide(lane + first) + value); }
    PERCALE_INLINE double total() const {
        double sum = 0.0;
        for (const double value : lane) sum += value;
        return sum;
    }
};
