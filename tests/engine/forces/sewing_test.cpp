#include "engine/forces/sewing.h"

#include "engine/forces/springs.h"
#include "engine/forces/total_force.h"
#include "engine/model/seams.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::forces_sewing_test {
namespace {

/// Two sheets, 0.2 m apart, sewn along one side vertex to point; a fraction of the distance is left.
struct Sewn {
    ClothModel model;
    Seam seam{.length = {}, .from = 0.0, .over = 1.0};
    std::vector<double> rest_length;

    explicit Sewn(double left) {
        TriangleMesh upper = make_grid(1.0, 1.0, 4, 4);
        for (Vec3& x : upper.vertices) x += Vec3(0.1, 0.2, 0.0);
        append_cloth(model, make_grid(1.0, 1.0, 4, 4), sheet_fabric(), "lower");
        append_cloth(model, upper, sheet_fabric(), "upper");
        const std::vector<Stitch> stitches = {{16, 0, 1, 0.3}, {17, 1, 2, 0.8}, {18, 2, 3, 0.5}, {19, 3, 3}};
        append_seam(stitches, 300.0, to_vec3_arrays(model.rest), seam, model);
        finish_model(model);
        rest_length = model.springs.rest_length;
        set_seam_lengths(seam, 1.0 - left, rest_length);
    }

    /// All forces in which the seam has a part, and their energy.
    double evaluate(const Vec3Arrays& positions, Vec3Arrays& forces) const {
        StepSprings springs;
        set_step_springs(compute, {model.adjacency, positions, DampingForm::velocity, 1.0, rest_length, &model.springs}, springs);
        Vec3Arrays still;
        still.resize(model.vertex_count());
        Forces sum;
        sum.total.resize(model.vertex_count());
        const ForceInput input{
            .compute = &compute, .model = &model, .springs = &springs, .positions = &positions, .velocities = &still, .dt = 1.0};
        REQUIRE(sewing_term().acts(input));
        const double potential = spring_term().add(input, sum) + sewing_term().add(input, sum);
        forces = sum.total;
        return potential;
    }
};

Vec3Arrays shaken(const Sewn& sewn, Random& random) {
    std::vector<Vec3> x = sewn.model.rest;
    for (Vec3& point : x) point += random.point(0.03);
    return to_vec3_arrays(x);
}

}  // namespace

TEST_CASE("Forces of sewn points are minus the gradient of the energy of seam and springs, while it closes and after") {
    Random random(5);
    for (const double left : {1.0, 0.4, 0.0}) {
        const Sewn sewn(left);
        const Vec3Arrays x = shaken(sewn, random);
        Vec3Arrays forces, none;
        sewn.evaluate(x, forces);
        for (int n = 0; n < 20; ++n) {
            std::vector<Vec3> way(sewn.model.vertex_count());
            for (Vec3& step : way) step = random.point(1.0);
            const Vec3Arrays direction = to_vec3_arrays(way);
            constexpr double reach = 1e-5;
            Vec3Arrays ahead = x, behind = x;
            add_scaled(ahead, reach, direction);
            add_scaled(behind, -reach, direction);
            const double slope = (sewn.evaluate(ahead, none) - sewn.evaluate(behind, none)) / (2.0 * reach);
            CHECK(slope == Approx(-dot(compute, forces, direction)).epsilon(1e-5).margin(1e-5));
        }
    }
}

TEST_CASE("Sewn points exert no total force, and none at all at their target distance") {
    const Sewn whole(1.0);
    Vec3Arrays forces;
    whole.evaluate(to_vec3_arrays(whole.model.rest), forces);
    for (int i = 0; i < whole.model.vertex_count(); ++i) CHECK(forces.at(i).norm() < 1e-11);
    Random random(6);
    const Sewn half(0.5);
    half.evaluate(shaken(half, random), forces);
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < half.model.vertex_count(); ++i) sum += forces.at(i);
    CHECK(sum.norm() < 1e-10);
}

TEST_CASE("The energy of sewn points counts as elastic, and distinguishes cloths") {
    const Sewn sewn(0.25);
    const Vec3Arrays x = to_vec3_arrays(sewn.model.rest);
    double stored = 0.0;
    for (const SewnPoint& point : sewn.model.sewn_points) stored += sewn_energy(point, sewn.rest_length[point.spring], x);
    CHECK(stored > 0.0);
    CHECK(sewing_term().energy({sewn.model, x, sewn.rest_length}) == Approx(stored));
    CHECK(sewing_term().entry() == &StepEnergy::elastic);
    ListHash one, other;
    sewing_term().identify(sewn.model, one);
    Sewn moved(0.25);
    moved.model.sewn_points[1].stitch.share = 0.7;
    sewing_term().identify(moved.model, other);
    CHECK(one.value() != other.value());
}

TEST_CASE("a weld pulls its two sides together with its hold, and that is minus the gradient of its energy") {
    ClothModel model;
    model.welds = {{{0, 2, 2, 0.0}, 100.0, {1.0, -2.0, 0.5}}, {{1, 2, 3, 0.25}, 50.0, {0.0, 3.0, 0.0}}};
    Vec3Arrays x;
    x.resize(4);
    for (int v = 0; v < 4; ++v) x.set(v, Vec3(0.1 * v, 0.02 * v * v, -0.3 * v));
    const ForceInput input{.model = &model, .positions = &x};
    REQUIRE(welding_term().acts(input));
    Forces forces;
    forces.total.resize(4);
    const double potential = welding_term().add(input, forces);
    CHECK(potential == Approx(welding_term().energy({model, x})));
    Vec3 sum = Vec3::Zero();
    for (int v = 0; v < 4; ++v) {
        sum += forces.total.at(v);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3Arrays moved = x;
            Vec3 by = Vec3::Zero();
            by[axis] = 1.0;  // the energy is linear
            moved.set(v, x.at(v) + by);
            const double slope = welding_term().energy({model, moved}) - potential;
            CHECK(forces.total.at(v)[axis] == Approx(-slope).margin(1e-12));
        }
    }
    CHECK(sum.norm() < 1e-14);
    const ClothModel none;
    CHECK_FALSE(welding_term().acts({.model = &none}));
}

TEST_CASE("saved states of other welds differ, whatever their holds are") {
    ClothModel model;
    model.welds = {{{0, 2, 2, 0.0}, 100.0, {1.0, -2.0, 0.5}}};
    const auto hash_of = [](const ClothModel& of) {
        ListHash hash;
        welding_term().identify(of, hash);
        return hash.value();
    };
    ClothModel same = model, other = model;
    same.welds[0].hold = Vec3::Zero();
    other.welds[0].stiffness = 101.0;
    CHECK(hash_of(same) == hash_of(model));
    CHECK(hash_of(other) != hash_of(model));
}

}  // namespace percale::test::forces_sewing_test
