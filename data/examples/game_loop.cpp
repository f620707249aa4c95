// A cape in a game: fixed steps under frames of any length, drawn between two steps, with normals. A hitch of the host is no
// motion: all that is together is teleported. Prints what was stepped and drawn. Exit code 1 with a text where something fails.
#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

#include "percale/detectors.h"
#include "percale/percale.h"

namespace {

constexpr double dt = 1.0 / 60.0;  // s
constexpr int max_steps = 4;       // in a frame: what needs more is a hitch

/// Where the character is: it walks along x, bobs and looks around.
percale::Pose walk(double time) {
    const double half_turn = 0.2 * std::sin(2.0 * time);
    return {.translation = {1.4 * time, 0.7 + 0.02 * std::sin(12.0 * time), 0.0},
            .rotation = {std::cos(half_turn), 0.0, std::sin(half_turn), 0.0}};
}

/// The rigid motion of the world that takes one pose to another.
percale::Pose motion_between(const percale::Pose& from, const percale::Pose& to) {
    const percale::Rotation back{from.rotation.w, -from.rotation.x, -from.rotation.y, -from.rotation.z};
    const percale::Rotation turn = product(to.rotation, back);
    return {.translation = to.translation - percale::transform({.rotation = turn}, from.translation), .rotation = turn};
}

}  // namespace

int main() try {
    percale::Simulation simulation({.time_step = dt, .work_limit = 200}, percale::make_brute_force_detector());
    const percale::ObstacleId body = simulation.add_obstacle(percale::make_capsule(0.2, 1.0, 16), walk(0.0), {.name = "body"});
    const percale::Pose behind{.translation = {-0.24, 0.8, 0.0}, .rotation = {std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)}};
    const percale::ClothId cape = simulation.add_cloth(
        percale::make_grid(0.8, 0.5, 17, 11), {.thickness = 0.01, .springs = {.shear = 300.0, .bend = 1.0}}, behind, "cape");
    std::vector<int> shoulders;
    std::vector<percale::Vec3> held;  // where they are on the character
    for (int vertex = 16; vertex < 17 * 11; vertex += 17) {
        shoulders.push_back(vertex);
        held.push_back(inverse_transform(walk(0.0), simulation.positions(cape)[vertex]));
        simulation.pin(cape, vertex);
    }
    simulation.set_wind({0.0, 0.0, 0.0});  // the air stands still, so that the cape trails
    simulation.keep_previous_positions();
    const double frame_times[] = {0.007, 0.021, 0.016, 0.011, 0.034};  // s, what a host's clock says
    std::vector<percale::Vec3> drawn(17 * 11), normals(17 * 11);
    double owed = 0.0, clock = 0.0;  // s, that frames are ahead of steps; of the character
    int steps = 0, teleports = 0, refused = 0;
    for (int frame = 0; frame < 400; ++frame) {
        owed += frame == 250 ? 2.0 : frame_times[frame % 5];
        if (owed > max_steps * dt) {
            const double skipped = std::floor(owed / dt) * dt - dt;  // one step is left to be made
            simulation.teleport({&cape, 1}, {&body, 1}, motion_between(walk(clock), walk(clock + skipped)));
            clock += skipped;
            owed -= skipped;
            ++teleports;
        }
        for (; owed >= dt; owed -= dt) {
            clock += dt;
            simulation.move_obstacle(body, walk(clock));
            for (std::size_t i = 0; i < held.size(); ++i)
                simulation.move_pin(cape, shoulders[i], transform(walk(clock), held[i]));
            // Beyond the work limit the state stays; the next step goes from there to where the character is by then.
            simulation.step().ok() ? ++steps : ++refused;
        }
        simulation.interpolate(owed / dt, cape, drawn);
        simulation.normals(cape, normals);  // those of the last step do for shading
    }
    std::printf("400 frames, %d steps, %d teleport, %d steps refused; hem %.2f m behind the shoulders, normal %.2f %.2f %.2f\n",
                steps, teleports, refused, drawn[16 + 17 * 5].x() - drawn[17 * 5].x(), normals[17 * 5].x(), normals[17 * 5].y(),
                normals[17 * 5].z());
} catch (const std::exception& error) {
    std::fprintf(stderr, "game_loop: %s\n", error.what());
    return 1;
}
