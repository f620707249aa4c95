#include "pressure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace percale {
namespace {

/// Pa, of the air around the cloth (the standard atmosphere at sea level), which compresses an amount of gas. Larger: cloth that
/// encloses gas is stiffer against a change of its volume.
constexpr double air_pressure = 101325.0;

bool is_filled(const Fabric& fabric) { return fabric.pressure || fabric.gas_volume; }

/// work(triangle, dV/dx at each of its corners)
template <class Work>
void for_each_volume_gradient(const ClothModel& model, const ClothRange& cloth, const Vec3Arrays& positions, const Work& work) {
    for (const Triangle& t : triangles_of(model, cloth)) {
        const Vec3 a = positions.at(t[0]);
        work(t, (positions.at(t[1]) - a).cross(positions.at(t[2]) - a) / 6.0);
    }
}

void add_blocks(const ForceInput& input, const ClothRange& cloth, const GasState& gas, ForceBlocks& blocks) {
    if (gas.stiffness > 0.0) {
        const OuterBlocks::NewBlock block = blocks.outer.add(cloth.count);
        std::iota(block.vertex.begin(), block.vertex.end(), cloth.first);
        add_volume_gradient(*input.model, cloth, *input.positions, input.dt * std::sqrt(gas.stiffness), block.gradient);
    }
    const double factor = -input.dt * input.dt * gas.pressure / 6.0;
    for (const Triangle& t : triangles_of(*input.model, cloth)) {
        const Vec3 a = input.positions->at(t[0]);
        blocks.loads.push_back({t, factor * (input.positions->at(t[1]) - a), factor * (input.positions->at(t[2]) - a)});
    }
}

class Pressure final : public ForceTerm {
public:
    std::string_view name() const override { return "pressure"; }
    bool acts(const ForceInput& input) const override {
        return std::ranges::any_of(input.model->cloths, [](const ClothRange& cloth) { return is_filled(cloth.fabric); });
    }

    double add(const ForceInput& input, Forces& forces) const override {
        double energy = 0.0;
        for (const ClothRange& cloth : input.model->cloths) {
            if (!is_filled(cloth.fabric)) continue;
            const GasState gas = gas_state_at(cloth.fabric, volume_of(*input.model, cloth, *input.positions));
            for_each_volume_gradient(*input.model, cloth, *input.positions, [&](const Triangle& t, const Vec3& gradient) {
                for (const int vertex : t) forces.total.add(vertex, gas.pressure * gradient);
            });
            if (input.with_matrix) add_blocks(input, cloth, gas, forces.blocks);
            energy += gas.energy;
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

void add_volume_gradient(const ClothModel& model, const ClothRange& cloth, const Vec3Arrays& positions, double factor,
                         std::span<Vec3> sum) {
    for_each_volume_gradient(model, cloth, positions, [&](const Triangle& t, const Vec3& gradient) {
        for (const int vertex : t) sum[vertex - cloth.first] += factor * gradient;
    });
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
