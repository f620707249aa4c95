#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "percale/certify.h"
#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/contact_laws.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/laws.h"

// Obstacles whose every vertex moves, against exact answers.
namespace percale::test::deforming_laws_test {
namespace {

constexpr double dt = 1.0 / 60.0, h = 0.005, g = 9.81, area_density = 0.2;
/// m, offsets of sheets from the lines of a plane's mesh, across and along: for vertices exactly above one of its edges rounding
/// decides which triangle they meet, on rigid planes as well.
constexpr double aside = 0.0031, behind = 0.0017;

Fabric fabric(double structural = 1000.0) {
    return {.area_density = area_density,
            .thickness = h,
            .springs = {.structural = structural, .shear = 0.5 * structural, .bend = 0.01 * structural},
            .spring_damping = 0.1};
}

const std::array responses = {ContactResponse::penalty, ContactResponse::projection};
std::string word(ContactResponse response) { return response == ContactResponse::penalty ? "penalty" : "projection"; }

Vec3 momentum(const Simulation& simulation, ClothId cloth) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < simulation.masses(cloth).size(); ++i)
        sum += simulation.masses(cloth)[i] * simulation.velocities(cloth)[i];
    return sum;
}

double largest_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
}

/// The places of a mesh's vertices under a map.
std::vector<Vec3> mapped(const TriangleMesh& mesh, const std::function<Vec3(const Vec3&)>& map) {
    std::vector<Vec3> places;
    for (const Vec3& x : mesh.vertices) places.push_back(map(x));
    return places;
}

Certificate certificate(const Simulation& simulation, ClothId cloth, const TriangleMesh& cloth_mesh, ObstacleId obstacle,
                        const TriangleMesh& mesh) {
    const auto x = simulation.positions(cloth);
    TriangleMesh there = mesh;
    const auto shape = simulation.obstacle_shape(obstacle);
    if (!shape.empty()) there.vertices.assign(shape.begin(), shape.end());
    there.vertices = transform(simulation.obstacle_pose(obstacle), there.vertices);
    return certify({.vertices = {x.begin(), x.end()}, .triangles = cloth_mesh.triangles}, there, 4.0 * h);
}

double area(const TriangleMesh& mesh, std::span<const Vec3> x) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) sum += 0.5 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm();
    return sum;
}

double largest_edge(const TriangleMesh& mesh) {
    double largest = 0.0;
    for (const Triangle& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) largest = std::max(largest, (mesh.vertices[t[i]] - mesh.vertices[t[(i + 1) % 3]]).norm());
    }
    return largest;
}

/// The sum of k (l - l0) l over the edges of a closed mesh, each of them in two triangles, N m.
double pull(const TriangleMesh& mesh, std::span<const Vec3> x, double k) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            const int a = t[i], b = t[(i + 1) % 3];
            const double length = (x[a] - x[b]).norm();
            sum += 0.5 * k * (length - (mesh.vertices[a] - mesh.vertices[b]).norm()) * length;
        }
    }
    return sum;
}

/// A flat mesh under a sheet, moved as a whole by its pose or vertex by vertex.
struct Plate {
    TriangleMesh mesh = make_grid(1.6, 1.6, 17, 17);
    TriangleMesh sheet = make_grid(0.3, 0.3, 8, 8);
    Simulation simulation;
    ClothId cloth;
    ObstacleId plate;
    bool by_shape;

    Plate(bool by_shape_, StepSettings settings, ObstacleSettings obstacle, double height, const Fabric& material = fabric())
        : simulation(simulation_on_meshes(settings)), by_shape(by_shape_) {
        cloth = simulation.add_cloth(sheet, material, {.translation = {aside, height, behind}});
        obstacle.deforming = by_shape;
        plate = simulation.add_obstacle(mesh, {}, obstacle);
    }
    void go_to(const Vec3& shift) {
        if (by_shape) {
            simulation.deform_obstacle(plate, moved(mesh, shift).vertices);
        } else {
            simulation.move_obstacle(plate, {.translation = shift});
        }
    }
};

/// A sheet on a plane along which waves run, once they have grown in a second.
struct Ripples {
    static constexpr double a = 0.004, k = 2.0 * std::numbers::pi / 0.3, w = 2.0 * std::numbers::pi,
                            weight = area_density * 0.09 * g;
    TriangleMesh plane = make_grid(0.8, 0.8, 41, 41), sheet = make_grid(0.3, 0.3, 13, 13);
    Simulation simulation;
    ClothId cloth;
    ObstacleId body;

    explicit Ripples(ContactResponse response) : simulation(simulation_on_meshes({.contact_response = response})) {
        cloth = simulation.add_cloth(sheet, fabric(), {.translation = {aside, h, behind}});
        body = simulation.add_obstacle(plane, {}, {.friction = 0.4, .name = "plane", .deforming = true});
    }
    double height(double x) const { return a * std::min(1.0, simulation.time()) * std::sin(k * x - w * simulation.time()); }
    void step() {
        const double time = simulation.time() + dt, high = a * std::min(1.0, time);
        simulation.deform_obstacle(
            body, mapped(plane, [&](const Vec3& x) { return Vec3(x.x(), high * std::sin(k * x.x() - w * time), x.z()); }));
        REQUIRE(step_well(simulation).parts == 1);
        CHECK(certificate(simulation, cloth, sheet, body, plane).clean());
    }
    double largest_gap() const {
        double largest = 0.0;
        for (const Vec3& x : simulation.positions(cloth)) largest = std::max(largest, x.y() - height(x.x()));
        return largest;
    }
};

}  // namespace

// m (v - v_n) = dt (F + m g), F the sum of the loads: backward Euler. Over whole periods the plane carries the weight. The waves,
// 1.3 % of their length high, go with 0.16 m/s^2 at most: the sheet stays on.
TEST_CASE("A rippling plane carries a sheet: in each step contact and weight make its momentum", "[law]") {
    for (const ContactResponse response : responses) {
        Ripples scene(response);
        for (int n = 0; n < 120; ++n) scene.step();
        const Vec3 start = momentum(scene.simulation, scene.cloth);
        Vec3 impulse = Vec3::Zero();
        double imbalance = 0.0, highest = 0.0;
        for (int n = 0; n < 120; ++n) {
            const Vec3 before = momentum(scene.simulation, scene.cloth);
            scene.step();
            const Vec3 force = -scene.simulation.force_on(scene.body) - Vec3(0.0, scene.weight, 0.0);
            const Vec3 change = momentum(scene.simulation, scene.cloth) - before;
            imbalance = std::max(imbalance, (change - dt * force).norm() / (dt * scene.weight));
            impulse += dt * force;
            highest = std::max(highest, scene.largest_gap());
        }
        const Vec3 left = impulse - (momentum(scene.simulation, scene.cloth) - start);
        const std::string name = "rippling plane, " + word(response);
        check_law(name + ": momentum of a step against its forces, of the weight", imbalance, 0.05);
        check_law(name + ": mean force of two periods less the weight, of it", left.norm() / (120 * dt * scene.weight), 1e-3);
        check_law(name + ": farthest vertex, thicknesses", highest / h, 1.2);
        check_law(name + ": where the sheet has gone, m", std::abs(mean(scene.simulation.positions(scene.cloth)).x() - aside),
                  2e-3);
    }
}

// v(t) = min(mu g t, u), whether the plane moves by its pose or by its vertices.
TEST_CASE("A plane whose vertices all move sideways carries cloth as one that is moved by its pose", "[law]") {
    constexpr double u = 0.6, mu = 0.2;
    for (const ContactResponse response : responses) {
        std::vector<Vec3> last[2];
        double apart = 0.0, wrong = 0.0;
        std::vector<double> speeds[2];
        for (const bool by_shape : {false, true}) {
            Plate scene(by_shape, {.contact_response = response}, {.friction = mu, .name = "plate"}, 0.9 * h);
            for (int n = 0; n < 60; ++n) step_well(scene.simulation);
            for (int n = 1; n <= 45; ++n) {
                scene.go_to({n * dt * u, 0.0, 0.0});
                step_well(scene.simulation);
                const Vec3 v = mean(scene.simulation.velocities(scene.cloth));
                speeds[by_shape].push_back(v.x());
                wrong = std::max(wrong, std::abs(v.x() - std::min(mu * g * n * dt, u)));
            }
            const auto x = scene.simulation.positions(scene.cloth);
            last[by_shape].assign(x.begin(), x.end());
        }
        for (std::size_t i = 0; i < speeds[0].size(); ++i) apart = std::max(apart, std::abs(speeds[0][i] - speeds[1][i]));
        check_law("plane by its vertices, " + word(response) + ": worst speed against min(mu g t, u), m/s", wrong, 0.02 * u);
        check_law("plane by its vertices, " + word(response) + ": worst speed against that by its pose, m/s", apart, 1e-6);
        check_law("plane by its vertices, " + word(response) + ": where it ends against that by its pose, m",
                  largest_distance(last[0], last[1]), 1e-6);
    }
}

// Where friction sticks, each point of the sheet moves with the point below: x = x0 (1 + s t). Where it does not, the forces of
// the two halves are opposite: no momentum, no strain.
TEST_CASE("A plane that stretches carries soft cloth along and gives stiff cloth no momentum", "[law]") {
    constexpr double s = 0.2;
    for (const bool soft : {true, false}) {
        for (const ContactResponse response : responses) {
            Fabric material = fabric(soft ? 0.01 : 1000.0);
            material.spring_damping = soft ? 1e-4 : 0.1;
            Plate scene(true, {.contact_response = response}, {.friction = soft ? 4.0 : 0.5, .name = "plane"}, 0.9 * h, material);
            for (int n = 0; n < 60; ++n) step_well(scene.simulation);
            const auto x = [&] { return scene.simulation.positions(scene.cloth); };
            const std::vector<Vec3> start(x().begin(), x().end());
            double drift = 0.0;
            for (int n = 1; n <= 60; ++n) {
                const Vec3 stretch(1.0 + s * n * dt, 1.0, 1.0);
                scene.simulation.deform_obstacle(scene.plate,
                                                 mapped(scene.mesh, [&](const Vec3& y) { return stretch.cwiseProduct(y); }));
                step_well(scene.simulation);
                drift =
                    std::max(drift, std::abs(mean(scene.simulation.velocities(scene.cloth)).x() - soft * s * mean(start).x()));
            }
            std::vector<Vec3> wanted = start;
            for (Vec3& y : wanted) y.x() *= soft ? 1.0 + s : 1.0;
            const Vec3 shift = mean(x()) - mean(wanted);
            for (Vec3& y : wanted) y += shift;
            const std::string name =
                std::string("plane stretched by a fifth, ") + (soft ? "soft" : "stiff") + " cloth, " + word(response);
            check_law(name + ": mean speed beside that of the plane there, m/s", drift, 5e-3);
            check_law(name + ": where it ends beside where it should, but for a shift, m", largest_distance(x(), wanted), 5e-4);
        }
    }
}

// A sheet that rests in the air is hit from below at v: it leaves at (1 + e) v; with friction mu and the plane moving sideways
// faster than that, the impulse mu m v gives it the speed mu v along.
TEST_CASE("A plane that is moved by its vertices hits cloth as one that is moved by its pose", "[law]") {
    constexpr double v = 1.0, mu = 0.25;
    const auto hit = [&](bool by_shape, ContactResponse response, double e, double sideways) {
        Plate scene(by_shape,
                    {.time_step = 1.0 / 120.0, .newton_tolerance = 1e-9, .contact_response = response, .gravity = Vec3::Zero()},
                    {.friction = mu, .restitution = e, .name = "plate"}, 0.06);
        for (int n = 1; n <= 24; ++n) {
            scene.go_to(n / 120.0 * Vec3(sideways, v, 0.0));
            step_well(scene.simulation);
        }
        return mean(scene.simulation.velocities(scene.cloth));
    };
    for (const ContactResponse response : responses) {
        for (const double e : {0.0, 0.5, 1.0}) {
            const Vec3 rigid = hit(false, response, e, 0.0), bent = hit(true, response, e, 0.0);
            const std::string name = "hit by a plane moved by its vertices, " + word(response) + ", e " + figure(e);
            check_law(name + ": speed against (1 + e) v, of v", std::abs(bent.y() / v - 1.0 - e), 1e-3);
            check_law(name + ": speed against that by a pose, m/s", (rigid - bent).norm(), 1e-5);
        }
        const Vec3 rigid = hit(false, response, 0.0, 0.6), bent = hit(true, response, 0.0, 0.6);
        const std::string name = "hit at a slant, " + word(response);
        // Penalty gives more: its forces last longer than the impact, and the removal of the rebound has no friction.
        if (response == ContactResponse::projection) {
            check_law(name + ": speed along against mu v, of v", std::abs(bent.x() / v - mu), 0.02);
        }
        check_law(name + ": speed against that by a pose, m/s", (rigid - bent).norm(), 1e-5);
    }
}

TEST_CASE("Cloth asleep on a deforming body wakes when its vertices move, and is carried along") {
    for (const Vec3& way : {Vec3(0.08, 0.0, 0.0), Vec3(0.0, 0.08, 0.0)}) {
        Plate scene(true, {}, {.friction = 0.8, .name = "plate"}, 0.8 * h);
        StepReport report;
        for (int n = 0; n < 300 && !report.slept; ++n) report = step_well(scene.simulation);
        REQUIRE(report.slept);
        scene.go_to(Vec3::Zero());  // the present place: no reason to wake
        CHECK(step_well(scene.simulation).slept);
        const Vec3 start = mean(scene.simulation.positions(scene.cloth));
        for (int n = 1; n <= 60; ++n) {
            const double part = n / 60.0;
            scene.go_to(part * part * (3.0 - 2.0 * part) * way);
            CHECK_FALSE(step_well(scene.simulation).slept);
        }
        CHECK((mean(scene.simulation.positions(scene.cloth)) - start - way).norm() < 0.2 * h);
        for (int n = 0; n < 300 && !report.slept; ++n) report = step_well(scene.simulation);
        CHECK(report.slept);
    }
}

TEST_CASE("A deforming body that keeps its shape is a rigid one for cloth on it") {
    // Flat faces, divided: their inner edges make no contacts on either.
    TriangleMesh block = make_sphere(0.1, 3);
    for (Vec3& x : block.vertices) x *= 0.1 / x.cwiseAbs().maxCoeff();
    for (const TriangleMesh& mesh : {make_grid(0.6, 0.6, 13, 13), make_box({0.2, 0.2, 0.2}), block, make_sphere(0.1, 2)}) {
        const double top =
            std::ranges::max(mapped(mesh, [](const Vec3& x) { return x; }), {}, [](const Vec3& x) { return x.y(); }).y();
        std::vector<std::vector<Vec3>> ends;
        for (const bool deforming : {false, true}) {
            Simulation simulation = simulation_on_meshes({});
            const ClothId cloth =
                simulation.add_cloth(make_grid(0.3, 0.3, 11, 11), fabric(), {.translation = {aside, top + h, behind}});
            simulation.add_obstacle(mesh, {}, {.friction = 0.4, .name = "body", .deforming = deforming});
            for (int n = 0; n < 40; ++n) step_well(simulation);
            ends.emplace_back(simulation.positions(cloth).begin(), simulation.positions(cloth).end());
        }
        CAPTURE(mesh.vertices.size());
        CHECK(largest_distance(ends[0], ends[1]) < 1e-3 * h);
    }
}

// At rest the loads F that the ball gives its cover and the springs of that are in balance at each vertex: summed with x,
// sum F . x = sum k (l - l0) l over springs. Its surface has grown as the square of its radius. With e the largest angle of an
// edge, facets of the ball are R (1 - cos(e/sqrt 3)) deep, and those of the cover, a thickness above the ball's vertices, end at
// no more than (R + h)/cos e.
TEST_CASE("A ball that is blown up in a ball of cloth stretches it to its own size, and presses as springs pull", "[law]") {
    constexpr double r0 = 0.21, first = 0.2, last = 0.25, k = 200.0;
    const TriangleMesh ball = make_sphere(1.0, 3);
    const TriangleMesh cover = placed(make_sphere(r0, 3), {.rotation = {std::cos(0.3), std::sin(0.3), 0.0, 0.0}});
    const double e = largest_edge(ball), sagitta = last * (1.0 - std::cos(e / std::sqrt(3.0))),
                 highest = (last + h) / std::cos(e);
    for (const ContactResponse response : responses) {
        Simulation simulation = simulation_on_meshes({.contact_response = response, .gravity = Vec3::Zero()});
        const ClothId cloth = simulation.add_cloth(cover, {.thickness = h, .springs = {.structural = k}, .spring_damping = 1.0});
        const ObstacleId body =
            simulation.add_obstacle(ball, {.scale = first}, {.friction = 0.3, .name = "ball", .deforming = true});
        for (int n = 1; n <= 120; ++n) {
            const double swollen = 1.0 + std::min(1.0, n / 60.0) * (last / first - 1.0);
            simulation.deform_obstacle(body, mapped(ball, [&](const Vec3& x) { return swollen * x; }));
            step_well(simulation);
            CHECK(certificate(simulation, cloth, cover, body, ball).clean());
        }
        const auto x = simulation.positions(cloth);
        double least = 1.0, most = 0.0, press = 0.0, radius = 0.0;
        for (const Vec3& y : x) {
            least = std::min(least, y.norm());
            most = std::max(most, y.norm());
            radius += y.norm() / static_cast<double>(x.size());
        }
        for (const ContactLoad& load : simulation.contact_loads(cloth)) press += load.force().dot(x[load.vertex]);
        const std::string name = "cloth round a ball blown up, " + word(response);
        const double gap = response == ContactResponse::penalty ? 0.5 * h : 0.98 * h;
        check_law_between(name + ": nearest vertex, thicknesses", (least - last) / h, (gap - sagitta) / h, 1.05);
        check_law_between(name + ": farthest vertex, thicknesses", (most - last) / h, gap / h, (highest - last) / h);
        check_law(name + ": press against pull, relative", std::abs(press / pull(cover, x, k) - 1.0), 0.01);
        const double grown = area(cover, x) / area(cover, cover.vertices);
        check_law(name + ": area against the square of the radius, relative", std::abs(grown / std::pow(radius / r0, 2) - 1.0),
                  2e-3);
    }
}

// A sleeve on a rigid pole of radius R, a ring about it of n corners that closes: its sides touch the pole at R/cos(pi/n), and
// with cloth between it cannot come there.
TEST_CASE("A ring that closes on a sleeve stops when there is no room, with a reason, and nothing has crossed", "[law]") {
    constexpr double pole = 0.1, dr = 0.001;
    constexpr int corners = 32;
    const double contact = pole / std::cos(std::numbers::pi / corners);
    const TriangleMesh sleeve = make_tube({.low = pole + 1.2 * h, .top = pole + 1.2 * h, .height = 0.2, .around = 24, .rows = 8});
    const TriangleMesh ring = inside_out(make_tube({.low = 0.13, .top = 0.13, .height = 0.1, .around = corners, .rows = 5}));
    const TriangleMesh inner = make_cylinder(pole, 0.4, 48);
    for (const ContactResponse response : responses) {
        Simulation simulation = simulation_on_meshes({.contact_response = response, .gravity = Vec3::Zero()});
        const ClothId cloth = simulation.add_cloth(sleeve, {.thickness = h, .springs = {.structural = 500.0}});
        const ObstacleId rigid = simulation.add_obstacle(inner, {}, {.name = "pole"});
        const ObstacleId closing = simulation.add_obstacle(ring, {}, {.name = "ring", .deforming = true});
        double radius = 0.13;
        StepReport report;
        std::uint64_t before = 0;
        while (report.ok() && radius > contact - 5.0 * dr) {
            before = simulation.state_hash();
            const double share = (radius - dr) / 0.13;
            simulation.deform_obstacle(closing,
                                       mapped(ring, [&](const Vec3& x) { return Vec3(share * x.x(), x.y(), share * x.z()); }));
            report = simulation.step();
            if (report.ok()) radius -= dr;
            const Certificate outside = certificate(simulation, cloth, sleeve, closing, ring);
            const Certificate inside = certificate(simulation, cloth, sleeve, rigid, inner);
            CAPTURE(radius, outside.smallest_distance, inside.smallest_distance);
            CHECK((outside.clean() && outside.smallest_distance > 0.0));
            CHECK((inside.clean() && inside.smallest_distance > 0.0));
        }
        CAPTURE(report.explanation());
        REQUIRE_FALSE(report.ok());
        CHECK(report.status == StepStatus::obstacle_too_fast);
        CHECK(simulation.state_hash() == before);
        CHECK(report.explanation().find("ring") != std::string::npos);
        check_law_between("ring that closes on a sleeve, " + word(response) + ": room left where it stops, m", radius - contact,
                          0.0, 2.0 * h + dr);
    }
}

TEST_CASE("Cloth that starts inside a deforming ball is pushed out as out of a rigid one") {
    const TriangleMesh ball = make_sphere(0.2, 3), sheet = make_grid(0.3, 0.3, 13, 13);
    const auto start = [&](bool deforming, double size, StartRule rule) {
        Simulation simulation = simulation_on_meshes({.start = rule});
        const ClothId cloth = simulation.add_cloth(sheet, fabric(), {.translation = {0.0, 0.19, 0.0}});
        const ObstacleId body = simulation.add_obstacle(ball, {}, {.name = "ball", .deforming = deforming});
        if (size != 1.0) simulation.deform_obstacle(body, mapped(ball, [&](const Vec3& x) { return size * x; }));
        simulation.prepare();
        CHECK(certificate(simulation, cloth, sheet, body, ball).clean());
        return simulation;
    };
    const Simulation rigid = start(false, 1.0, StartRule::repair), bent = start(true, 1.0, StartRule::repair);
    REQUIRE(bent.start_repair().size() == 1);
    CHECK(bent.start_repair()[0].largest_move > h);
    CHECK(bent.start_repair()[0].largest_move == Approx(rigid.start_repair()[0].largest_move).margin(1e-12));
    CHECK(largest_distance(rigid.positions({0}), bent.positions({0})) < 1e-9);
    CHECK_THROWS_AS(start(true, 1.0, StartRule::refuse), StartError);
    // The ball keeps its first place until a step has been made.
    CHECK_THROWS_AS(start(true, 0.9, StartRule::refuse), StartError);
}

TEST_CASE("A refused start is good once the body has another shape, and cloth placed into a new shape is pushed out") {
    const TriangleMesh ball = make_sphere(0.2, 3), sheet = make_grid(0.3, 0.3, 13, 13);
    const auto sized = [&](double size) { return mapped(ball, [&](const Vec3& x) { return size * x; }); };
    Simulation simulation = simulation_on_meshes({.start = StartRule::refuse});
    const ClothId cloth = simulation.add_cloth(sheet, fabric(), {.translation = {0.0, 0.19, 0.0}});
    const ObstacleId body = simulation.add_obstacle(ball, {}, {.name = "ball", .deforming = true});
    CHECK_THROWS_AS(simulation.step(), StartError);
    simulation.deform_obstacle(body, sized(0.9));
    step_well(simulation);
    CHECK(certificate(simulation, cloth, sheet, body, ball).clean());
    const std::vector<Vec3> low(simulation.positions(cloth).begin(), simulation.positions(cloth).end());
    for (int n = 1; n <= 30; ++n) {
        simulation.deform_obstacle(body, sized(0.9 + 0.01 * n));
        step_well(simulation);
    }
    simulation.set_positions(cloth, low);  // now inside
    CHECK_THROWS_AS(simulation.step(), StartError);
}

}  // namespace percale::test::deforming_laws_test
