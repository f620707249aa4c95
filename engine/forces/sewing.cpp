#include "sewing.h"

#include "springs.h"

namespace percale {
namespace {

class Sewing final : public ForceTerm {
public:
    std::string_view name() const override { return "sewing"; }
    bool acts(const ForceInput& input) const override { return !input.model->sewn_points.empty(); }

    double add(const ForceInput& input, Forces& forces) const override {
        double potential = 0.0;
        for (const SewnPoint& point : input.model->sewn_points) {
            const double length = input.springs->undamped_rest_length[input.model->adjacency.place[point.spring]];
            if (length == 0.0) continue;
            const auto& [vertex, from, to, share] = point.stitch;
            const Vec3 load = point.stiffness * length * point.direction;
            forces.total.add(vertex, load);
            forces.total.add(from, -(1.0 - share) * load);
            forces.total.add(to, -share * load);
            potential += 0.5 * load.dot(length * point.direction) - load.dot(sewn_gap(point, *input.positions));
        }
        return potential;
    }

    double StepEnergy::*entry() const override { return &StepEnergy::elastic; }
    double energy(const StoredInput& input) const override {
        const std::span<const double> lengths = rest_lengths(input.model.springs, input.rest_length);
        double energy = 0.0;
        for (const SewnPoint& point : input.model.sewn_points) {
            energy += sewn_energy(point, lengths[point.spring], input.positions);
        }
        return energy;
    }

    bool is_internal() const override { return false; }
    bool is_in_matrix() const override { return false; }

    void identify(const ClothModel& model, ListHash& hash) const override {
        for (const auto& [stitch, stiffness, direction, spring, pair] : model.sewn_points) {
            for (const int vertex : {stitch.vertex, stitch.from, stitch.to, spring}) hash.add(vertex);
            for (const double number : {stitch.share, stiffness}) hash.add(number);
        }
    }
};

class Welding final : public ForceTerm {
public:
    std::string_view name() const override { return "welding"; }
    bool acts(const ForceInput& input) const override { return !input.model->welds.empty(); }

    double add(const ForceInput& input, Forces& forces) const override {
        for (const auto& [stitch, stiffness, hold] : input.model->welds) {
            forces.total.add(stitch.vertex, -hold);
            forces.total.add(stitch.from, (1.0 - stitch.share) * hold);
            forces.total.add(stitch.to, stitch.share * hold);
        }
        return weld_energy(input.model->welds, *input.positions);
    }

    double StepEnergy::*entry() const override { return &StepEnergy::elastic; }
    double energy(const StoredInput& input) const override { return weld_energy(input.model.welds, input.positions); }

    bool is_internal() const override { return false; }  // an open gap may turn the cloth
    bool is_in_matrix() const override { return false; }

    void identify(const ClothModel& model, ListHash& hash) const override {
        for (const auto& [stitch, stiffness, hold] : model.welds) {
            for (const int vertex : {stitch.vertex, stitch.from, stitch.to}) hash.add(vertex);
            for (const double number : {stitch.share, stiffness}) hash.add(number);
        }
    }
};

}  // namespace

const ForceTerm& sewing_term() {
    static const Sewing term;
    return term;
}

const ForceTerm& welding_term() {
    static const Welding term;
    return term;
}

}  // namespace percale
