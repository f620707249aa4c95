// The same work on springs in bands or in slices.

void start_springs(const StartPass& pass, Slices range) {
    pass.springs.pattern.bands ? start_bands(pass, range) : start_slices(pass, range);
}

template <bool with_matrix, bool with_motion>
double all_springs(const SpringPass& pass, Slices range) {
    constexpr SpringParts alone{with_matrix, with_motion, false}, bending{with_matrix, with_motion, true};
    if (pass.springs.bending) {
        return pass.springs.pattern.bands ? band_springs<bending>(pass, range) : spring_slices<bending>(pass, range);
    }
    return pass.springs.pattern.bands ? band_springs<alone>(pass, range) : spring_slices<alone>(pass, range);
}

double springs(const SpringPass& pass, Slices range) {
    if (pass.values) return pass.motion ? all_springs<true, true>(pass, range) : all_springs<true, false>(pass, range);
    return pass.motion ? all_springs<false, true>(pass, range) : all_springs<false, false>(pass, range);
}

double multiply(const BlockPass& pass, ConstAxes x, const double* points, const double* free, Axes y, Slices range) {
    return pass.pattern.bands ? multiply_bands(pass, points, free, y, range) : multiply_slices(pass, x, points, free, y, range);
}

void multiply_fine(const FloatPass& pass, Slices range) {
    pass.pattern.bands ? multiply_fine_bands(pass, range) : multiply_fine_slices(pass, range);
}

void fine_diagonal(const DiagonalPass& pass, Slices range) {
    pass.pattern.bands ? band_diagonal(pass, range) : slice_diagonal(pass, range);
}
