#include "collision/lists/contact_pair.h"

#include <algorithm>
#include <cmath>

#include "percale/certify.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/pairs.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/collision/truth.h"
#include "tests/support/random.h"

namespace percale::test::contact_pair_test {
namespace {

Obstacle make(const TriangleMesh& mesh, const Pose& pose = {}) { return {mesh, pose, 0.5, make_brute_force_tree}; }

/// A moving obstacle of one of several kinds.
Obstacle moving_obstacle(int number, Random& random) {
    const TriangleMesh meshes[] = {make_sphere(0.5, 1), make_box({0.8, 0.6, 0.7}), spiky_ball(0.5, 1, 0.3, 9), make_plane(0.6),
                                   moved(l_solid(), {-1, -1, -0.5})};
    Obstacle obstacle = make(meshes[number], random.pose(0.2));
    const Pose start = random.pose(0.2);
    Pose end = start;
    end.translation += random.point(0.1);
    end.rotation = random.rotation();
    obstacle.move(start, end);
    return obstacle;
}

/// A small sheet beside the obstacle, as close as it gets without crossing.
TriangleMesh beside(const TriangleMesh& obstacle, Random& random) {
    TriangleMesh sheet = crumpled_sheet(0.5, 3, 0.05, random);
    const Pose turn = random.pose(0.0);
    sheet = placed(sheet, turn);
    const Vec3 way = random.unit();
    double near = 0.0, far = 3.0;
    while (far - near > 0.02) {
        const double middle = 0.5 * (near + far);
        const Certificate certificate = certify(moved(sheet, middle * way), obstacle, 0.0);
        (certificate.clean() && certificate.touching_pairs == 0 ? far : near) = middle;
    }
    return moved(sheet, far * way);
}

Vec3 cloth_point(const ContactPair& pair, const PairContact& contact, std::span<const Vec3> x) {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < pair.cloth_count(); ++k) sum += contact.weight[k] * x[pair.cloth[k]];
    return sum;
}

}  // namespace

TEST_CASE("the point of action of edges moves smoothly from end to end as they turn through the parallel") {
    constexpr double thickness = 0.005, length = 0.02;
    const Obstacle box = make(make_box({1.0, 1.0, 1.0}));
    const auto& edges = box.surface().edges;
    const auto upper = [&](int vertex) { return box.at(vertex, 0.0).y() > 0.0 && box.at(vertex, 0.0).z() > 0.0; };
    const auto edge =
        std::find_if(edges.begin(), edges.end(), [&](const auto& e) { return upper(e.vertex[0]) && upper(e.vertex[1]); });
    REQUIRE(edge != edges.end());
    const ContactPair pair{.kind = PairKind::edge_edge, .cloth = {0, 1, -1}, .feature = static_cast<int>(edge - edges.begin())};
    double before = 0.0, jump = 0.0, closest_before = 0.5, closest_jump = 0.0;
    int whole = 0;
    for (int i = -20000; i <= 20000; ++i) {
        const double angle = 5e-6 * i;
        // Above the upper edge along x, the place where they cross going from the middle past one end and back from the other.
        const Vec3 middle(0.0, 0.5 + 0.004, 0.5 + 1e-5 * length),
            half(0.5 * length * std::cos(angle), 0.0, 0.5 * length * std::sin(angle));
        const std::vector<Vec3> cloth{middle - half, middle + half};
        const PairContact contact = pair_contact(pair, cloth, box, 0.0);
        const double share = edge_mollifier(contact, thickness);
        if (i == 0) CHECK(share == 0.0);
        whole += share == 1.0 ? 1 : 0;
        jump = std::max(jump, std::abs(share * (contact.weight[1] - 0.5) - before));
        closest_jump = std::max(closest_jump, std::abs(contact.weight[1] - closest_before));
        before = share * (contact.weight[1] - 0.5);
        closest_before = contact.weight[1];
    }
    CHECK(closest_jump > 0.3);
    CHECK(jump < 1e-3);
    CHECK(whole > 30000);
    // Where the mollifier begins to shrink, the ends are a thousandth of the thickness farther away than the middle.
    const double sine = std::sqrt(8e-3) * thickness / length;
    const double rise = std::hypot(thickness, 0.5 * length * sine) - thickness;
    CHECK(rise == Approx(1e-3 * thickness).epsilon(1e-3));
    CHECK(edge_mollifier({.crossing = 0.999 * length * sine}, thickness) < 1.0);
    CHECK(edge_mollifier({.crossing = 1.001 * length * sine}, thickness) == 1.0);
}

TEST_CASE("every contact obeys direction . (sum of weighted cloth vertices - obstacle point) = distance, at any fraction") {
    const int number = GENERATE(0, 1, 2, 3, 4);
    Random random(50 + number);
    double worst = 0.0, off_point = 0.0, off_way = 0.0;
    int bad_weights = 0, disagreeing = 0;
    for (int round = 0; round < 6; ++round) {
        const Obstacle obstacle = moving_obstacle(number, random);
        const TriangleMesh sheet = placed(crumpled_sheet(0.5, 3, 0.1, random), random.pose(0.6));
        const double fraction = random.number(0.0, 1.0);
        for (const ContactPair& pair : all_pairs(sheet, obstacle, false)) {
            if (pair.kind == PairKind::vertex_face) continue;
            const PairContact contact = pair_contact(pair, sheet.vertices, obstacle, fraction);
            const Vec3 apart = cloth_point(pair, contact, sheet.vertices) - contact.obstacle_point;
            worst = std::max(worst, std::abs(contact.direction.dot(apart) - contact.distance));
            off_point = std::max(off_point, (cloth_point(pair, contact, sheet.vertices) - contact.cloth_point).norm());
            const auto& w = contact.weight;
            const bool good = *std::min_element(w.begin(), w.end()) >= 0.0 && std::abs(w[0] + w[1] + w[2] + w[3] - 1.0) < 1e-15;
            bad_weights += good && (contact.distance == 0.0 || std::abs(contact.direction.norm() - 1.0) < 1e-14) ? 0 : 1;
            disagreeing += std::abs(pair_distance(pair, sheet.vertices, obstacle, fraction) - contact.distance) > 1e-14 ? 1 : 0;
            // The obstacle point, taken along, moves by its displacement in a whole step.
            if (pair.kind == PairKind::face_vertex) {
                off_way = std::max(off_way, (contact.obstacle_displacement - obstacle.displacement(pair.feature)).norm());
            }
        }
    }
    CHECK(worst < 1e-14);
    CHECK(off_point < 1e-15);
    CHECK(off_way == 0.0);
    CHECK(bad_weights == 0);
    CHECK(disagreeing == 0);
}

TEST_CASE("an obstacle that only shifts displaces every contact point by its shift") {
    Random random(60);
    Obstacle obstacle = make(make_sphere(0.5, 1));
    const Vec3 shift(0.1, -0.2, 0.05);
    const Pose start = random.pose(0.1);
    Pose end = start;
    end.translation += shift;
    obstacle.move(start, end);
    const TriangleMesh sheet = moved(crumpled_sheet(0.5, 3, 0.1, random), {0.1, 0.8, 0.0});
    for (const ContactPair& pair : all_pairs(sheet, obstacle, false)) {
        if (pair.kind == PairKind::vertex_face) continue;
        const PairContact contact = pair_contact(pair, sheet.vertices, obstacle, 0.4);
        if ((contact.obstacle_displacement - shift).norm() > 1e-15)
            FAIL("displacement " << contact.obstacle_displacement.transpose());
    }
}

TEST_CASE("the smallest distance of the pairs that can touch is the smallest of all triangles, and a contact reports it") {
    const int number = GENERATE(0, 1, 2, 3, 4);
    Random random(70 + number);
    for (int round = 0; round < 8; ++round) {
        const Obstacle obstacle = moving_obstacle(number, random);
        const double fraction = random.number(0.0, 1.0);
        const TriangleMesh body = mesh_at(obstacle, fraction);
        const TriangleMesh sheet = beside(body, random);
        double every = 1e300, touchable = 1e300, reported = 1e300;
        for (const ContactPair& pair : all_pairs(sheet, obstacle, false)) {
            every = std::min(every, pair_distance(pair, sheet.vertices, obstacle, fraction));
        }
        for (const ContactPair& pair : all_pairs(sheet, obstacle, true)) {
            const double distance = pair_distance(pair, sheet.vertices, obstacle, fraction);
            touchable = std::min(touchable, distance);
            if (makes_contact(pair, sheet.vertices, obstacle, fraction, 2.0)) reported = std::min(reported, distance);
        }
        const double truth = true_mesh_distance(sheet, body);
        CHECK(std::abs(every - truth) < 1e-13);
        CHECK(std::abs(touchable - truth) < 1e-13);
        CHECK(std::abs(reported - truth) < 1e-13);
    }
}

TEST_CASE("an edge across a ridge is one contact of these two edges, a spike under a face one of vertex and face") {
    const Obstacle box = make(make_box({1, 1, 1}));
    const std::vector<Vec3> across{{0.0, 0.55, 0.1}, {0.55, 0.0, -0.1}};  // over the ridge x = y = 0.5
    int edges = 0, faces = 0;
    for (int e = 0; e < int(box.surface().edges.size()); ++e) {
        const PairContact contact =
            pair_contact({.kind = PairKind::edge_edge, .cloth = {0, 1, -1}, .feature = e}, across, box, 0.0);
        edges += contact.local_minimum ? 1 : 0;
    }
    CHECK(edges == 0);  // it crosses the box: no feature is faced from outside
    const std::vector<Vec3> above{{0.3, 0.8, 0.1}, {0.8, 0.3, -0.1}};
    for (int e = 0; e < int(box.surface().edges.size()); ++e) {
        const PairContact contact =
            pair_contact({.kind = PairKind::edge_edge, .cloth = {0, 1, -1}, .feature = e}, above, box, 0.0);
        edges += contact.local_minimum ? 1 : 0;
        if (contact.local_minimum) CHECK(contact.distance == Approx(0.1 / std::sqrt(2.0)));
    }
    CHECK(edges == 1);

    const std::vector<Vec3> lid{{-1, 1.1, 1.5}, {2.0, 1.1, 1.5}, {0.5, 1.1, -1.0}};
    const Obstacle spike = make({.vertices = {{0.5, 1.0, 0.6}, {0.6, 0, 0.1}, {0.4, 0, 0.1}, {0.5, 0, -0.2}},
                                 .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
    REQUIRE(spike.surface().watertight);
    for (int v = 0; v < 4; ++v) {
        const PairContact contact =
            pair_contact({.kind = PairKind::face_vertex, .cloth = {0, 1, 2}, .feature = v}, lid, spike, 0.0);
        faces += contact.local_minimum ? 1 : 0;
        if (contact.local_minimum) CHECK(spike.at(v, 0.0) == Vec3(0.5, 1.0, 0.6));
    }
    CHECK(faces == 1);
}

TEST_CASE("an obstacle vertex under a cloth edge is reported by the triangle that owns the edge") {
    const Obstacle spike = make({.vertices = {{0, 1, 0}, {0.1, 0, 0.1}, {-0.1, 0, 0.1}, {0, 0, -0.1}},
                                 .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
    // A roof whose ridge lies over the spike, seen from below.
    const std::vector<Vec3> cloth{{-1, 1.2, 0}, {1, 1.2, 0}, {0, 1.8, 1}, {0, 1.8, -1}};
    const auto reported = [&](std::array<int, 3> t, unsigned char bits) {
        return pair_contact({.kind = PairKind::face_vertex, .cloth = t, .edge_bits = bits, .feature = 0}, cloth, spike, 0.0)
            .local_minimum;
    };
    CHECK(reported({0, 1, 2}, 1));
    CHECK_FALSE(reported({0, 1, 2}, 6));
    CHECK(reported({3, 1, 0}, 2));
    CHECK_FALSE(reported({3, 1, 0}, 5));
}

TEST_CASE("an obstacle vertex beside a cloth edge is one contact, whichever triangle owns the edge") {
    const Obstacle spike = make({.vertices = {{0, 1, 0}, {0.1, 0, 0.1}, {-0.1, 0, 0.1}, {0, 0, -0.1}},
                                 .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
    const Triangle left{0, 1, 2}, right{1, 0, 3};
    Random random(91);
    // Flat cloth, a ridge or a valley over the spike; the edge off it by `aside`.
    for (int i = 0; i < 2000; ++i) {
        const double aside = random.number(-0.3, 0.3), slope = i % 3 == 0 ? 0.0 : random.number(-0.5, 0.5);
        const std::vector<Vec3> cloth{
            {-1, 1.2, aside}, {1, 1.2, aside}, {0, 1.2 + slope, 1 + aside}, {0, 1.2 + slope, -1 + aside}};
        std::array<int, 2> reports{0, 0};  // where the left one owns the edge, where the right one does
        for (const bool left_owns : {true, false}) {
            for (const bool of_left : {true, false}) {
                const ContactPair pair{.kind = PairKind::face_vertex,
                                       .cloth = of_left ? left : right,
                                       .edge_bits = static_cast<unsigned char>(of_left == left_owns ? 7 : 6),
                                       .across = {of_left ? 3 : 2, -1, -1},
                                       .feature = 0};
                reports[left_owns ? 0 : 1] += pair_contact(pair, cloth, spike, 0.0).local_minimum ? 1 : 0;
            }
        }
        CAPTURE(aside, slope);
        CHECK(reports[0] == reports[1]);
        // Above a spike both slopes of a valley, which is a roof seen from below, can be nearest.
        CHECK((reports[0] == 1 || (reports[0] == 2 && slope < 0.0)));
    }
}

TEST_CASE("the four moving points of a pair start and end where cloth and obstacle do") {
    Random random(100);
    const Obstacle obstacle = moving_obstacle(2, random);
    const TriangleMesh from = crumpled_sheet(0.5, 3, 0.1, random), to = crumpled_sheet(0.5, 3, 0.1, random);
    const ClothMove move{.from = from.vertices, .to = to.vertices, .fraction = {0.25, 0.75}};
    const ObstacleSurface& surface = obstacle.surface();
    int wrong = 0;
    for (const ContactPair& pair : all_pairs(from, obstacle, false)) {
        const MovingFour four = moving_pair(pair, move, obstacle);
        std::vector<int> body;
        if (pair.kind == PairKind::vertex_face)
            body.assign(surface.triangles[pair.feature].begin(), surface.triangles[pair.feature].end());
        if (pair.kind == PairKind::edge_edge)
            body.assign(surface.edges[pair.feature].vertex.begin(), surface.edges[pair.feature].vertex.end());
        if (pair.kind == PairKind::face_vertex) body.assign(1, pair.feature);
        const bool body_first = pair.kind == PairKind::face_vertex;
        for (int k = 0; k < 4; ++k) {
            const int b = body_first ? k : k - pair.cloth_count(), c = body_first ? k - 1 : k;
            const bool is_body = body_first ? k == 0 : k >= pair.cloth_count();
            const Vec3 start = is_body ? obstacle.at(body[b], 0.25) : from.vertices[pair.cloth[c]];
            const Vec3 end = is_body ? obstacle.at(body[b], 0.75) : to.vertices[pair.cloth[c]];
            wrong += four.from[k] == start && four.to[k] == end ? 0 : 1;
        }
        const auto& x = four.from;
        const double distance = shape_of(pair.kind) == PairShape::edge_edge ? true_edge_edge(x[0], x[1], x[2], x[3])
                                                                            : true_point_triangle(x[0], x[1], x[2], x[3]);
        wrong += std::abs(distance - pair_distance(pair, from.vertices, obstacle, 0.25)) > 1e-13 ? 1 : 0;
    }
    CHECK(wrong == 0);
}

}  // namespace percale::test::contact_pair_test
