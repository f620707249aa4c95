// Rigid bodies of a Bullet world meet cloth: a box falls on a trampoline, a ball into a sheet that hangs from its corners. Prints
// where each comes to rest, what the cloth carries it with, and what holds the cloth. Exit code 1 with a text where something
// fails.
#include <cmath>
#include <cstdio>
#include <exception>

#include "bullet_bodies.h"
#include "percale/certify.h"
#include "percale/detectors.h"

namespace {

constexpr double dt = 1.0 / 240.0, g = 9.81;

struct Falling {
    const char* name;
    btCollisionShape& shape;
    percale::TriangleMesh mesh;  // the same shape
    double mass;                 // kg
    double height;               // m, of its centre above the cloth
    bool held_all_round;         // else at its corners
    double area_density, side;   // kg/m^2, m, of the cloth
};

percale::Vec3 momentum(const percale::Simulation& of, percale::ClothId cloth) {
    percale::Vec3 sum = percale::Vec3::Zero();
    for (std::size_t i = 0; i < of.masses(cloth).size(); ++i) sum += of.masses(cloth)[i] * of.velocities(cloth)[i];
    return sum;
}

void fall(const Falling& scene) {
    constexpr int vertices = 17;
    const percale::Fabric fabric{.area_density = scene.area_density,
                                 .thickness = 0.01,
                                 .springs = {.structural = 2000.0, .shear = 1000.0, .bend = 5.0},
                                 .spring_damping = 40.0};
    percale::Simulation simulation({.newton_tolerance = 1e-10}, percale::make_bullet_detector());
    const percale::TriangleMesh sheet = percale::make_grid(scene.side, scene.side, vertices, vertices);
    const percale::ClothId cloth = simulation.add_cloth(sheet, fabric);
    for (int i = 0; i < vertices * vertices; ++i) {
        const int column = i % vertices, row = i / vertices, last = vertices - 1;
        const int sides = (column == 0 || column == last) + (row == 0 || row == last);
        if (sides >= (scene.held_all_round ? 1 : 2)) simulation.pin(cloth, i);
    }
    BulletWorld world({0.0, -g, 0.0});
    BulletBody body(world, scene.shape, scene.mass, {0.0, scene.height, 0.0});
    BulletBodies bodies(world.world, simulation);
    const percale::ObstacleId obstacle = bodies.add(*body, scene.mesh, 0.5, scene.name);
    percale::TriangleMesh cloth_now = sheet, body_now = scene.mesh;
    bool crossed = false;
    percale::Vec3 held =
        percale::Vec3::Zero();  // N, of the last step: what changes the cloth's momentum and is no weight or body
    for (int step = 0; step < 6 * 240; ++step) {
        const percale::Vec3 before = momentum(simulation, cloth);
        bodies.step(dt);
        held = (momentum(simulation, cloth) - before) / dt + simulation.force_on(obstacle);
        held.y() += scene.area_density * scene.side * scene.side * g;
        cloth_now.vertices.assign(simulation.positions(cloth).begin(), simulation.positions(cloth).end());
        body_now.vertices = transform(simulation.obstacle_pose(obstacle), scene.mesh.vertices);
        if (step % 10 == 0) crossed = crossed || !percale::certify(cloth_now, body_now, 0.0).clean();
    }
    std::printf("%s at %.3f m, %.0e m/s; cloth carries %.4f of its weight, pins %.4f of both; %s\n", scene.name,
                body->getCenterOfMassPosition().y(), body->getLinearVelocity().length(),
                simulation.force_on(obstacle).y() / (scene.mass * g),
                held.y() / (g * (scene.mass + scene.area_density * scene.side * scene.side)),
                crossed ? "crossed" : "nothing crosses");
}

}  // namespace

int main() try {
    btBoxShape box({0.1, 0.1, 0.1});
    btSphereShape ball(0.12);
    fall({"box", box, percale::make_box({0.2, 0.2, 0.2}), 2.0, 0.5, true, 0.3, 1.0});
    fall({"ball", ball, percale::make_sphere(0.12, 3), 1.0, 0.4, false, 0.3, 1.0});
} catch (const std::exception& error) {
    std::fprintf(stderr, "bullet_world: %s\n", error.what());
    return 1;
}
