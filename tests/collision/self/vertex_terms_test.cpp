#include "collision/self/vertex_terms.h"

#include <algorithm>
#include <cmath>

#include "collision/geometry/triangle_distance.h"
#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/collision/smooth_potential.h"
#include "tests/support/collision/truth.h"
#include "tests/support/random.h"

namespace percale::test::vertex_terms_test {
namespace {

constexpr double h = 0.2;

constexpr SmoothPotential smooth{h};

/// A vertex, the last one, and a surface.
struct Above {
    std::vector<Vec3> x;
    SelfCloth cloth;

    explicit Above(const TriangleMesh& surface) : x(surface.vertices) {
        x.push_back(Vec3::Zero());
        cloth.surface = make_cloth_surface(surface.triangles, x.size());
        cloth.sewn = SewnRest(cloth.surface, {}, x, 0.0);
    }
    int vertex() const { return static_cast<int>(x.size()) - 1; }

    /// The terms of all faces with the vertex there, as (factor, distance, direction).
    struct Sum {
        double energy = 0.0;
        Vec3 gradient = Vec3::Zero();
        int terms = 0, factors = 0;
    };
    Sum sum_at(const Vec3& place) {
        x.back() = place;
        Sum sum;
        const auto& triangles = cloth.surface.triangles;
        for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
            if (!cloth.meets(vertex(), t)) continue;
            const SelfPair pair{.vertex = {vertex(), triangles[t][0], triangles[t][1], triangles[t][2]},
                                .feature = {vertex(), t},
                                .thickness = h};
            const SurfaceTerms terms = vertex_terms(pair, x, cloth);
            for (const SurfaceTerm& term : std::span(terms.terms).first(terms.count)) {
                Vec3 apart = place;
                for (int k = 0; k < 3; ++k) apart -= term.weight[k] * x[triangles[t][k]];
                CHECK((apart - term.apart).norm() < 1e-12);
                CHECK(term.distance < h);
                sum.energy += term.factor * smooth.at(term.distance);
                sum.gradient += term.factor * smooth.slope(term.distance) * term.apart / term.distance;
                sum.factors += term.factor;
                ++sum.terms;
            }
        }
        return sum;
    }

    /// The formula of the header, term by term.
    double formula_at(const Vec3& place) const {
        double sum = 0.0;
        std::vector<int> inner(x.size(), 1);
        for (const Triangle& t : cloth.surface.triangles)
            sum += smooth.at(std::sqrt(closest_on_triangle(place, x[t[0]], x[t[1]], x[t[2]]).distance_squared));
        for (const ClothSurface::Edge& edge : cloth.surface.edges) {
            const auto [a, b] = edge.vertex;
            if (edge.triangle[1] < 0) {
                inner[a] = inner[b] = 0;
                continue;
            }
            const Vec3 along = x[b] - x[a];
            const double s = std::clamp(along.dot(place - x[a]) / along.squaredNorm(), 0.0, 1.0);
            sum -= smooth.at((place - x[a] - s * along).norm());
        }
        for (int v = 0; v < vertex(); ++v) sum += inner[v] * smooth.at((place - x[v]).norm());
        return sum;
    }
};

Vec3 near_sheet(Random& random) { return {random.number(-0.6, 0.6), random.number(-0.2, 0.2), random.number(-0.6, 0.6)}; }

}  // namespace

TEST_CASE("the terms of a vertex above flat cloth are one, wherever it is") {
    Above sheet(make_grid(1, 1, 5, 5));
    for (const Vec3& place : {Vec3(0.13, 0, 0.08), Vec3(0.0, 0, 0.1), Vec3(0.25, 0, 0.25), Vec3(0, 0, 0), Vec3(0.5, 0, 0.125),
                              Vec3(0.53, 0, 0.03), Vec3(-0.5, 0, -0.5), Vec3(-0.51, 0, -0.51), Vec3(0.125, 0, 0.125)}) {
        const Above::Sum sum = sheet.sum_at(place + Vec3(0, 0.05, 0));
        CHECK(sum.factors == 1);
        CHECK(sum.energy == Approx(sheet.formula_at(place + Vec3(0, 0.05, 0))).epsilon(1e-12));
    }
    Random random(2);
    for (int round = 0; round < 500; ++round) {
        const Vec3 place(random.number(-0.5, 0.5), 0.1, random.number(-0.5, 0.5));
        CHECK(sheet.sum_at(place).energy == Approx(smooth.at(0.1)).epsilon(1e-12));
    }
}

TEST_CASE("a ridge and a peak are one term, a valley is both slopes less its edge") {
    const auto roof = [](double fall) {
        return TriangleMesh{.vertices = {{-1, 0, 0}, {1, 0, 0}, {0, -fall, 1}, {0, -fall, -1}},
                            .triangles = {{0, 2, 1}, {0, 1, 3}}};
    };
    Above ridge(roof(0.3)), valley(roof(-0.3));
    CHECK(ridge.sum_at({0.1, 0.1, 0.0}).terms == 1);
    CHECK(valley.sum_at({0.1, 0.1, 0.0}).terms == 3);
    CHECK(valley.sum_at({0.1, 0.1, 0.0}).factors == 1);
}

TEST_CASE("the terms of a vertex are the formula's sum, and their directions its gradient") {
    Random random(GENERATE(5U, 6U, 7U));
    Above sheet(crumpled_sheet(1, 6, 0.12, random));
    int several = 0;
    for (int round = 0; round < 3000; ++round) {
        const Vec3 place = near_sheet(random);
        const Above::Sum sum = sheet.sum_at(place);
        CHECK(sum.energy == Approx(sheet.formula_at(place)).epsilon(1e-9).margin(1e-12));
        const Vec3 along = random.unit();
        const double step = 1e-6, ahead = sheet.sum_at(place + step * along).energy,
                     behind = sheet.sum_at(place - step * along).energy;
        CHECK((ahead - behind) / (2.0 * step) == Approx(sum.gradient.dot(along)).epsilon(1e-4).margin(1e-5));
        several += sum.terms > 2;
    }
    CHECK(several > 100);
}

TEST_CASE("faces that hold the vertex itself are no part of the surface that it meets") {
    // The vertex is a corner of the sheet: what is left has a boundary around it.
    Random random(4);
    const TriangleMesh whole = crumpled_sheet(1, 5, 0.1, random);
    TriangleMesh left = whole;
    const int own = 12;
    std::erase_if(left.triangles, [&](const Triangle& t) { return std::ranges::count(t, own) > 0; });
    Above rest(left);
    SelfCloth cloth;
    cloth.surface = make_cloth_surface(whole.triangles, whole.vertices.size());
    cloth.sewn = SewnRest(cloth.surface, {}, whole.vertices, 0.0);
    for (int round = 0; round < 300; ++round) {
        std::vector<Vec3> x = whole.vertices;
        x[own] = near_sheet(random);
        double energy = 0.0;
        for (int t = 0; t < static_cast<int>(whole.triangles.size()); ++t) {
            const Triangle& c = whole.triangles[t];
            if (!cloth.meets(own, t)) continue;
            const SelfPair pair{.vertex = {own, c[0], c[1], c[2]}, .feature = {own, t}, .thickness = h};
            const SurfaceTerms terms = vertex_terms(pair, x, cloth);
            for (const SurfaceTerm& term : std::span(terms.terms).first(terms.count))
                energy += term.factor * smooth.at(term.distance);
        }
        CHECK(energy == Approx(rest.sum_at(x[own]).energy).epsilon(1e-12).margin(1e-14));
    }
}

}  // namespace percale::test::vertex_terms_test
