#include "pressure.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace percale {
namespace {

/// Pa, of the air around the cloth (the standard atmosphere at sea level), which compresses an amount of gas. Larger: cloth that
/// encloses gas is stiffer against a change of its volume.
constexpr double air_pressure = 101325.0;

bool is_filled(const Fabric& fabric) { return fabric.pressure || fabric.gas_volume; }

class Pressure final : public ForceTerm {
public:
    std::string_view name() const override { return "pressure"; }
    bool acts(const ForceInput& input) const override {
        return std::ranges::any_of(input.model->cloths, [](const ClothRange& cloth) { return is_filled(cloth.fabric); });
    }

    double add(const ForceInput& input, Forces& forces) const override {
        std::size_t count = 0;
        double energy = 0.0;
        for (const ClothRange& cloth : input.model->cloths) {
            if (!is_filled(cloth.fabric)) continue;
            if (count == forces.pressure_blocks.size())
                forces.pressure_blocks.emplace_back();  // kept from one evaluation to the next
            PressureBlock& block = forces.pressure_blocks[count++];
            const GasState gas_state = gas_state_at(cloth.fabric, volume_of(*input.model, cloth, *input.positions));
            set_volume_gradient(*input.model, cloth, *input.positions, block.gradient);
            block.stiffness = input.dt * input.dt * gas_state.stiffness;
            block.load = input.dt * input.dt * gas_state.pressure;
            block.triangles = triangles_of(*input.model, cloth);
            add_scaled(forces.total, gas_state.pressure, block.gradient);
            energy += gas_state.energy;
        }
        return energy;
    }

    double StepEnergy::*entry() const override { return &StepEnergy::elastic; }
    double energy(const StoredInput& input) const override {
        double energy = 0.0;
        for (const ClothRange& cloth : input.model.cloths) {
            if (is_filled(cloth.fabric))
                energy += gas_state_at(cloth.fabric, volume_of(input.model, cloth, input.positions)).energy;
        }
        return energy;
    }

    void identify(const ClothModel& model, ListHash& hash) const override {
        for (const ClothRange& cloth : model.cloths) {
            if (!is_filled(cloth.fabric)) continue;
            hash.add(cloth.first);
            for (const std::optional<double>& number : {cloth.fabric.pressure, cloth.fabric.gas_volume}) {
                hash.add(static_cast<int>(number.has_value()));
                hash.add(number.value_or(0.0));
            }
        }
    }

    void add_skips(const ForceFacts& facts, std::vector<Skip>& skipped) const override {
        for (const ClothFacts& cloth : facts.cloths) {
            if (!is_filled(cloth.fabric))
                skipped.push_back({"pressure in " + cloth.name, "neither pressure nor gas_volume is set"});
        }
    }
};

}  // namespace

double volume_of(const ClothModel& model, const ClothRange& cloth, const Vec3Arrays& positions) {
    const Vec3 origin = positions.at(cloth.first);  // near the cloth, for less rounding
    const std::span<const Triangle> triangles = triangles_of(model, cloth);
    return sum_terms(0, static_cast<int>(triangles.size()), [&](int t) {
        const auto& [i, j, k] = triangles[t];
        return (positions.at(i) - origin).dot((positions.at(j) - origin).cross(positions.at(k) - origin)) / 6.0;
    });
}

void set_volume_gradient(const ClothModel& model, const ClothRange& cloth, const Vec3Arrays& positions, Vec3Arrays& gradient) {
    gradient.resize(static_cast<int>(positions.padded_size()));
    for (const auto& [i, j, k] : triangles_of(model, cloth)) {
        const Vec3 third = (positions.at(j) - positions.at(i)).cross(positions.at(k) - positions.at(i)) / 6.0;
        for (const int vertex : {i, j, k}) gradient.add(vertex, third);
    }
}

GasState gas_state_at(const Fabric& fabric, double volume) {
    if (fabric.pressure) return {*fabric.pressure, -*fabric.pressure * volume, 0.0};
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (!(volume > 0.0)) return {none, std::numeric_limits<double>::infinity(), none};
    const double amount = *fabric.gas_volume, more = (volume - amount) / amount;
    return {-air_pressure * more * amount / volume, air_pressure * amount * (more - std::log1p(more)),
            air_pressure * amount / (volume * volume)};
}

const ForceTerm& pressure_term() {
    static const Pressure term;
    return term;
}

}  // namespace percale
