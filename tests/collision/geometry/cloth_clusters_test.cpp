#include "collision/geometry/cloth_clusters.h"

#include <algorithm>
#include <map>
#include <set>

#include "tests/support/catch.h"
#include "tests/support/collision/shapes.h"

namespace percale::test::cloth_clusters_test {
namespace {

TriangleMesh cloth_number(int i) {
    Random random(4);
    switch (i) {
        case 0:
            return make_grid(1, 1, 33, 21);
        case 1:
            return make_sphere(1.0, 3);
        case 2:
            return joined(make_grid(1, 1, 5, 5), moved(make_grid(1, 1, 4, 9), {3, 0, 0}));
        case 3:
            return soup(77, 2);
        case 4:
            return soup(1, 2);
        case 5:
            return {.vertices = std::vector<Vec3>(9, Vec3(1, 1, 1)), .triangles = make_grid(1, 1, 3, 3).triangles};
        default:
            return crumpled_sheet(1.0, 20, 0.3, random);
    }
}

using Edge = std::pair<int, int>;

}  // namespace

TEST_CASE("every vertex, edge and triangle of a cloth is owned exactly once, by a cluster that holds it") {
    const TriangleMesh cloth = cloth_number(GENERATE(0, 1, 2, 3, 4, 5, 6));
    const ClothClusters made = make_clusters(cloth.triangles, cloth.vertices);
    std::map<int, int> vertices, triangles;
    std::map<Edge, int> edges, all_edges;
    for (const ClothCluster& cluster : made.clusters) {
        std::set<int> own;
        for (const int t : cluster.triangles) {
            ++triangles[t];
            own.insert(cloth.triangles[t].begin(), cloth.triangles[t].end());
        }
        CHECK(std::vector<int>(own.begin(), own.end()) == cluster.all_vertices);
        CHECK(cluster.triangles.size() <= 8);
        CHECK_FALSE(cluster.triangles.empty());
        for (const int v : cluster.vertices) {
            ++vertices[v];
            CHECK(own.count(v) == 1);
        }
        for (const auto& [a, b] : cluster.edges) {
            ++edges[std::minmax(a, b)];
            CHECK(own.count(a) + own.count(b) == 2);
        }
    }
    for (const Triangle& t : cloth.triangles) {
        for (int k = 0; k < 3; ++k) all_edges[std::minmax(t[k], t[(k + 1) % 3])] = 1;
    }
    CHECK(edges == all_edges);
    CHECK(triangles.size() == cloth.triangles.size());
    CHECK(vertices.size() == cloth.vertices.size());
    for (const auto& [t, times] : triangles) CHECK(times == 1);
    for (const auto& [v, times] : vertices) CHECK(times == 1);
}

TEST_CASE("the owner bits name one triangle for every edge") {
    const TriangleMesh cloth = cloth_number(GENERATE(0, 1, 2, 3));
    const ClothClusters made = make_clusters(cloth.triangles, cloth.vertices);
    REQUIRE(made.edge_owner_bits.size() == cloth.triangles.size());
    std::map<Edge, int> owners;
    for (std::size_t t = 0; t < cloth.triangles.size(); ++t) {
        CHECK(made.edge_owner_bits[t] < 8);
        for (int k = 0; k < 3; ++k) {
            owners[std::minmax(cloth.triangles[t][k], cloth.triangles[t][(k + 1) % 3])] += made.edge_owner_bits[t] >> k & 1;
        }
    }
    for (const auto& [edge, count] : owners) CHECK(count == 1);
}

TEST_CASE("an edge belongs to the first triangle that has it and runs as there, however the cloth is turned") {
    const TriangleMesh cloth = cloth_number(GENERATE(0, 1, 2, 3, 6));
    std::map<Edge, std::pair<int, std::array<int, 2>>> first;  // triangle, vertices
    for (int t = 0; t < static_cast<int>(cloth.triangles.size()); ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::array<int, 2> ends{cloth.triangles[t][k], cloth.triangles[t][(k + 1) % 3]};
            first.try_emplace(std::minmax(ends[0], ends[1]), t, ends);
        }
    }
    std::map<Edge, std::vector<std::pair<int, int>>> sides;  // triangle, corner off the edge
    for (int t = 0; t < static_cast<int>(cloth.triangles.size()); ++t) {
        const Triangle& x = cloth.triangles[t];
        for (int k = 0; k < 3; ++k) sides[std::minmax(x[k], x[(k + 1) % 3])].emplace_back(t, x[(k + 2) % 3]);
    }
    const Rotation about_y{0, 0, 1, 0}, any{0.5, 0.5, -0.1, 0.7};
    for (const Rotation& turn : {Rotation{}, about_y, any}) {
        const ClothClusters made = make_clusters(cloth.triangles, transform({.rotation = turn}, cloth.vertices));
        for (const auto& [edge, owner] : first) {
            const Triangle& t = cloth.triangles[owner.first];
            const int k = static_cast<int>(std::find(t.begin(), t.end(), owner.second[0]) - t.begin());
            CHECK((made.edge_owner_bits[owner.first] >> k & 1) == 1);
        }
        for (int t = 0; t < static_cast<int>(cloth.triangles.size()); ++t) {
            for (int k = 0; k < 3; ++k) {
                const auto& at = sides[std::minmax(cloth.triangles[t][k], cloth.triangles[t][(k + 1) % 3])];
                REQUIRE(at.size() <= 2);
                CHECK(made.across[t][k] == (at.size() < 2 ? -1 : at[0].first == t ? at[1].second : at[0].second));
            }
        }
        for (const ClothCluster& cluster : made.clusters) {
            for (const auto& ends : cluster.edges) CHECK(first.at(std::minmax(ends[0], ends[1])).second == ends);
        }
    }
}

TEST_CASE("a cluster of a sheet is a small patch of it") {
    const TriangleMesh sheet = make_grid(1.0, 1.0, 65, 65);
    const ClothClusters made = make_clusters(sheet.triangles, sheet.vertices);
    CHECK(made.clusters.size() == sheet.triangles.size() / 8);
    double sum = 0.0;
    for (const ClothCluster& cluster : made.clusters) {
        Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
        for (const int v : cluster.all_vertices) {
            low = low.cwiseMin(sheet.vertices[v]);
            high = high.cwiseMax(sheet.vertices[v]);
        }
        sum += (high - low).norm();
    }
    // Eight triangles are 2 x 2 cells of 1/64; a random choice would span the sheet.
    CHECK(sum / double(made.clusters.size()) < 4.0 / 64 * std::sqrt(2.0));
}

TEST_CASE("the clusters of a cloth are the same each time they are made") {
    const TriangleMesh cloth = cloth_number(6);
    const ClothClusters a = make_clusters(cloth.triangles, cloth.vertices), b = make_clusters(cloth.triangles, cloth.vertices);
    REQUIRE(a.clusters.size() == b.clusters.size());
    for (std::size_t i = 0; i < a.clusters.size(); ++i) {
        CHECK(a.clusters[i].triangles == b.clusters[i].triangles);
        CHECK(a.clusters[i].vertices == b.clusters[i].vertices);
        CHECK(a.clusters[i].edges == b.clusters[i].edges);
    }
}

}  // namespace percale::test::cloth_clusters_test
