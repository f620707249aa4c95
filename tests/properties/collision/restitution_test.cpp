#include <algorithm>
#include <cmath>

#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/laws.h"

namespace percale::test::restitution_test {
namespace {

constexpr double g = 9.81, h = 0.005;

struct Bounce {
    double came = 0.0, left = 0.0;  // m/s
    double imbalance = 0.0;         // J, worst step of the ledger
};

/// The speed at which a height h would be reached in free flight.
double speed_at_thickness(double height, double speed) {
    return std::sqrt(std::max(0.0, speed * speed + 2.0 * g * (height - h)));
}

/// A flat sheet falls onto a plane: its speeds before and after the impact.
Bounce bounce(StepSettings settings, double height, double restitution) {
    settings.measure = StepMeasures::ledger;
    Simulation simulation(settings, backends().back().make_detector());
    const Fabric fabric{.springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0}};
    const ClothId cloth = simulation.add_cloth(make_grid(0.3, 0.3, 6, 6), fabric, {.translation = {0.0, h + height, 0.0}});
    simulation.add_obstacle(make_plane(1.0), {}, {.restitution = restitution});
    Bounce result;
    bool hit = false;
    while (simulation.time() < 0.45) {
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        result.imbalance = std::max(result.imbalance, std::abs(report.energy.imbalance));
        double y = 0.0, v = 0.0;
        for (const Vec3& x : simulation.positions(cloth)) y += x.y() / 36.0;
        for (const Vec3& u : simulation.velocities(cloth)) v += u.y() / 36.0;
        hit = hit || report.contacts > 0;
        if (!hit && v < 0.0 && result.left == 0.0) result.came = speed_at_thickness(y, v);
        if (v > 0.0) result.left = std::max(result.left, v);
    }
    return result;
}

void check_bounces(const char* name, StepSettings settings, double restitution) {
    for (const double rate : {30.0, 60.0, 120.0, 240.0, 480.0, 960.0}) {
        settings.time_step = 1.0 / rate;
        // A stage of TR-BDF2 may follow the one in which the sheet was thrown back: gravity has acted meanwhile.
        const double since = settings.scheme == Scheme::tr_bdf2 ? (std::sqrt(2.0) - 1.0) * settings.time_step : 0.0;
        for (const double height : {0.17, 0.2}) {
            const Bounce result = bounce(settings, height, restitution);
            const double share = result.left / result.came, lost = g * since / result.came;
            CAPTURE(name, rate, height, restitution, share);
            CHECK(share < restitution + 0.03);
            CHECK(share > restitution - 0.03 - (restitution > 0.0 ? lost : 0.0));
            check_law(std::string("ledger of a bounce, ") + name + ": worst step", result.imbalance, 1e-12);
        }
    }
}

}  // namespace

TEST_CASE("Cloth leaves an obstacle with its restitution, whatever the step", "[law]") {
    for (const double restitution : {0.0, 0.3, 0.7, 1.0}) {
        check_bounces("penalty", {}, restitution);
        check_bounces("projection", {.contact_response = ContactResponse::projection}, restitution);
        check_bounces("tr_bdf2", {.scheme = Scheme::tr_bdf2}, restitution);
    }
}

TEST_CASE("Cloth that bounces comes to rest") {
    Simulation simulation({.time_step = 1.0 / 240.0}, backends().back().make_detector());
    const ClothId cloth = simulation.add_cloth(make_grid(0.3, 0.3, 6, 6), {}, {.translation = {0.0, 0.1, 0.0}});
    simulation.add_obstacle(make_plane(1.0), {}, {.restitution = 0.5});
    bool asleep = false;
    for (int k = 0; k < 240 * 6 && !asleep; ++k) asleep = simulation.step().slept;
    CHECK(asleep);
    for (const Vec3& x : simulation.positions(cloth)) CHECK((x.y() > 0.5 * h && x.y() < 1.1 * h));
}

TEST_CASE("Cloth that is placed or given a velocity is in no impact any more") {
    for (const bool placed : {false, true}) {
        Simulation simulation({.time_step = 1.0 / 960.0}, backends().back().make_detector());
        const ClothId cloth = simulation.add_cloth(make_grid(0.3, 0.3, 6, 6), {}, {.translation = {0.0, 0.006, 0.0}});
        simulation.add_obstacle(make_plane(1.0), {}, {.restitution = 1.0});
        simulation.set_velocities(cloth, std::vector<Vec3>(36, Vec3(0.0, -2.0, 0.0)));
        while (simulation.step().contacts == 0) REQUIRE(simulation.time() < 0.1);
        REQUIRE(simulation.velocities(cloth)[0].y() < 0.0);  // on its way: the impact would throw it back
        const auto shown = simulation.positions(cloth);
        const std::vector<Vec3> places(shown.begin(), shown.end());
        if (placed) simulation.set_positions(cloth, places);
        simulation.set_velocities(cloth, std::vector<Vec3>(36, Vec3::Zero()));
        for (int k = 0; k < 50; ++k) {
            REQUIRE(simulation.step().ok());
            CHECK(simulation.velocities(cloth)[0].y() < 1.0);
        }
    }
}

TEST_CASE("An obstacle's restitution is between 0 and 1") {
    for (const double restitution : {-0.1, 1.1}) {
        Simulation simulation({}, backends().back().make_detector());
        CHECK_THROWS_AS(simulation.add_obstacle(make_plane(1.0), {}, {.restitution = restitution}), SceneError);
    }
}

}  // namespace percale::test::restitution_test
