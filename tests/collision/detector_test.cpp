#include "collision/detector.h"

#include <algorithm>

#include "tests/support/catch.h"
#include "tests/support/collision/pairs.h"
#include "tests/support/collision/scenes.h"
#include "tests/support/collision/truth.h"
#include "tests/support/random.h"

namespace percale::test::detector_test {
namespace {

/// The same scene with every backend of the build.
std::vector<Steps> with_all_backends(Scene scene, const TriangleMesh& cloth) {
    std::vector<Steps> all;
    for (const Backend& backend : backends()) all.push_back(make_steps(scene, cloth, backend));
    return all;
}

void give_poses(std::vector<Steps>& all, bool moving, Random& random) {
    set_poses(all[0], moving, random);
    for (Steps& steps : all) {
        steps.obstacles = all[0].obstacles;
        steps.report_poses();
    }
}

/// A clear place for the cloth at the start of the step: far outside, or a random one.
std::vector<Vec3> clean_start(const Steps& steps, Random& random) {
    for (int attempt = 0; attempt < 20; ++attempt) {
        TriangleMesh here = placed(steps.cloth, random.pose(0.0));
        const std::vector<Vec3> x = shifted(here, random.number(0.1, 0.6) * random.unit(), 0.01, random);
        if (steps.clean(x, 0.0)) return x;
    }
    return shifted(steps.cloth, {0.0, 2.0, 0.0}, 0.0, random);
}

struct ClampOutcome {
    int moves = 0, cut = 0, bad = 0;
};

/// One clamped move, certified at several times during it and at its end. Returns the positions at its end.
std::vector<Vec3> clamp_move(Steps& steps, std::span<const Vec3> from, std::span<const Vec3> to, StepFraction& part,
                             ClampOutcome& outcome) {
    const double safe = steps.detector->collision_free_step_size(from, to, part);
    ++outcome.moves;
    outcome.cut += safe < 1.0 ? 1 : 0;
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
        const double f = share * safe, fraction = part.from + f * (part.to - part.from);
        outcome.bad += steps.clean(between(from, to, f), fraction) ? 0 : 1;
    }
    part.from += safe * (part.to - part.from);
    return between(from, to, safe);
}

/// A step as a solver does it: a prediction, then corrections from where the clamp left it while the obstacles are at the end or
/// move on.
void random_step(Steps& steps, std::vector<Vec3>& x, double speed, Random& random, ClampOutcome& outcome) {
    const auto aim = [&] {
        const Vec3 way = random.index(2) == 0 ? Vec3(-random.number(0.2, 2.0) * x[x.size() / 2]) : random.point(speed);
        return shifted({.vertices = x, .triangles = {}}, way, 0.2 * speed, random);
    };
    StepFraction part{0.0, 1.0};
    std::vector<Vec3> to = aim();
    steps.detector->update_candidates(x, to);
    for (int k = 0; k < 4; ++k) {
        x = clamp_move(steps, x, to, part, outcome);
        to = aim();
    }
}

}  // namespace

TEST_CASE("all backends give the same constraints to the last bit and the same clamps", "[slow]") {
    const Scene scene = GENERATE(Scene::ball, Scene::box, Scene::spiky, Scene::two, Scene::plane);
    const bool moving = GENERATE(false, true);
    Random random(300 + static_cast<int>(scene));
    const TriangleMesh sheet = make_grid(0.5, 0.5, 7, 7);
    std::vector<Steps> all = with_all_backends(scene, sheet);
    int with_constraints = 0, differing = 0;
    for (int state = 0; state < 60; ++state) {
        if (moving || state % 10 == 0) give_poses(all, moving, random);
        const auto x = shifted(placed(sheet, random.pose(0.0)), random.point(0.3), 0.03, random);
        const auto to = shifted({.vertices = x, .triangles = {}}, random.point(0.1), 0.03, random);
        const double fraction = random.number(0.0, 1.0);
        std::vector<ContactConstraints> constraints(all.size());
        std::vector<double> cuts, nearest;
        for (std::size_t b = 0; b < all.size(); ++b) {
            if (state % 2 == 0) all[b].detector->update_candidates(x, to);
            all[b].detector->find_contacts(x, fraction, constraints[b]);
            nearest.push_back(all[b].detector->smallest_distance());
            cuts.push_back(all[b].detector->collision_free_step_size(x, to, {fraction, 1.0}));
        }
        with_constraints += constraints[0].size() > 0 ? 1 : 0;
        for (std::size_t b = 1; b < all.size(); ++b) {
            differing +=
                same_constraints(constraints[b], constraints[0]) && cuts[b] == cuts[0] && nearest[b] == nearest[0] ? 0 : 1;
        }
    }
    CHECK(with_constraints > 25);
    CHECK(differing == 0);
}

TEST_CASE("every constraint satisfies the equation of its header, and the nearest is the smallest distance of the meshes",
          "[slow]") {
    const Scene scene = GENERATE(Scene::ball, Scene::box, Scene::spiky, Scene::two, Scene::single_triangle);
    Random random(340 + static_cast<int>(scene));
    Steps steps = make_steps(scene, small_sheet(), backends().back());
    int near = 0;
    for (int state = 0; state < 25; ++state) {
        set_poses(steps, true, random);
        std::vector<Vec3> x = clean_start(steps, random);
        StepFraction part{0.0, 1.0};
        ClampOutcome outcome;
        x = clamp_move(steps, x, shifted({.vertices = x, .triangles = {}}, -1.5 * x[12], 0.02, random), part, outcome);
        ContactConstraints constraints;
        steps.detector->find_contacts(x, part.from, constraints);
        double least = infinity, worst = 0.0, off_point = 0.0;
        for (std::size_t i = 0; i < constraints.size(); ++i) {
            Vec3 point = Vec3::Zero();
            double sum = 0.0;
            for (int k = 0; k < 4 && constraints.vertex[i][k] >= 0; ++k) {
                point += constraints.weight[i][k] * x[constraints.vertex[i][k]];
                sum += constraints.weight[i][k];
            }
            worst = std::max(
                worst, std::abs(constraints.direction[i].dot(point - constraints.obstacle_point[i]) - constraints.distance[i]));
            worst = std::max({worst, std::abs(sum - 1.0), std::abs(constraints.direction[i].norm() - 1.0)});
            off_point = std::max(off_point, true_mesh_distance({.vertices = std::vector<Vec3>(3, constraints.obstacle_point[i]),
                                                                .triangles = {{0, 1, 2}}},
                                                               steps.obstacles[constraints.obstacle[i]].at(part.from)));
            CHECK(constraints.friction[i] == 0.1 * constraints.obstacle[i]);
            CHECK(constraints.thickness[i] == sheet_thickness);
            CHECK(constraints.distance[i] > 0.0);
            CHECK(constraints.distance[i] < sheet_thickness);
            least = std::min(least, constraints.distance[i]);
        }
        CHECK(worst < 1e-14);
        CHECK(off_point < 1e-14);
        TriangleMesh here = steps.cloth;
        here.vertices = x;
        double truth = infinity;
        for (const MovingMesh& o : steps.obstacles) truth = std::min(truth, true_mesh_distance(here, o.at(part.from)));
        if (truth < sheet_thickness) {
            ++near;
            CHECK(least == Approx(truth).margin(1e-13));
            CHECK(steps.detector->smallest_distance() == Approx(truth).margin(1e-13));
        } else {
            CHECK(constraints.size() == 0);
            CHECK(steps.detector->smallest_distance() >= sheet_thickness);
        }
    }
    CHECK(near > 5);
}

TEST_CASE("after a clamp nothing crosses, on thousands of random moves through resting and moving obstacles", "[slow]") {
    const Scene scene = GENERATE(Scene::ball, Scene::box, Scene::spiky, Scene::two, Scene::single_triangle, Scene::plane);
    const bool moving = GENERATE(false, true);
    Random random(360 + static_cast<int>(scene));
    Steps steps = make_steps(scene, small_sheet(), backends().back());
    ClampOutcome outcome;
    for (int run = 0; run < 60; ++run) {
        set_poses(steps, moving, random);
        std::vector<Vec3> x = clean_start(steps, random);
        if (!steps.clean(x, 0.0)) continue;
        for (int step = 0; step < 3; ++step) {
            random_step(steps, x, random.decades(0.01, 1.0), random, outcome);
            if (!moving) continue;
            // The next step starts where the obstacle was left: only a whole step may be followed by another one.
            break;
        }
    }
    CHECK(outcome.moves > 200);
    CHECK(outcome.cut > 70);
    CHECK(outcome.bad == 0);
}

TEST_CASE("steps follow each other: obstacles that sweep through a sheet over many steps never cross it") {
    const Scene scene = GENERATE(Scene::ball, Scene::spiky, Scene::single_triangle);
    Random random(380 + static_cast<int>(scene));
    Steps steps = make_steps(scene, small_sheet(), backends().back());
    set_poses(steps, false, random);
    std::vector<Vec3> x = clean_start(steps, random);
    ClampOutcome outcome;
    int finished = 0;
    for (int step = 0; step < 60; ++step) {
        for (MovingMesh& o : steps.obstacles) o.start = o.end, o.end = turned_further(o.start, 0.02, random);
        for (MovingMesh& o : steps.obstacles) o.end.rotation = o.start.rotation;
        steps.report_poses();
        const auto to = shifted({.vertices = x, .triangles = {}},
                                steps.obstacles[0].end.translation - steps.obstacles[0].start.translation, 0.003, random);
        steps.detector->update_candidates(x, to);
        StepFraction part{0.0, 1.0};
        for (int k = 0; k < 60 && part.from < 1.0; ++k) x = clamp_move(steps, x, to, part, outcome);
        if (part.from < 1.0) break;  // the cloth cannot follow: a solver would move it aside
        ++finished;
    }
    CHECK(finished > 0);
    CHECK(outcome.bad == 0);
}

TEST_CASE("a vertex at 100 m a step never gets through a single triangle, nor does one that the triangle outruns") {
    Random random(400);
    const TriangleMesh cloth{.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0, 0, 0.01}}, .triangles = {{0, 1, 2}}};
    Steps steps = make_steps(Scene::single_triangle, cloth, backends().back());
    int through = 0, hits = 0, free = 0;
    for (int i = 0; i < 1500; ++i) {
        const bool obstacle_moves = i % 3 == 0;
        const Vec3 way = 100.0 * random.unit(), aim(random.number(-0.3, 0.3), 0.0, random.number(-0.2, 0.4));
        if (std::abs(way.y()) < 1.0) continue;
        const double meet = random.number(0.1, 0.9);
        const Pose pose = steps.obstacles[0].start;
        Pose end = pose;
        if (obstacle_moves) end.translation -= way;
        steps.obstacles[0].end = end;
        steps.report_poses();
        const auto start = shifted(cloth, aim - meet * way, 0.0, random);
        const auto to = obstacle_moves ? start : shifted({.vertices = start, .triangles = {}}, way, 0.0, random);
        const double safe = steps.detector->collision_free_step_size(start, to, {0.0, 1.0});
        // The plane of the triangle is y = 0, in its own frame.
        bool crossing = false;
        for (int v = 0; v < 3; ++v) {
            const Vec3 x = start[v] + meet * way;
            crossing = crossing || (x.z() > -0.2 && x.z() < 0.4 - 2.0 * std::abs(x.x()));
        }
        if (!crossing) {
            ++free;
            continue;
        }
        ++hits;
        through += safe >= meet + 0.02 ? 1 : 0;
        TriangleMesh here = cloth;
        here.vertices = between(start, to, safe);
        through += steps.obstacles[0].free_of(here, safe) ? 0 : 1;
        // All of the cloth is still on the side it came from.
        const double side = start[0].y() > 0 ? 1.0 : -1.0;
        const double plane = safe * (end.translation.y() - pose.translation.y());
        const bool beyond =
            std::any_of(here.vertices.begin(), here.vertices.end(), [&](const Vec3& x) { return side * (x.y() - plane) <= 0.0; });
        through += safe > 0.0 && beyond && safe < meet ? 1 : 0;
    }
    CHECK(hits > 400);
    CHECK(free > 100);
    CHECK(through == 0);
}

TEST_CASE("a move that meets nothing is not clamped") {
    Random random(410);
    Steps steps = make_steps(Scene::ball, small_sheet(), backends().back());
    for (int i = 0; i < 100; ++i) {
        const auto x = shifted(steps.cloth, {0.0, 0.5, 0.0}, 0.05, random);
        CHECK(steps.detector->collision_free_step_size(x, shifted(steps.cloth, {0.3, 0.45, 0.2}, 0.05, random), {0.0, 1.0}) ==
              1.0);
        const auto away = shifted({.vertices = x, .triangles = {}}, {0.0, i == 50 ? 100.0 : 1.0, 0.0}, 0.0, random);
        CHECK(steps.detector->collision_free_step_size(x, away, {0.0, 1.0}) == 1.0);
    }
}

TEST_CASE("clamps leave a fifth of the thickness, half of the distance, and never less than a thousandth of the thickness") {
    const TriangleMesh cloth{.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0, 0, 0.01}}, .triangles = {{0, 1, 2}}};
    Steps steps = make_steps(Scene::plane, cloth, backends().back());
    Random random(420);
    const auto left_after = [&](double height) {
        const auto from = shifted(cloth, {0.1, height, 0.13}, 0.0, random), to = shifted(cloth, {0.1, -1.0, 0.13}, 0.0, random);
        return between(from, to, steps.detector->collision_free_step_size(from, to, {0.0, 1.0}))[0].y();
    };
    for (const double height : {10.0, 1.0, 0.1, 0.5 * sheet_thickness}) {
        CHECK(left_after(height) > 0.2 * sheet_thickness);
        CHECK(left_after(height) < 0.2 * sheet_thickness + 0.101 * (height - 0.2 * sheet_thickness));
    }
    for (const double height : {0.39 * sheet_thickness, 0.1 * sheet_thickness, 0.01 * sheet_thickness}) {
        CHECK(left_after(height) > 0.5 * height);
        CHECK(left_after(height) < 0.56 * height);
    }
    CHECK(left_after(1.5e-3 * sheet_thickness) > 1e-3 * sheet_thickness);
    CHECK(left_after(1e-5 * sheet_thickness) > 0.998e-5 * sheet_thickness);
    double height = 1.0;
    for (int i = 0; i < 50; ++i) height = left_after(height);
    CHECK(height > 1e-3 * sheet_thickness);
}

TEST_CASE("the lists of a step do not lose contacts when the cloth outruns the prediction") {
    Random random(430);
    Steps predicted = make_steps(Scene::spiky, small_sheet(), backends()[0]);
    Steps fresh = make_steps(Scene::spiky, small_sheet(), backends()[0]);
    int with_constraints = 0, differing = 0;
    for (int i = 0; i < 60; ++i) {
        const auto x = shifted(predicted.cloth, {0.0, 0.6, 0.0}, 0.02, random);
        const auto far = shifted(predicted.cloth, random.point(0.3), 0.05, random);
        ContactConstraints a, b;
        for (Steps* steps : {&predicted, &fresh}) steps->detector->update_candidates(x, x);
        predicted.detector->find_contacts(far, 0.5, a);
        fresh.detector->update_candidates(far, far);
        fresh.detector->find_contacts(far, 0.5, b);
        with_constraints += b.size() > 0 ? 1 : 0;
        differing += same_constraints(a, b) ? 0 : 1;
    }
    CHECK(with_constraints > 20);
    CHECK(differing == 0);
}

}  // namespace percale::test::detector_test
