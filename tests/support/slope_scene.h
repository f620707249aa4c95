#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/plane_detector.h"

namespace percale::test {

/// A sheet `height` above a plane of friction `mu` that is tilted by `slope`, 0 or atan 3/4, about z: downhill is +x.
struct SlopeScene {
    Simulation simulation;
    ClothId cloth;
    ObstacleId plane;

    explicit SlopeScene(double mu, bool slope = true, double restitution = 0.0, double height = 0.0045,
                        std::unique_ptr<ContactDetector> detector = std::make_unique<PlaneDetector>())
        : simulation(StepSettings{}, std::move(detector)) {
        const double half = slope ? -0.5 * std::atan(0.75) : 0.0;
        const Rotation tilt{std::cos(half), 0.0, 0.0, std::sin(half)};
        const Pose pose{.translation = transform({.rotation = tilt}, Vec3(0, height, 0)), .rotation = tilt};
        cloth = simulation.add_cloth(make_grid(0.2, 0.2, 4, 4), sheet_fabric(), pose, "towel");
        plane = simulation.add_obstacle(make_plane(1.0), {.rotation = tilt},
                                        {.friction = mu, .restitution = restitution, .name = "floor"});
    }
    void run(int steps) {
        for (int n = 0; n < steps; ++n) REQUIRE(simulation.step().ok());
    }
    Vec3 mean(std::span<const Vec3> of) const {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& x : of) sum += x / static_cast<double>(of.size());
        return sum;
    }
};

/// The call throws, its message has the parts, and the simulation stays as it was.
template <class Call>
void check_refused(Simulation& simulation, Call&& call, const std::vector<std::string>& parts) {
    const std::vector<std::byte> before = simulation.save();
    const std::string message = scene_error(call);
    CAPTURE(message);
    CHECK(!message.empty());
    CHECK(mentions(message, parts));
    CHECK(simulation.save() == before);
}

}  // namespace percale::test
