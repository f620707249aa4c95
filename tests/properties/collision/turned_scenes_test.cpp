// No decision of contact depends on the axes or the numbers of triangles: a scene that is turned as a whole, or renumbered,
// departs from the plain one no faster than one that rounding disturbs.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "percale/detectors.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"
#include "tests/support/laws.h"

namespace percale::test::turned_scenes_test {
namespace {

using Matrix = Eigen::Matrix3d;

constexpr double size = 0.5;         // m, of the sheet, to which differences are relative
constexpr int steps_in_contact = 2;  // compared after the one in which the sheet meets the body

/// Turning disturbs all positions in every step, the others are disturbed at the start only; if the owner of edges depends on
/// the axes these ratios are 2e4 to 5e5.
constexpr double max_growth = 300.0;

struct Scene {
    const char* name;
    TriangleMesh body;
    double height;  // m, of the sheet
};

std::vector<Scene> scenes() {
    TriangleMesh box = make_box({0.25, 0.15, 0.2});
    for (Vec3& x : box.vertices) x = Eigen::AngleAxisd(0.2, Vec3(0.2, 0.3, 1.0).normalized()) * x;
    return {{"ball", make_sphere(0.15, 3), 0.18}, {"box", box, 0.14}};
}

Matrix turn_about(const Vec3& axis, double degrees) {
    return Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis.normalized()).toRotationMatrix();
}

/// Coordinates are exchanged and change their signs: nothing is rounded.
Matrix exact_turn(const Vec3& axis, double degrees) {
    Matrix turn = turn_about(axis, degrees);
    for (double& entry : turn.reshaped()) entry = std::round(entry);
    return turn;
}

/// The sheet is tilted and no cell is like another: otherwise rounding decides between two equally near features.
TriangleMesh sheet_above(double height) {
    TriangleMesh sheet = make_grid(size, size, 17, 17);
    Random random(8);
    const Matrix tilt = turn_about({0.2, 1.0, 0.1}, 17.0);
    for (Vec3& x : sheet.vertices) x = tilt * x + Vec3(0.01, height, 0.02) + random.point(1e-3);
    return sheet;
}

struct Variant {
    Matrix turn = Matrix::Identity();
    double disturbance = 0.0;  // m, of each coordinate at the start
    unsigned seed = 1;
    bool shuffled = false;  // the order of the sheet's triangles
};

struct Path {
    std::vector<Vec3> before, after;  // the last positions without contact, and those some steps later; turned back
};

std::vector<Vec3> turned_back(const Matrix& turn, std::span<const Vec3> positions) {
    std::vector<Vec3> points;
    for (const Vec3& x : positions) points.push_back(turn.transpose() * x);
    return points;
}

Path path_of(const Scene& scene, const Variant& variant, StepSettings settings) {
    settings.gravity = variant.turn * settings.gravity;
    Simulation simulation(settings, make_brute_force_detector());
    TriangleMesh sheet = sheet_above(scene.height), body = scene.body;
    Random random(variant.seed);
    for (Vec3& x : sheet.vertices) x = variant.turn * (x + random.point(1.0) * variant.disturbance);
    for (Vec3& x : body.vertices) x = variant.turn * x;
    if (variant.shuffled) std::shuffle(sheet.triangles.begin(), sheet.triangles.end(), std::mt19937(variant.seed));
    const ClothId cloth = simulation.add_cloth(sheet, sheet_fabric());
    simulation.add_obstacle(body, {}, {.friction = 0.4});
    Path path;
    for (int in_contact = 0; in_contact <= steps_in_contact;) {
        if (in_contact == 0) path.before = turned_back(variant.turn, simulation.positions(cloth));
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        REQUIRE(simulation.time() < 1.0);
        if (in_contact > 0 || std::isfinite(report.smallest_distance)) ++in_contact;
    }
    path.after = turned_back(variant.turn, simulation.positions(cloth));
    return path;
}

/// Distance of a path from the plain one, relative to the sheet.
double apart_before(const Path& a, const Path& b) { return largest_difference(a.before, b.before) / size; }
double apart_after(const Path& a, const Path& b) { return largest_difference(a.after, b.after) / size; }

}  // namespace

TEST_CASE("A turned or renumbered scene departs from the plain one in contact no faster than by rounding", "[law]") {
    const auto response = GENERATE(ContactResponse::penalty, ContactResponse::projection);
    // Where Newton's method ends by its time error depends on rounding: two steps then amplify 1e-15 to 1e-5.
    const StepSettings settings{.time_step = 1.0 / 240.0, .newton_tolerance = 1e-8, .contact_response = response};
    // The matrix keeps springs as floats, which a general turn rounds anew. Newton's method then goes another way, and with
    // projection, whose rounds converge linearly, it ends elsewhere within its tolerance.
    const double solved = response == ContactResponse::penalty ? 0.0 : *settings.newton_tolerance;
    const std::string ending = response == ContactResponse::penalty ? ", penalty: " : ", projection: ";
    for (const Scene& scene : scenes()) {
        const Path plain = path_of(scene, {}, settings);
        double disturbed = 0.0;  // the farthest of an ensemble
        for (const unsigned seed : {1U, 2U, 3U, 4U}) {
            const Variant variant{.disturbance = seed % 2 == 0 ? 1e-15 : 1e-16, .seed = seed};
            disturbed = std::max(disturbed, apart_after(plain, path_of(scene, variant, settings)));
        }
        double before = 0.0, exact = 0.0, general = 0.0;
        for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
            for (const double degrees : {90.0, 180.0}) {
                const Path path = path_of(scene, {.turn = exact_turn(axis, degrees)}, settings);
                before = std::max(before, apart_before(plain, path));
                exact = std::max(exact, apart_after(plain, path));
            }
        }
        for (const double degrees : {40.0, 110.0}) {
            const Path path = path_of(scene, {.turn = turn_about({-2.0, 1.0, 1.3}, degrees)}, settings);
            before = std::max(before, apart_before(plain, path));
            general = std::max(general, apart_after(plain, path));
        }
        double numbered = 0.0;
        for (const unsigned seed : {1U, 2U, 3U}) {
            numbered = std::max(numbered, apart_after(plain, path_of(scene, {.seed = seed, .shuffled = true}, settings)));
        }
        const std::string on = std::string("scene turned, grid on a ") + scene.name + ending;
        check_law(on + "relative difference before it meets the body", before, 1e-12);
        check_law(on + "difference over that of disturbed scenes, quarter and half turns", exact / disturbed, max_growth);
        check_law(on + "difference over what is allowed, other turns", general / (max_growth * disturbed + solved), 1.0);
        check_law(on + "difference over that of disturbed scenes, triangles renumbered", numbered / disturbed, max_growth);
    }
}

}  // namespace percale::test::turned_scenes_test
