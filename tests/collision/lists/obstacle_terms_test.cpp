#include "collision/lists/obstacle_terms.h"

#include <algorithm>
#include <cmath>

#include "percale/detectors.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/collision/smooth_potential.h"
#include "tests/support/collision/truth.h"
#include "tests/support/random.h"

namespace percale::test::obstacle_terms_test {
namespace {

constexpr double h = 0.2;

constexpr SmoothPotential smooth{h};

struct Above {
    std::unique_ptr<ContactDetector> detector = make_brute_force_detector();
    ContactConstraints constraints;

    /// A small triangle of cloth, whose first vertex is examined; the others lie far away.
    explicit Above(const TriangleMesh& obstacle) {
        detector->set_cloth(std::vector<Triangle>{{0, 1, 2}}, std::vector{h, 1e-3, 1e-3});
        detector->add_obstacle(obstacle, {}, 0.0);
    }

    struct Sum {
        double energy = 0.0;
        Vec3 gradient = Vec3::Zero();
        int terms = 0;
        double factors = 0.0;
    };
    Sum sum_at(const Vec3& place) {
        detector->find_contacts(std::vector<Vec3>{place, place + Vec3(0, 5, 0), place + Vec3(0.1, 5, 0)}, 1.0, constraints);
        Sum sum;
        for (std::size_t i = 0; i < constraints.size(); ++i) {
            if (constraints.vertex[i] != std::array{0, -1, -1, -1}) continue;
            CHECK((place - constraints.obstacle_point[i] - constraints.distance[i] * constraints.direction[i]).norm() < 1e-12);
            sum.energy += constraints.mollifier[i] * smooth.at(constraints.distance[i]);
            sum.gradient += constraints.mollifier[i] * smooth.slope(constraints.distance[i]) * constraints.direction[i];
            sum.factors += constraints.mollifier[i];
            ++sum.terms;
        }
        return sum;
    }
};

/// Three sheets that share one edge: a fin on a roof.
TriangleMesh fin() {
    return {.vertices = {{-1, 0, 0}, {1, 0, 0}, {0, -0.3, 1}, {0, -0.4, -1}, {0.2, 1, 0.1}},
            .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 1, 4}}};
}

/// The formula of surface_terms.h, term by term.
double formula(const TriangleMesh& mesh, const Vec3& p) {
    const ObstacleSurface surface = make_surface(mesh.vertices, mesh.triangles);
    const std::vector<Vec3>& x = surface.vertices;
    double sum = 0.0;
    for (const Triangle& t : surface.triangles)
        sum += smooth.at(std::sqrt(closest_on_triangle(p, x[t[0]], x[t[1]], x[t[2]]).distance_squared));
    std::vector<double> factor(x.size(), 1.0);
    for (int e = 0; e < static_cast<int>(surface.edges.size()); ++e) {
        const auto [a, b] = surface.edges[e].vertex;
        const double around = static_cast<double>(surface.opposites(e).size());
        const double s = std::clamp((x[b] - x[a]).dot(p - x[a]) / (x[b] - x[a]).squaredNorm(), 0.0, 1.0);
        sum -= (around - 1.0) * smooth.at((p - x[a] - s * (x[b] - x[a])).norm());
        for (const int v : {a, b}) factor[v] += 0.5 * around - 1.0;
    }
    for (std::size_t v = 0; v < x.size(); ++v) sum += factor[v] * smooth.at((p - x[v]).norm());
    return sum;
}

Obstacle make(const TriangleMesh& mesh, const Pose& pose) { return {mesh, pose, 0.5, make_brute_force_tree}; }

/// The sum of the factors of a vertex' constraints with a body, and the distance of the last.
int factors_of(const Obstacle& obstacle, const Vec3& x, double& distance) {
    int sum = 0;
    for (int f = 0; f < static_cast<int>(obstacle.surface().triangles.size()); ++f) {
        const ContactPair pair{.kind = PairKind::vertex_face, .cloth = {0, -1, -1}, .feature = f};
        const SurfaceTerms terms = obstacle_terms(pair, std::vector<Vec3>{x}, obstacle, 0.0, h);
        for (const SurfaceTerm& term : std::span(terms.terms).first(terms.count)) {
            sum += term.factor;
            distance = term.distance;
        }
    }
    return sum;
}

}  // namespace

TEST_CASE("a vertex above a flat obstacle has one constraint, wherever it is") {
    Above floor(make_grid(1, 1, 5, 5));
    for (const Vec3& place : {Vec3(0.13, 0, 0.08), Vec3(0.0, 0, 0.1), Vec3(0.25, 0, 0.25), Vec3(0, 0, 0), Vec3(0.5, 0, 0.125),
                              Vec3(-0.5, 0, -0.5), Vec3(-0.51, 0, -0.51), Vec3(0.125, 0, 0.125)}) {
        const Above::Sum sum = floor.sum_at(place + Vec3(0, 0.05, 0));
        CHECK(sum.terms == 1);
        CHECK(sum.factors == 1.0);
    }
}

TEST_CASE("constraints of a vertex with an obstacle are the sum of faces less edges and vertices, and its gradient") {
    Random random(GENERATE(5U, 6U));
    const TriangleMesh mesh = GENERATE_REF(crumpled_sheet(1, 6, 0.12, random), fin(), make_box({0.3, 0.3, 0.3}));
    Above obstacle(mesh);
    int several = 0;
    for (int round = 0; round < 1000; ++round) {
        const Vec3 place(random.number(-0.6, 0.6), random.number(-0.2, 0.3), random.number(-0.6, 0.6));
        const Above::Sum sum = obstacle.sum_at(place);
        CHECK(sum.energy == Approx(formula(mesh, place)).epsilon(1e-9).margin(1e-12));
        const Vec3 along = random.unit();
        const double step = 1e-6, ahead = obstacle.sum_at(place + step * along).energy,
                     behind = obstacle.sum_at(place - step * along).energy;
        CHECK((ahead - behind) / (2.0 * step) == Approx(sum.gradient.dot(along)).epsilon(1e-4).margin(1e-5));
        several += sum.terms > 1;
    }
    CHECK(several > 20);  // places in a valley
}

TEST_CASE("a vertex beside a convex body is pushed exactly once, wherever its closest point lies") {
    const TriangleMesh mesh = GENERATE(make_sphere(0.5, 1), make_box({0.8, 0.6, 0.7}), make_cylinder(0.3, 0.8, 7));
    Random random(80);
    const Obstacle obstacle = make(mesh, random.pose(0.3));
    const ObstacleSurface& surface = obstacle.surface();
    int wrong = 0, misplaced = 0;
    const auto normal = [&](int f) {
        const auto [a, b, c] = surface.triangles[f];
        return Vec3((obstacle.at(b, 0) - obstacle.at(a, 0)).cross(obstacle.at(c, 0) - obstacle.at(a, 0)).normalized());
    };
    const auto expect_one = [&](const Vec3& foot, const Vec3& direction) {
        const double height = random.decades(1e-6, 0.1);
        double distance = 0.0;
        wrong += factors_of(obstacle, foot + height * direction, distance) == 1 ? 0 : 1;
        misplaced += std::abs(distance - height) > 1e-13 ? 1 : 0;
    };
    for (int f = 0; f < int(surface.triangles.size()); ++f) {
        const auto [a, b, c] = surface.triangles[f];
        const double u = random.number(0.1, 0.4), v = random.number(0.1, 0.4);
        expect_one((1 - u - v) * obstacle.at(a, 0) + u * obstacle.at(b, 0) + v * obstacle.at(c, 0), normal(f));
    }
    std::vector<std::vector<int>> around(surface.vertices.size()), beside(surface.edges.size());
    for (int f = 0; f < int(surface.triangles.size()); ++f) {
        for (const int v : surface.triangles[f]) around[v].push_back(f);
        for (const int e : surface.triangle_edges[f]) beside[e].push_back(f);
    }
    const auto inside_cone = [&](const std::vector<int>& faces) {
        Vec3 sum = Vec3::Zero();
        for (const int f : faces) sum += random.number(0.2, 1.0) * normal(f);
        return Vec3(sum.normalized());
    };
    for (int e = 0; e < int(surface.edges.size()); ++e) {
        if (!surface.edges[e].can_touch) continue;
        const double t = random.number(0.1, 0.9);
        const auto [a, b] = surface.edges[e].vertex;
        expect_one((1 - t) * obstacle.at(a, 0) + t * obstacle.at(b, 0), inside_cone(beside[e]));
    }
    for (int v = 0; v < int(surface.vertices.size()); ++v) {
        if (surface.vertex_can_touch[v]) expect_one(obstacle.at(v, 0), inside_cone(around[v]));
    }
    CHECK(wrong == 0);
    CHECK(misplaced == 0);
}

TEST_CASE("a vertex above a flat diagonal is pushed once, at its height") {
    Random random(90);
    const Obstacle obstacle = make(make_plane(1.0), random.pose(0.5));
    const ObstacleSurface& surface = obstacle.surface();
    const auto flat = std::find_if(surface.edges.begin(), surface.edges.end(), [](const SurfaceEdge& e) { return !e.can_touch; });
    REQUIRE(flat != surface.edges.end());
    const auto [a, b, c] = surface.triangles[0];
    const Vec3 up = (obstacle.at(b, 0) - obstacle.at(a, 0)).cross(obstacle.at(c, 0) - obstacle.at(a, 0)).normalized();
    for (int i = 0; i < 2000; ++i) {
        const double t = random.number(0.0, 1.0), height = random.decades(1e-6, 0.1);
        const Vec3 foot = (1 - t) * obstacle.at(flat->vertex[0], 0) + t * obstacle.at(flat->vertex[1], 0);
        double distance = -1.0;
        // Rounding takes it for the inside of a face, of both less the edge, or for the edge.
        CHECK(factors_of(obstacle, foot + height * up, distance) == 1);
        CHECK(distance == Approx(height).margin(1e-15));
    }
}

TEST_CASE("triangles without area and edges without length do not push twice") {
    // A square of which one side has a vertex in its middle, with a triangle without area there; and a fan with an edge of no
    // length.
    const TriangleMesh folded{.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0.5, 0, 0}},
                              .triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}}};
    const TriangleMesh pinched{.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0.4, 0, 0.4}, {0.4, 0, 0.4}},
                               .triangles = {{0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {3, 5, 4}, {3, 4, 0}}};
    Random random(8);
    for (const TriangleMesh& mesh : {folded, pinched}) {
        for (int turn = 0; turn < 5; ++turn) {
            const Pose pose = turn == 0 ? Pose{} : random.pose(0.5);
            // Deforming bodies keep such triangles. Merging vertices at one place would make the second one another mesh.
            TriangleMesh start = mesh;
            if (mesh.vertices.size() == 6) start.vertices[5] += Vec3(0.01, 0.0, 0.0);
            Obstacle obstacle(placed(start, pose), {}, 0.5, make_brute_force_tree, SurfaceShape::deforming);
            const std::vector<Vec3> now = placed(mesh, pose).vertices;
            obstacle.deform(now, now);
            int wrong = 0;
            for (int round = 0; round < 300; ++round) {
                const double height = random.decades(1e-3, 0.15);
                Vec3 place(random.number(0.0, 1.0), height, round % 2 == 0 ? 0.0 : random.number(0.0, 1.0));
                place = placed({.vertices = {place}, .triangles = {}}, pose).vertices[0];
                double distance = -1.0;
                wrong += factors_of(obstacle, place, distance) == 1 && std::abs(distance - height) < 1e-12 ? 0 : 1;
            }
            CAPTURE(mesh.vertices.size(), turn);
            CHECK(wrong <= 3);  // above an end of the line rounding decides between two edges and their corner
        }
    }
}

TEST_CASE("the places of constraints move with an obstacle that turns") {
    Random random(7);
    const TriangleMesh mesh = make_sphere(0.3, 1);
    Above sphere(mesh);
    const Pose start = random.pose(0.02), end = random.pose(0.02);
    sphere.detector->move_obstacle(0, start, end);
    int seen = 0;
    for (int round = 0; round < 200; ++round) {
        const Vec3 place = 0.4 * random.unit();
        const double fraction = random.number(0.0, 1.0), step = 1e-7;
        sphere.detector->find_contacts(std::vector<Vec3>{place, place + Vec3(0, 5, 0), place + Vec3(0.1, 5, 0)}, fraction,
                                       sphere.constraints);
        for (std::size_t i = 0; i < sphere.constraints.size(); ++i) {
            // d/dfraction of the distance = -direction . displacement, as the closest point is stationary.
            ContactConstraints ahead;
            sphere.detector->find_contacts(std::vector<Vec3>{place, place + Vec3(0, 5, 0), place + Vec3(0.1, 5, 0)},
                                           fraction + step, ahead);
            if (ahead.feature != sphere.constraints.feature) continue;
            ++seen;
            CHECK((ahead.distance[i] - sphere.constraints.distance[i]) / step ==
                  Approx(-sphere.constraints.direction[i].dot(sphere.constraints.obstacle_displacement[i])).margin(1e-5));
        }
    }
    CHECK(seen > 100);
}

}  // namespace percale::test::obstacle_terms_test
