#include "engine/forces/pressure.h"

#include <cmath>

#include "engine/forces/total_force.h"
#include "engine/linear/block_matrix.h"
#include "percale/error.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::pressure_test {
namespace {

Fabric filled(std::optional<double> pressure, std::optional<double> gas_volume) {
    Fabric fabric = free_fabric();
    fabric.pressure = pressure;
    fabric.gas_volume = gas_volume;
    return fabric;
}

/// A dented ball beside an open sheet, in one model.
struct Dented {
    ClothModel model;
    Vec3Arrays positions, velocities;

    explicit Dented(const Fabric& fabric, double deflections = 0.02) {
        append_cloth(model, make_grid(1.0, 1.0, 4, 4), sheet_fabric(), "sheet");
        append_cloth(model, make_sphere(0.2, 1), fabric, "ball");
        finish_model(model);
        Random random(5);
        std::vector<Vec3> places = model.rest;
        for (Vec3& x : places) x += Vec3(3.0, -2.0, 1.0) + random.point(deflections);
        positions = to_vec3_arrays(places);
        velocities.resize(model.vertex_count());
    }

    const ClothRange& ball() const { return model.cloths[1]; }
    double volume(const Vec3Arrays& at) const { return volume_of(model, ball(), at); }
    ForceInput input(const Vec3Arrays& at) const {
        return {
            .compute = &compute, .model = &model, .positions = &at, .velocities = &velocities, .dt = 0.01, .with_matrix = true};
    }
    double add(const Vec3Arrays& at, Forces& forces) const {
        forces.total.resize(model.vertex_count());
        forces.blocks.clear();
        return pressure_term().add(input(at), forces);
    }
    Vec3Arrays moved(double by, const Vec3Arrays& along) const {
        Vec3Arrays result = positions;
        add_scaled(result, by, along);
        return result;
    }
    Vec3Arrays direction(unsigned seed) const {
        Random random(seed);
        return to_vec3_arrays(random_points(random, model.vertex_count(), 1.0));
    }
};

}  // namespace

TEST_CASE("The volume of a box is the product of its edges, wherever it is") {
    const ClothModel model = cloth_model(make_box({0.2, 0.5, 0.3}), filled(1.0, {}));
    for (const Vec3& place : {Vec3(0.0, 0.0, 0.0), Vec3(5.0, -3.0, 2.0)}) {
        std::vector<Vec3> places = model.rest;
        for (Vec3& x : places) x += place;
        CHECK(volume_of(model, model.cloths[0], to_vec3_arrays(places)) == Approx(0.03).epsilon(1e-14));
    }
}

TEST_CASE("The gradient of the volume agrees with differences and adds up to zero") {
    const Dented scene(filled(1.0, {}));
    const ClothRange& ball = scene.ball();
    std::vector<Vec3> of_ball(ball.count, Vec3::Zero());
    add_volume_gradient(scene.model, ball, scene.positions, 1.0, of_ball);
    Vec3Arrays gradient;
    gradient.resize(scene.model.vertex_count());
    for (int i = 0; i < ball.count; ++i) gradient.set(ball.first + i, of_ball[i]);
    for (const unsigned seed : {1u, 2u, 3u}) {
        const Vec3Arrays d = scene.direction(seed);
        const double reach = 1e-5;
        const double slope = (scene.volume(scene.moved(reach, d)) - scene.volume(scene.moved(-reach, d))) / (2.0 * reach);
        CHECK(dot(compute, gradient, d) == Approx(slope).epsilon(1e-8));
    }
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < scene.model.vertex_count(); ++i) sum += gradient.at(i);
    CHECK(sum.norm() <= 1e-15);
}

TEST_CASE("A given pressure is constant, and for an amount of gas pressure times volume is") {
    for (const double volume : {-0.1, 0.01, 0.02}) {
        CHECK(gas_state_at(filled(30.0, {}), volume).pressure == 30.0);
        CHECK(gas_state_at(filled(30.0, {}), volume).energy == -30.0 * volume);
        CHECK(gas_state_at(filled(30.0, {}), volume).stiffness == 0.0);
    }
    const Fabric gas = filled({}, 0.02);
    const double air = 101325.0;
    for (const double volume : {0.005, 0.02, 0.03}) {
        const GasState at = gas_state_at(gas, volume);
        const double reach = 1e-6 * volume;
        const GasState ahead = gas_state_at(gas, volume + reach), behind = gas_state_at(gas, volume - reach);
        CHECK((at.pressure + air) * volume == Approx(air * 0.02).epsilon(1e-14));
        CHECK(at.pressure == Approx((behind.energy - ahead.energy) / (2.0 * reach)).epsilon(1e-6).margin(1e-4));
        CHECK(at.stiffness == Approx((behind.pressure - ahead.pressure) / (2.0 * reach)).epsilon(1e-6));
    }
    CHECK(gas_state_at(gas, 0.02).pressure == 0.0);
    CHECK(gas_state_at(gas, 0.02).energy == 0.0);
    for (const double volume : {0.0, -0.01}) {
        CHECK(std::isinf(gas_state_at(gas, volume).energy));
        CHECK(std::isnan(gas_state_at(gas, volume).pressure));
    }
}

TEST_CASE("Forces of the gas state are minus the slope of its energy, and act on no other cloth") {
    for (const Fabric& fabric : {filled(40.0, {}), filled(-40.0, {}), filled({}, 0.04), filled({}, 0.02)}) {
        const Dented scene(fabric);
        Forces forces, unused;
        const double energy = scene.add(scene.positions, forces);
        CHECK(energy == pressure_term().energy({scene.model, scene.positions}));
        const Vec3Arrays d = scene.direction(7);
        const double reach = 1e-6;
        const double ahead = scene.add(scene.moved(reach, d), unused), behind = scene.add(scene.moved(-reach, d), unused);
        CHECK(-dot(compute, forces.total, d) == Approx((ahead - behind) / (2.0 * reach)).epsilon(1e-5));
        for (int i = 0; i < 16; ++i) CHECK(forces.total.at(i) == Vec3::Zero());
    }
}

TEST_CASE("Pressure is in the matrix with its whole derivative") {
    for (const Fabric& fabric : {filled(40.0, {}), filled(-40.0, {}), filled({}, 0.04), filled({}, 0.02)}) {
        const Dented scene(fabric);
        Forces forces, ahead, behind;
        scene.add(scene.positions, forces);
        const Vec3Arrays d = scene.direction(9);
        const double reach = 1e-6, dt = 0.01;
        scene.add(scene.moved(reach, d), ahead);
        scene.add(scene.moved(-reach, d), behind);
        BlockMatrix matrix;
        set_pattern(compute, scene.model.adjacency, scene.model.mass, matrix);
        set_blocks({}, forces.blocks, matrix);
        Vec3Arrays product;
        product.resize(scene.model.vertex_count());
        add_force_product(matrix, d, product);
        double largest = 0.0, wrong = 0.0;
        for (int i = 0; i < scene.model.vertex_count(); ++i) {
            const Vec3 expected = dt * dt / (2.0 * reach) * (behind.total.at(i) - ahead.total.at(i));
            largest = std::max(largest, expected.norm());
            wrong = std::max(wrong, (product.at(i) - expected).norm());
        }
        CHECK(largest > 0.0);
        CHECK(wrong <= 1e-5 * largest);
    }
}

TEST_CASE("Two cloths with gas are pushed each by its own volume") {
    ClothModel model;
    append_cloth(model, make_sphere(0.2, 1), filled(50.0, {}), "one");
    append_cloth(model, make_sphere(0.1, 1), filled({}, 0.006), "other");
    finish_model(model);
    const Vec3Arrays positions = to_vec3_arrays(model.rest),
                     still = to_vec3_arrays(std::vector<Vec3>(model.rest.size(), Vec3::Zero()));
    Forces forces;
    forces.total.resize(model.vertex_count());
    pressure_term().add(
        {.compute = &compute, .model = &model, .positions = &positions, .velocities = &still, .dt = 0.01, .with_matrix = true},
        forces);
    REQUIRE(forces.blocks.outer.size() == 1);  // a given pressure does not depend on the volume
    CHECK(forces.blocks.outer[0].vertex.front() == model.cloths[1].first);
    CHECK(static_cast<int>(forces.blocks.outer[0].vertex.size()) == model.cloths[1].count);
    CHECK(forces.blocks.loads.size() == model.triangles.size());
    for (const ClothRange& cloth : model.cloths) {
        std::vector<Vec3> gradient(cloth.count, Vec3::Zero());
        add_volume_gradient(model, cloth, positions, 1.0, gradient);
        const double pressure = gas_state_at(cloth.fabric, volume_of(model, cloth, positions)).pressure;
        for (int i = cloth.first; i < cloth.first + cloth.count; ++i) {
            CHECK((forces.total.at(i) - pressure * gradient[i - cloth.first]).norm() <= 1e-12 * forces.total.at(i).norm());
        }
    }
}

TEST_CASE("Only a closed mesh with its normals outward encloses gas, by one of the two keys") {
    const auto refusal = [](const TriangleMesh& mesh, const Fabric& fabric) -> std::string {
        ClothModel model;
        try {
            append_cloth(model, mesh, fabric, "bag");
        } catch (const SceneError& error) {
            return error.what();
        }
        return "";
    };
    TriangleMesh ball = make_sphere(0.2, 1), inward = ball, open = ball, turned = ball;
    for (Triangle& t : inward.triangles) std::swap(t[0], t[1]);
    open.triangles.pop_back();
    std::swap(turned.triangles[3][0], turned.triangles[3][1]);
    CHECK(refusal(ball, filled(1.0, {})).empty());
    CHECK(refusal(ball, filled({}, 0.03)).empty());
    CHECK(refusal(open, filled(1.0, {})).find("the mesh is open there; pressure needs a closed mesh") != std::string::npos);
    CHECK(refusal(open, filled({}, 0.03)).find("gas_volume needs a closed mesh") != std::string::npos);
    CHECK(refusal(turned, filled(1.0, {})).find("wound against each other") != std::string::npos);
    CHECK(refusal(inward, filled(1.0, {})).find("clockwise seen from outside") != std::string::npos);
    CHECK(refusal(ball, filled(1.0, 0.03)).find("exclude each other") != std::string::npos);
    CHECK(refusal(ball, filled({}, 0.0)).find("gas_volume = 0 m^3 is outside") != std::string::npos);
}

}  // namespace percale::test::pressure_test
