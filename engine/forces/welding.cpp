#include "welding.h"

namespace percale {
namespace {

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

    bool is_internal() const override { return false; }  // a gap that is not closed yet may turn the cloth
    bool is_in_matrix() const override { return false; }

    void identify(const ClothModel& model, ListHash& hash) const override {
        for (const auto& [stitch, stiffness, hold] : model.welds) {
            for (const int vertex : {stitch.vertex, stitch.from, stitch.to}) hash.add(vertex);
            for (const double number : {stitch.share, stiffness}) hash.add(number);
        }
    }
};

}  // namespace

const ForceTerm& welding_term() {
    static const Welding term;
    return term;
}

}  // namespace percale
