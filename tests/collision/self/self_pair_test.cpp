#include "collision/self/self_pair.h"

#include <algorithm>
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/collision/truth.h"
#include "tests/support/random.h"

namespace percale::test::self_pair_test {
namespace {

/// Two sheets whose features are paired: the lower has the first vertices.
struct TwoSheets {
    TriangleMesh mesh;
    int upper = 0;  // first vertex of the upper sheet
    ClothSurface surface;

    TwoSheets(const TriangleMesh& lower, const TriangleMesh& above)
        : mesh(joined(lower, above)),
          upper(static_cast<int>(lower.vertices.size())),
          surface(make_cloth_surface(mesh.triangles, mesh.vertices.size())) {}

    std::vector<SelfPair> vertex_face_pairs() const {
        std::vector<SelfPair> pairs;
        for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
            for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
                const Triangle& corner = mesh.triangles[t];
                if ((v < upper) != (corner[0] < upper)) pairs.push_back(pair(v, corner, t));
            }
        }
        return pairs;
    }
    std::vector<SelfPair> edge_pairs() const {
        std::vector<SelfPair> pairs;
        for (int e = 0; e < static_cast<int>(surface.edges.size()); ++e) {
            for (int f = e + 1; f < static_cast<int>(surface.edges.size()); ++f) {
                const auto &a = surface.edges[e].vertex, &b = surface.edges[f].vertex;
                if ((a[0] < upper) == (b[0] < upper)) continue;
                pairs.push_back(
                    {.shape = PairShape::edge_edge, .vertex = {a[0], a[1], b[0], b[1]}, .feature = {e, f}, .thickness = 1e3});
            }
        }
        return pairs;
    }
    static SelfPair pair(int vertex, const Triangle& t, int triangle) {
        return {.vertex = {vertex, t[0], t[1], t[2]}, .feature = {vertex, triangle}};
    }
    EdgeContact contact(const SelfPair& pair) const { return edge_contact(pair, mesh.vertices, surface); }
    double total_activation(const std::vector<SelfPair>& pairs, double nearer_than) const {
        double sum = 0.0;
        for (const SelfPair& p : pairs) {
            if (self_distance(p, mesh.vertices) < nearer_than) sum += contact(p).activation_ratio;
        }
        return sum;
    }
};

const TriangleMesh roof{.vertices = {{-1, 0, 0}, {1, 0, 0}, {0, -0.5, 1}, {0, -0.5, -1}}, .triangles = {{0, 2, 1}, {0, 1, 3}}};

/// The activation ratio of the ridge of the roof with the first edge of a sheet, at a thickness.
double ratio_with_roof(const TriangleMesh& sheet, double thickness) {
    const TwoSheets crossing(roof, sheet);
    const auto pairs = crossing.edge_pairs();
    const auto ridges = std::find_if(pairs.begin(), pairs.end(), [](const SelfPair& p) {
        return p.vertex == std::array<int, 4>{0, 1, 4, 5};
    });
    REQUIRE(ridges != pairs.end());
    SelfPair pair = *ridges;
    pair.thickness = thickness;
    return crossing.contact(pair).activation_ratio;
}

}  // namespace

TEST_CASE("weights and direction of two features of cloth give the distance between them") {
    Random random(8);
    for (int round = 0; round < 20; ++round) {
        const TwoSheets sheets(crumpled_sheet(1, 4, 0.2, random), moved(crumpled_sheet(1, 4, 0.2, random), {0, 0.8, 0}));
        const auto& x = sheets.mesh.vertices;
        for (const SelfPair& pair : sheets.edge_pairs()) {
            const EdgeContact contact = sheets.contact(pair);
            const auto& v = pair.vertex;
            const double truth = true_edge_edge(x[v[0]], x[v[1]], x[v[2]], x[v[3]]);
            CHECK(contact.distance == Approx(truth).epsilon(1e-9).margin(1e-12));
            CHECK(self_distance(pair, x) == Approx(contact.distance).epsilon(1e-12));
            Vec3 apart = Vec3::Zero();
            double sum = 0.0;
            for (int k = 0; k < 4; ++k) {
                apart += contact.weight[k] * x[v[k]];
                sum += contact.weight[k];
                CHECK((k < 2 ? contact.weight[k] >= 0.0 : contact.weight[k] <= 0.0));
            }
            CHECK(sum == Approx(0.0).margin(1e-14));
            CHECK(contact.direction.dot(apart) == Approx(contact.distance).epsilon(1e-9).margin(1e-12));
            CHECK(contact.direction.norm() == Approx(1.0));
        }
    }
}

TEST_CASE("two ridges that cross are in contact through their edges") {
    const TriangleMesh gutter{.vertices = {{0, 0.1, -1}, {0, 0.1, 1}, {1, 0.6, 0}, {-1, 0.6, 0}},
                              .triangles = {{0, 1, 2}, {0, 3, 1}}};
    const TwoSheets crossing(roof, gutter);
    CHECK(crossing.total_activation(crossing.edge_pairs(), 0.2) == 1.0);
}

TEST_CASE(
    "as cloth bends from a ridge to a valley the activation ratio of its edge falls from 1 over 3/4 to 0, linearly on each "
    "side") {
    // Its edge crosses that of the roof 0.1 above; its faces fall or rise, the one by less.
    const auto activation_distance_at = [&](double fall, double other_fall) {
        const TriangleMesh fold{.vertices = {{0, 0.1, -1}, {0, 0.1, 1}, {0.1, 0.1 + fall, 0}, {-0.1, 0.1 + other_fall, 0}},
                                .triangles = {{0, 1, 2}, {0, 3, 1}}};
        return ratio_with_roof(fold, 1e3);
    };
    CHECK(activation_distance_at(0.05, 0.05) == 1.0);
    CHECK(activation_distance_at(0.0, 0.0) == Approx(0.75));
    CHECK(activation_distance_at(-0.05, -0.05) == 0.0);
    CHECK(activation_distance_at(0.05, 0.0) == Approx(0.75));
    const double step = 1e-4, max_change = 0.75 / 0.3 * (step / 0.1) * 1.001;  // 3/4 over a sine of 0.3
    double before = activation_distance_at(-0.05, -0.05);
    for (double fall = -0.05 + step; fall < 0.05; fall += step) {
        const double now = activation_distance_at(fall, fall + 0.001);
        CHECK(now >= before);
        CHECK(now - before <= max_change);
        CHECK(activation_distance_at(fall + 0.001, fall) == Approx(now));
        before = now;
    }
}

TEST_CASE("edges that cross near an end lose their contact there, linearly") {
    const double thickness = 0.4;
    // The edge of the gutter crosses that of the roof 0.05 above it, `place` from its end.
    const auto ratio_at = [&](double place) {
        const TriangleMesh gutter{.vertices = {{0, 0.05, -place}, {0, 0.05, 2 - place}, {1, 0.55, 0}, {-1, 0.55, 0}},
                                  .triangles = {{0, 1, 2}, {0, 3, 1}}};
        return ratio_with_roof(gutter, thickness);
    };
    const double faded = 0.5 * thickness;
    for (const double part : {0.0, 1e-9, 0.25, 0.5, 0.99})
        for (const double place : {part * faded, 2.0 - part * faded}) CHECK(ratio_at(place) == Approx(part).margin(1e-12));
    for (const double place : {faded, 0.5, 1.0, 1.5}) CHECK(ratio_at(place) == Approx(1.0));
}

TEST_CASE("edges that cross in flat sheets wait for three quarters of the thickness, parallel ones are left to their ends") {
    const Pose turned{.translation = {0.03, 0.01, 0.02}, .rotation = {std::cos(0.2), 0, std::sin(0.2), 0}, .scale = 1.0};
    const TwoSheets crossed(make_grid(1, 1, 4, 4), placed(make_grid(1, 1, 4, 4), turned));
    int inner = 0;
    for (const SelfPair& pair : crossed.edge_pairs()) {
        const EdgeContact contact = crossed.contact(pair);
        const bool boundary =
            crossed.surface.edges[pair.feature[0]].triangle[1] < 0 && crossed.surface.edges[pair.feature[1]].triangle[1] < 0;
        if (!boundary) CHECK(contact.activation_ratio <= 0.75 + 1e-9);
        inner += std::abs(contact.activation_ratio - 0.75) < 1e-9;
    }
    CHECK(inner > 10);
    const TwoSheets parallel(make_grid(1, 1, 4, 4), moved(make_grid(1, 1, 4, 4), {0, 0.01, 0}));
    for (const SelfPair& pair : parallel.edge_pairs()) {
        const auto &a = parallel.surface.edges[pair.feature[0]].vertex, &b = parallel.surface.edges[pair.feature[1]].vertex;
        const auto& x = parallel.mesh.vertices;
        if ((x[a[1]] - x[a[0]]).cross(x[b[1]] - x[b[0]]).norm() < 1e-12) CHECK(parallel.contact(pair).activation_ratio == 0.0);
    }
}

TEST_CASE("edges at a small angle are in contact where their ends are too far apart to hold them") {
    // Two edges 1 m long that cross at 0.01 rad in their middles, as ridges without faces below.
    TriangleMesh lower{.vertices = {{-0.5, 0, 0}, {0.5, 0, 0}, {0, -0.3, 0.3}}, .triangles = {{0, 1, 2}}};
    TriangleMesh upper{.vertices = {{-0.5, 0, -0.005}, {0.5, 0, 0.005}, {0, 0.3, 0.3}}, .triangles = {{0, 1, 2}}};
    const double gap = 1e-4;
    const TwoSheets sheets(lower, moved(upper, {0, gap, 0}));
    const std::vector<SelfPair> pairs = sheets.edge_pairs();
    const auto crossing = std::find_if(pairs.begin(), pairs.end(), [](const SelfPair& p) {
        return p.vertex == std::array<int, 4>{0, 1, 3, 4};
    });
    REQUIRE(crossing != pairs.end());
    SelfPair pair = *crossing;
    CHECK(sheets.contact(pair).crossing == 0.0);
    CHECK(sheets.contact(pair).activation_ratio == 0.0);
    // Over its length the edge rises by 10 mm: more than a fifth of this thickness.
    pair.thickness = 0.04;
    CHECK(sheets.contact(pair).crossing > 0.2);
    CHECK(sheets.contact(pair).activation_ratio == Approx(0.01 / (0.2 * 0.04) - 1.0).epsilon(1e-3));
    CHECK(sheets.contact(pair).distance == Approx(gap));
    pair.thickness = 0.02;  // twice that
    CHECK(sheets.contact(pair).activation_ratio == 1.0);
    pair.thickness = 0.06;
    CHECK(sheets.contact(pair).crossing == 0.0);
}

TEST_CASE("near a seam the thickness is each corner's there, between them in between, and the same from pair to pair") {
    Random random(7);
    // Of vertices a and b with c, d and e.
    const std::array of_a{0.001, 0.002, 0.004}, of_b{0.003, 0.0015, 0.005};
    const SelfPair face{.vertex = {0, 2, 3, 4}, .thickness = 1.0}, next{.vertex = {0, 5, 3, 2}, .thickness = 1.0};
    const SelfPair edges{.shape = PairShape::edge_edge, .vertex = {0, 1, 2, 3}, .thickness = 1.0};
    using Four = std::array<double, 4>;
    const auto of_face = [&](const Four& weight) {
        return activation_distance_at(face, {of_a[0], of_a[1], of_a[2], no_seam}, weight);
    };
    const auto of_next = [&](const Four& weight) {
        return activation_distance_at(next, {0.009, of_a[1], of_a[0], no_seam}, weight);
    };
    const auto of_edges = [&](const Four& weight) {
        return activation_distance_at(edges, {of_a[0], of_a[1], of_b[0], of_b[1]}, weight);
    };
    CHECK(of_face({1, -1, 0, 0}) == of_a[0]);
    CHECK(of_face({1, 0, 0, -1}) == of_a[2]);
    CHECK(of_edges({0, 1, 0, -1}) == of_b[1]);
    for (int n = 0; n < 100; ++n) {
        const double s = random.number(0, 1), t = random.number(0, 1);
        CHECK(of_face({1, -s, s - 1, 0}) == Approx(s * of_a[0] + (1 - s) * of_a[1]));
        CHECK(of_face({1, -s, s - 1, 0}) == Approx(of_next({1, 0, s - 1, -s})));
        CHECK(of_face({1, -s, s - 1, 0}) == Approx(of_edges({1, 0, -s, s - 1})));
        const double crossing = of_edges({1 - s, s, t - 1, -t});
        CHECK((crossing > 0.001 && crossing < 0.003));
    }
    CHECK(activation_distance_at(face, away_from_seams, {1, -0.3, -0.3, -0.4}) == 1.0);
    SelfPair thin = face;
    thin.thickness = 0.0005;
    CHECK(activation_distance_at(thin, {of_a[0], of_a[1], of_a[2], no_seam}, {1, 0, 0, -1}) == 0.0005);
}

TEST_CASE("a pair moves with its four vertices") {
    Random random(2);
    std::vector<Vec3> from, to;
    for (int i = 0; i < 6; ++i) {
        from.push_back(random.point(1.0));
        to.push_back(random.point(1.0));
    }
    const MovingFour four = moving_pair({.vertex = {5, 0, 3, 1}}, from, to);
    for (int k = 0; k < 4; ++k) {
        const int v = std::array{5, 0, 3, 1}[k];
        CHECK(four.from[k] == from[v]);
        CHECK(four.to[k] == to[v]);
    }
}

}  // namespace percale::test::self_pair_test
