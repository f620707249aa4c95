#include "strain_limit.h"

#include <algorithm>
#include <cmath>

namespace percale {
namespace {

/// Multiple of the displacement by which derivatives are checked (settings.check_derivatives): how near the kinks of strain
/// limits a vertex is left out. Smaller: right forces are found wrong. Larger: wrong ones pass.
constexpr double limit_kink_reaches = 4.0;

class StrainLimitTerm final : public ForceTerm {
public:
    std::string_view name() const override { return "strain_limit"; }
    bool acts(const ForceInput& input) const override { return !input.model->limits.empty(); }
    double add(const ForceInput& input, Forces& forces) const override {
        return evaluate_limits(*input.compute, *input.model, {*input.positions, *input.velocities, input.dt}, input.with_matrix,
                               forces.total, forces.spring_terms);
    }
    double StepEnergy::*entry() const override { return &StepEnergy::elastic; }
    double energy(const StoredInput& input) const override {
        return limit_energy(input.model.limits, input.model.springs, input.positions);
    }

    /// Sets the forces of springs to zero.
    void stand_alone(const ForceInput& input, Forces& forces) const override {
        const Adjacency& adjacency = input.model->adjacency;
        pack_points(*input.compute, adjacency, *input.positions, forces.spring_terms.points);
        if (input.with_matrix) forces.spring_terms.values.assign(adjacency.value_count(), 0.0f);
    }

    bool may_be_below() const override { return true; }
    /// Edges about to pull, or about to stop pulling, have a kink.
    void mark_inexact(const ForceInput& input, const Forces&, double reach, std::vector<bool>& exact) const override {
        const SpringNetwork& network = input.model->springs;
        for (const LimitedEdge& edge : input.model->limits.edges) {
            const int first = network.first[edge.spring], second = network.second[edge.spring];
            const double length = (input.positions->at(first) - input.positions->at(second)).norm();
            const double past = length - edge.length + edge.hold / edge.stiffness;
            if (std::abs(past) < limit_kink_reaches * reach) exact[first] = exact[second] = false;
        }
    }

    void identify(const ClothModel& model, ListHash& hash) const override {
        for (const LimitedEdge& edge : model.limits.edges) {
            hash.add(edge.spring);
            for (const double number : {edge.length, edge.stiffness, edge.max_hold}) hash.add(number);
        }
    }

    void add_skips(const ForceFacts& facts, std::vector<Skip>& skipped) const override {
        for (const ClothFacts& cloth : facts.cloths) {
            if (!cloth.fabric.strain_limit) skipped.push_back({"strain limit of " + cloth.name, "strain_limit is not set"});
        }
    }
};

}  // namespace

const ForceTerm& strain_limit_term() {
    static const StrainLimitTerm term;
    return term;
}

double evaluate_limits(const Compute& compute, const ClothModel& model, const SpringMotion& motion, bool with_matrix,
                       Vec3Arrays& forces, SpringTerms& terms) {
    const LimitPass pass{.pattern = model.adjacency.pattern(),
                         .limits = model.limits.entries(),
                         .positions = motion.positions.axes(),
                         .points = terms.points.data(),
                         .dt = motion.dt,
                         .forces = forces.axes(),
                         .values = with_matrix ? terms.values.data() : nullptr};
    return sum_chunks(compute, model.adjacency.slices(), [&](Slices range) { return compute.kernels->limits(pass, range); });
}

}  // namespace percale
