#include "membrane_springs.h"

namespace percale {
namespace {

class MembraneSprings final : public ForceTerm {
public:
    std::string_view name() const override { return "membrane"; }
    bool acts(const ForceInput& input) const override { return !input.model->membrane.empty(); }
    double add(const ForceInput& input, Forces& forces) const override {
        return evaluate_membrane(*input.compute, input.model->adjacency, {*input.positions, *input.velocities, input.dt},
                                 input.with_matrix, forces.total, forces.spring_terms);
    }
    double StepEnergy::*entry() const override { return &StepEnergy::elastic; }
    double energy(const StoredInput& input) const override { return membrane_energy(input.model.membrane, input.positions); }

    /// Sets the forces of the edges' springs to zero.
    void stand_alone(const ForceInput& input, Forces& forces) const override {
        const Adjacency& adjacency = input.model->adjacency;
        pack_points(*input.compute, adjacency, *input.positions, forces.spring_terms.points);
        if (input.with_matrix) forces.spring_terms.values.assign(adjacency.value_count(), 0.0f);
    }

    /// Edges that push are clamped to zero in the matrix.
    void mark_inexact(const ForceInput& input, const Forces& forces, double, std::vector<bool>& exact) const override {
        const SpringNetwork& network = input.model->springs;
        for (int k = 0; k < network.size(); ++k) {
            const SpringBlock block = spring_block(input.model->adjacency, forces.spring_terms, k);
            if (block.a == 0.0 && block.w != Vec3::Zero()) exact[network.first[k]] = exact[network.second[k]] = false;
        }
    }

    void identify(const ClothModel& model, ListHash& hash) const override {
        for (const MembraneTriangle& t : model.membrane) {
            hash.add(t.vertex);
            hash.add(t.rest_square);
            hash.add_all(std::span<const double>(t.stiffness.data(), 9));
        }
    }

    void add_skips(const ForceFacts& facts, std::vector<Skip>& skipped) const override {
        for (const ClothFacts& cloth : facts.cloths) {
            if (cloth.fabric.has_moduli() && cloth.fabric.membrane == Membrane::triangle_springs) continue;
            skipped.push_back({"triangle springs of " + cloth.name,
                               cloth.fabric.has_moduli() ? "membrane is van_gelder" : "stretch_stiffness is not set"});
        }
    }
};

}  // namespace

const ForceTerm& membrane_term() {
    static const MembraneSprings term;
    return term;
}

double evaluate_membrane(const Compute& compute, const Adjacency& adjacency, const SpringMotion& motion, bool with_matrix,
                         Vec3Arrays& forces, SpringTerms& terms) {
    const MembraneEntries& membrane = adjacency.membrane;
    const MembranePass pass{.pattern = adjacency.pattern(),
                            .edges = membrane.edges(),
                            .positions = motion.positions.axes(),
                            .points = terms.points.data(),
                            .dt = motion.dt,
                            .forces = forces.axes(),
                            .values = with_matrix ? terms.values.data() : nullptr};
    const double energy =
        sum_chunks(compute, adjacency.slices(), [&](Slices range) { return compute.kernels->membrane(pass, range); });
    if (!with_matrix) return energy;
    terms.corners.resize(corner_values * membrane.corner_count());
    const CornerFillPass fill{.corners = membrane.corners(),
                              .positions = motion.positions.axes(),
                              .points = terms.points.data(),
                              .dt = motion.dt,
                              .values = terms.corners.data()};
    for_chunks(compute, adjacency.slices(), [&](Slices range) { compute.kernels->fill_corners(fill, range); });
    return energy;
}

double membrane_energy(const std::vector<MembraneTriangle>& triangles, const Vec3Arrays& positions) {
    return 0.5 * sum_terms(0, static_cast<int>(triangles.size()), [&](int k) {
               const MembraneTriangle& t = triangles[k];
               Vec3 s;
               for (int e = 0; e < 3; ++e) {
                   const Vec3 edge = positions.at(t.vertex[(e + 1) % 3]) - positions.at(t.vertex[(e + 2) % 3]);
                   s[e] = edge.squaredNorm() - t.rest_square[e];
               }
               return s.dot(t.stiffness * s);
           });
}

}  // namespace percale
