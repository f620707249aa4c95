#include "engine/forces/wind.h"

#include <Eigen/Dense>

#include "tests/support/bench_meshes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::wind_test {
namespace {

constexpr double dt = 1.0 / 60.0, density = 1.2;

struct Blown {
    WindPower sum;
    std::vector<CoupledBlock> blocks;
    Vec3Arrays forces;
};

Blown blow(const ClothModel& model, const std::vector<Vec3>& positions, const Vec3Arrays& velocities, const Vec3& air) {
    Blown result;
    StepWind wind;
    set_step_wind(model, air, density, to_vec3_arrays(positions), wind);
    result.forces.resize(model.vertex_count());
    result.blocks.push_back({.vertex = {3, -1, -1, -1}, .weight = {1.0, 0.0, 0.0, 0.0}, .k = {7.0}});  // of another force
    result.sum = add_wind(model, wind, velocities, dt, result.forces, &result.blocks);
    return result;
}

Vec3 sum(const Vec3Arrays& vectors, int count) {
    Vec3 total = Vec3::Zero();
    for (int i = 0; i < count; ++i) total += vectors.at(i);
    return total;
}

Vec3Arrays random_velocities(Random& random, int count) { return to_vec3_arrays(random_points(random, count, 3.0)); }

Eigen::Matrix3d matrix_of(const SymmetricBlock& k) {
    Eigen::Matrix3d m;
    m << k[0], k[1], k[2], k[1], k[3], k[4], k[2], k[4], k[5];
    return m;
}

std::vector<TriangleMesh> some_meshes() { return {make_grid(1.0, 0.6, 6, 5), irregular_sheet(1.0, 300)}; }

Fabric fabric_for(const TriangleMesh& mesh) {
    Fabric fabric = mesh.is_grid() ? sheet_fabric() : free_fabric();
    fabric.drag_normal = 1.7;
    fabric.drag_tangential = 0.2;
    return fabric;
}

}  // namespace

TEST_CASE("A sheet at rest takes the drag of its area, across and along, each vertex in proportion to its mass") {
    for (const TriangleMesh& mesh : some_meshes()) {
        const ClothModel model = cloth_model(mesh, fabric_for(mesh));
        double area = 0.0;
        for (const double m : model.mass) area += m / 0.2;
        Vec3Arrays still;
        still.resize(model.vertex_count());
        const Blown across = blow(model, model.rest, still, {0.0, -4.0, 0.0});
        CHECK((sum(across.forces, model.vertex_count()) - Vec3(0, -0.5 * density * area * 1.7 * 16.0, 0)).norm() < 1e-10);
        const Blown along = blow(model, model.rest, still, {3.0, 0.0, 4.0});
        CHECK((sum(along.forces, model.vertex_count()) - 0.5 * density * area * 0.2 * 5.0 * Vec3(3.0, 0.0, 4.0)).norm() < 1e-10);
        for (int i = 0; i < model.vertex_count(); ++i) {
            CHECK(across.forces.at(i).y() / model.mass[i] == Approx(across.forces.at(0).y() / model.mass[0]).epsilon(1e-9));
        }
    }
}

TEST_CASE("Only the velocity relative to the air counts, and drag never increases it") {
    Random random(4);
    for (const TriangleMesh& mesh : some_meshes()) {
        const ClothModel model = cloth_model(mesh, fabric_for(mesh));
        const std::vector<Vec3> places = random_points(random, model.vertex_count(), 0.5);
        const Vec3Arrays velocities = random_velocities(random, model.vertex_count());
        const Vec3 air(1.0, -2.0, 0.5);
        Vec3Arrays relative = velocities;
        for (int i = 0; i < model.vertex_count(); ++i) relative.add(i, -air);
        const Blown moving = blow(model, places, velocities, air), still = blow(model, places, relative, Vec3::Zero());
        double work = 0.0, power = 0.0;
        for (int i = 0; i < model.vertex_count(); ++i) {
            CHECK((moving.forces.at(i) - still.forces.at(i)).norm() <= 1e-12 * moving.forces.at(i).norm());
            CHECK(still.forces.at(i).dot(relative.at(i)) <= 0.0);
            work += moving.forces.at(i).dot(velocities.at(i));
            power += still.forces.at(i).dot(relative.at(i));
        }
        CHECK(moving.sum.power == Approx(work).epsilon(1e-12));
        CHECK(still.sum.power == Approx(power).epsilon(1e-12));
    }
}

TEST_CASE("Drag is minus the derivative of its potential by velocity, and its blocks are minus the derivative of the drag") {
    Random random(8);
    for (const TriangleMesh& mesh : some_meshes()) {
        const ClothModel model = cloth_model(mesh, fabric_for(mesh));
        const std::vector<Vec3> places = random_points(random, model.vertex_count(), 0.5);
        const Vec3Arrays velocities = random_velocities(random, model.vertex_count());
        const Vec3 air(5.0, 0.0, -1.0);
        const Blown here = blow(model, places, velocities, air);
        const double h = 1e-5;
        REQUIRE(here.blocks.size() == model.mass.size() + 1);
        CHECK(here.blocks[0].k == SymmetricBlock{7.0});
        for (int i = 0; i < model.vertex_count(); i += 7) {
            CHECK(here.blocks[i + 1].vertex == std::array<int, 4>{i, -1, -1, -1});
            const Eigen::Matrix3d block = matrix_of(here.blocks[i + 1].k);
            for (int axis = 0; axis < 3; ++axis) {
                Vec3Arrays ahead = velocities, behind = velocities;
                ahead.add(i, h * Vec3::Unit(axis));
                behind.add(i, -h * Vec3::Unit(axis));
                const Blown up = blow(model, places, ahead, air), down = blow(model, places, behind, air);
                const double slope = (up.sum.potential - down.sum.potential) / (2.0 * h);
                CHECK(slope == Approx(-dt * here.forces.at(i)[axis]).epsilon(1e-5).margin(1e-9));
                const Vec3 change = (up.forces.at(i) - down.forces.at(i)) / (2.0 * h);
                CHECK((change + block.col(axis) / dt).norm() <= 1e-5 * block.norm() / dt);
            }
            CHECK(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(block).eigenvalues().minCoeff() >= -1e-12 * block.norm());
        }
    }
}

}  // namespace percale::test::wind_test
