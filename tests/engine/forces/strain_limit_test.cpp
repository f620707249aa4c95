#include "engine/forces/strain_limit.h"

#include <cmath>

#include "engine/kernels/kernel_choice.h"
#include "engine/linear/block_matrix.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::strain_limit_test {
namespace {

constexpr double dt = 1.0 / 60.0;

/// A sheet with negligible springs, stretched at random, some edges of which have a hold already.
struct LimitedSheet {
    ClothModel model;
    Vec3Arrays positions, velocities, forces;
    SpringTerms terms;
    double energy = 0.0;

    explicit LimitedSheet(bool grid, double stretch = 1.1) {
        TriangleMesh mesh = make_grid(1.0, 0.8, 11, 9);
        if (!grid) mesh.grid_columns = mesh.grid_rows = 0;
        Fabric fabric = free_fabric();
        fabric.strain_limit = 0.08;
        model = cloth_model(mesh, fabric);
        Random random(31);
        std::vector<Vec3> places = model.rest;
        for (Vec3& x : places) x = stretch * x + 0.004 * Vec3(random.number(-1, 1), random.number(-1, 1), random.number(-1, 1));
        positions = to_vec3_arrays(places);
        velocities.resize(model.vertex_count());
        for (std::size_t k = 0; k < model.limits.edges.size(); k += 3) model.limits.set_hold(model.limits.edges[k], 3.0);
    }

    /// Evaluates only the limits.
    void evaluate(const Compute& with = compute) {
        pack_points(with, model.adjacency, positions, terms.points);
        terms.values.assign(model.adjacency.value_count(), 0.0f);
        forces.resize(model.vertex_count());
        energy = evaluate_limits(with, model, {positions, velocities, dt}, true, forces, terms);
    }
};

}  // namespace

TEST_CASE(
    "Limited edges pull with h + k (l - L) along themselves and store T^2/2k, with dt^2 k along and dt^2 T/l across in the "
    "matrix") {
    for (const bool grid : {true, false}) {
        LimitedSheet sheet(grid);
        sheet.evaluate();
        std::vector<Vec3> expected(sheet.model.vertex_count(), Vec3::Zero());
        double energy = 0.0;
        int pulling = 0;
        for (const LimitedEdge& edge : sheet.model.limits.edges) {
            const int i = sheet.model.springs.first[edge.spring], j = sheet.model.springs.second[edge.spring];
            const Vec3 x = sheet.positions.at(i) - sheet.positions.at(j);
            const double l = x.norm(), tension = std::max(0.0, edge.hold + edge.stiffness * (l - edge.length));
            expected[i] -= tension / l * x;
            expected[j] += tension / l * x;
            energy += 0.5 * tension * tension / edge.stiffness;
            pulling += tension > 0.0;
            const auto [a, w] = spring_block(sheet.model.adjacency, sheet.terms, edge.spring);
            const double along = tension > 0.0 ? edge.stiffness : 0.0;
            CHECK(a == Approx(dt * dt * tension / l).epsilon(1e-6));
            CHECK(a + w.squaredNorm() == Approx(dt * dt * along).epsilon(1e-6));
            if (tension > 0.0) CHECK(std::abs(w.normalized().dot(x)) == Approx(l).epsilon(1e-6));
        }
        CHECK(pulling > 20);
        CHECK(pulling < static_cast<int>(sheet.model.limits.edges.size()) - 20);
        CHECK(sheet.energy == Approx(energy).epsilon(1e-12));
        CHECK(limit_energy(sheet.model.limits, sheet.model.springs, sheet.positions) == Approx(energy).epsilon(1e-12));
        CHECK(largest_difference(to_points(sheet.forces, sheet.model.vertex_count()), expected) < 1e-10);
    }
}

TEST_CASE("Forces of limited edges are minus the slope of their energy") {
    LimitedSheet sheet(false);
    sheet.evaluate();
    Random random(5);
    for (int n = 0; n < 20; ++n) {
        const int i = static_cast<int>(random.number(0, sheet.model.vertex_count() - 1e-9));
        const Vec3 way(random.number(-1, 1), random.number(-1, 1), random.number(-1, 1)), place = sheet.positions.at(i);
        const auto energy_at = [&](double reach) {
            Vec3Arrays moved = sheet.positions;
            moved.set(i, place + reach * way);
            return limit_energy(sheet.model.limits, sheet.model.springs, moved);
        };
        CHECK((energy_at(1e-7) - energy_at(-1e-7)) / 2e-7 == Approx(-sheet.forces.at(i).dot(way)).margin(1e-3));
    }
}

TEST_CASE("Slack edges change no bit") {
    LimitedSheet sheet(true, 0.9);
    for (LimitedEdge& edge : sheet.model.limits.edges) sheet.model.limits.set_hold(edge, 0.0);
    sheet.evaluate();
    CHECK(sheet.energy == 0.0);
    for (int i = 0; i < sheet.model.vertex_count(); ++i) CHECK(sheet.forces.at(i) == Vec3::Zero());
    for (const float value : sheet.terms.values) CHECK(value == 0.0f);
}

TEST_CASE("Limits have the same bits in every instruction set") {
    LimitedSheet baseline(false);
    Compute with;
    with.kernels = kernels_for(InstructionSet::baseline);
    baseline.evaluate(with);
    for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
        with.kernels = kernels_for(set);
        if (!with.kernels) continue;
        LimitedSheet wide(false);
        wide.evaluate(with);
        CHECK(wide.energy == baseline.energy);
        CHECK(same_bits(wide.forces, baseline.forces));
        CHECK(wide.terms.values == baseline.terms.values);
    }
}

}  // namespace percale::test::strain_limit_test
