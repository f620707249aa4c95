#include "springs.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace percale {
namespace {

/// Slices. Springs in bands are summed in chunks of this length: each begins with the springs of the guard before it once more.
/// Cost alone; the order of sums depends on it.
constexpr int band_chunk_slices = 128;

/// Squares of lengths that are smaller by this factor are smaller by more than rounding. Cost alone.
constexpr double strain_rounding = 1.0 - 1e-12;

double square_length(const SpringNetwork& network, const Vec3Arrays& x, int k) {
    const int i = network.first[k], j = network.second[k];
    const double dx = x.x[i] - x.x[j], dy = x.y[i] - x.y[j], dz = x.z[i] - x.z[j];
    return dx * dx + dy * dy + dz * dz;
}

double length(const SpringNetwork& network, const Vec3Arrays& x, int k) { return std::sqrt(square_length(network, x, k)); }

/// The first structural spring from number k on; the number of springs if there is none. Other kinds come in long runs.
int next_structural(const SpringNetwork& network, int k) {
    static_assert(sizeof(SpringKind) == 1);
    if (k < network.size() && network.kind[k] == SpringKind::structural) return k;
    const SpringKind* kinds = network.kind.data();
    const void* found = std::memchr(kinds + k, static_cast<int>(SpringKind::structural), network.kind.size() - k);
    return found ? static_cast<int>(static_cast<const SpringKind*>(found) - kinds) : network.size();
}

/// Copies all rest lengths and replaces those of seams: the model's stay as they are.
void set_seam_lengths(const SpringStart& start, StepSprings& springs) {
    const SpringNetwork& network = *start.network;
    springs.seam_rest_length = start.adjacency.rest_length;
    for (int k = 0; k < network.size(); ++k) {
        if (network.kind[k] != SpringKind::seam) continue;
        put_rest_length(start.adjacency, network, k, start.rest_length[k], springs.seam_rest_length);
    }
    springs.entries.rest_length = springs.seam_rest_length.data();
}

/// The blocks (a, w) before the first vertex are zero.
void clear_guards(const BandPattern& bands, AlignedVector<float>& values) {
    for (int array = 0; array < 4 * bands.count; ++array) {
        std::fill_n(values.begin() + array * (bands.guard + bands.padded), bands.guard, 0.0f);
    }
}

/// Adds the kinds of springs that a cloth lacks, and why.
void add_skips_of(const ClothFacts& cloth, std::vector<Skip>& skipped) {
    const SpringConstants& springs = cloth.fabric.springs;
    if (cloth.fabric.has_moduli()) {
        return skipped.push_back({"springs of " + cloth.name + " other than along edges", "stretch_stiffness is set"});
    }
    if (springs.structural == 0.0) skipped.push_back({"structural springs of " + cloth.name, "springs.structural is 0 N/m"});
    if (!cloth.grid) {
        skipped.push_back({"shear springs of " + cloth.name, "a free mesh has none"});
    } else if (springs.shear == 0.0) {
        skipped.push_back({"shear springs of " + cloth.name, "springs.shear is 0 N/m"});
    }
    if (springs.bend == 0.0) skipped.push_back({"bending springs of " + cloth.name, "springs.bend is 0 N/m"});
}

class Springs final : public ForceTerm {
public:
    std::string_view name() const override { return "springs"; }
    bool acts(const ForceInput&) const override { return true; }
    double add(const ForceInput& input, Forces& forces) const override {
        return evaluate_springs(*input.compute, *input.springs, {*input.positions, *input.velocities, input.dt},
                                input.with_matrix, forces.total, forces.spring_terms);
    }
    double StepEnergy::*entry() const override { return &StepEnergy::elastic; }
    double energy(const StoredInput& input) const override {
        return elastic_energy(input.model.springs, input.positions, input.rest_length);
    }

    /// Compressed springs are clamped to zero in the matrix.
    void mark_inexact(const ForceInput& input, const Forces&, double, std::vector<bool>& exact) const override {
        const SpringNetwork& network = input.model->springs;
        for (int k = 0; k < network.size(); ++k) {
            const int place = input.model->adjacency.place[k];
            const double length = (input.positions->at(network.first[k]) - input.positions->at(network.second[k])).norm();
            const bool pulls = length > input.springs->entries.rest_length[place];
            if (pulls || !(input.springs->entries.stiffness[place] > 0.0)) continue;
            exact[network.first[k]] = exact[network.second[k]] = false;
        }
    }

    void identify(const ClothModel& model, ListHash& hash) const override {
        const SpringNetwork& springs = model.springs;
        for (const auto* ends : {&springs.first, &springs.second}) hash.add_all(*ends);
        for (const auto* constants : {&springs.stiffness, &springs.damping}) hash.add_all(*constants);
        for (int k = 0; k < springs.size(); ++k) {
            hash.add(static_cast<int>(springs.kind[k]));
            if (springs.kind[k] != SpringKind::seam) hash.add(springs.rest_length[k]);
        }
    }

    void add_skips(const ForceFacts& facts, std::vector<Skip>& skipped) const override {
        for (const ClothFacts& cloth : facts.cloths) add_skips_of(cloth, skipped);
        if (!facts.seams) skipped.push_back({"closing of seams", "the scene has no seam"});
    }
};

}  // namespace

const ForceTerm& spring_term() {
    static const Springs term;
    return term;
}

void set_step_springs(const Compute& compute, const SpringStart& start, StepSprings& springs) {
    const Adjacency& adjacency = start.adjacency;
    springs.adjacency = &adjacency;
    springs.entries = adjacency.springs();
    if (!start.rest_length.empty()) set_seam_lengths(start, springs);
    springs.undamped_rest_length = springs.entries.rest_length;
    springs.velocity_damping = adjacency.damped && start.form == DampingForm::velocity;
    if (!adjacency.damped || start.form == DampingForm::velocity) return;
    springs.stiffness.resize(adjacency.stiffness.size());
    springs.rest_length.resize(adjacency.stiffness.size());
    pack_points(compute, adjacency, start.positions, springs.points);
    const StartPass pass{.springs = springs.entries,
                         .positions = start.positions.axes(),
                         .points = springs.points.data(),
                         .dt = start.dt,
                         .stiffness = springs.stiffness.data(),
                         .rest = springs.rest_length.data()};
    for_chunks(compute, adjacency.slices(), [&](Slices range) { compute.kernels->start_springs(pass, range); });
    springs.entries.stiffness = springs.stiffness.data();
    springs.entries.rest_length = springs.rest_length.data();
}

double evaluate_springs(const Compute& compute, const StepSprings& springs, const SpringMotion& motion, bool with_matrix,
                        Vec3Arrays& forces, SpringTerms& terms) {
    const Adjacency& adjacency = *springs.adjacency;
    pack_points(compute, adjacency, motion.positions, terms.points);
    if (springs.velocity_damping) pack_points(compute, adjacency, motion.velocities, terms.motion);
    const int slices = motion.positions.slices();
    if (with_matrix && terms.values.size() != adjacency.value_count()) terms.values.assign(adjacency.value_count(), 0.0f);
    const BandPattern& bands = adjacency.bands;
    if (with_matrix) clear_guards(bands, terms.values);
    const int grain = bands.count > 0 ? band_chunk_slices : chunk_slices;
    const std::size_t scratch = 3 * bands.count * (bands.guard + std::min(slices, grain) * slice_lanes);
    terms.scratch.resize(scratch * compute.threads());
    const SpringPass pass{.springs = springs.entries,
                          .positions = motion.positions.axes(),
                          .velocities = motion.velocities.axes(),
                          .points = terms.points.data(),
                          .motion = springs.velocity_damping ? terms.motion.data() : nullptr,
                          .dt = motion.dt,
                          .forces = forces.axes(),
                          .values = with_matrix ? terms.values.data() : nullptr,
                          .scratch = nullptr};
    return sum_stretches(compute, slices, grain, [&](Slices range, int thread) {
        SpringPass own = pass;
        own.scratch = terms.scratch.data() + thread * scratch;
        return compute.kernels->springs(own, range);
    });
}

SpringBlock spring_block(const Adjacency& adjacency, const SpringTerms& terms, int spring) {
    const auto [first, apart] = adjacency.value_place(spring);
    const float* value = &terms.values[first];
    return {value[0], Vec3(value[apart], value[2 * apart], value[3 * apart])};
}

double elastic_energy(const SpringNetwork& network, const Vec3Arrays& positions, std::span<const double> rest_length) {
    const std::span<const double> rest = rest_lengths(network, rest_length);
    return 0.5 * sum_terms(0, network.size(), [&](int k) {
               const double stretch = length(network, positions, k) - rest[k];
               return network.stiffness[k] * stretch * stretch;
           });
}

double largest_strain(const SpringNetwork& network, const Vec3Arrays& positions) {
    return largest_strain(network, positions, 0, std::numeric_limits<int>::max());
}

double largest_strain(const SpringNetwork& network, const Vec3Arrays& positions, int first, int count) {
    // The squares of most springs, with an allowance for rounding, show that they are not the largest.
    double largest = 0.0, square_below = strain_rounding;
    for (int k = next_structural(network, 0); k < network.size(); k = next_structural(network, k + 1)) {
        const double rest = network.rest_length[k], square = square_length(network, positions, k);
        if (square <= square_below * (rest * rest)) continue;
        if (network.first[k] < first || network.first[k] - first >= count) continue;
        largest = std::max(largest, std::sqrt(square) / rest - 1.0);
        square_below = strain_rounding * (1.0 + largest) * (1.0 + largest);
    }
    return largest;
}

}  // namespace percale
