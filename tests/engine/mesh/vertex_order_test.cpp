#include "engine/mesh/vertex_order.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "tests/support/bench_meshes.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::vertex_order_test {
namespace {

constexpr std::size_t stretch = 256;

std::vector<int> sorted(std::vector<int> numbers) {
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

std::vector<int> counted(std::size_t count) {
    std::vector<int> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

ClothModel ordered_model(const TriangleMesh& mesh) {
    ClothModel model;
    append_cloth(model, mesh, free_fabric(), "cloth");
    order_last_cloth(model);
    finish_model(model);
    return model;
}

/// Mean distance of the two ends of a spring in memory.
double mean_distance(const ClothModel& model) {
    double sum = 0.0;
    for (int k = 0; k < model.springs.size(); ++k) sum += std::abs(model.springs.first[k] - model.springs.second[k]);
    return sum / model.springs.size();
}

/// Entries of the slices for each end of a spring; 1 without padding.
double padding(const ClothModel& model) {
    return static_cast<double>(model.adjacency.other.size()) / (2.0 * model.springs.size());
}

}  // namespace

TEST_CASE("The curve passes every point of a lattice once, going from neighbour to neighbour") {
    Random random(1);
    std::vector<Vec3> lattice;
    for (int i = 0; i < 512; ++i) lattice.emplace_back(i % 8, i / 8 % 8, i / 64);
    for (std::size_t i = lattice.size(); i > 1; --i) std::swap(lattice[i - 1], lattice[random.index(static_cast<int>(i))]);
    const std::vector<int> order = along_curve(lattice);
    CHECK(sorted(order) == counted(512));
    for (std::size_t i = 1; i < order.size(); ++i) CHECK((lattice[order[i]] - lattice[order[i - 1]]).norm() == 1.0);
}

TEST_CASE("Points at one place keep their order on the curve") {
    CHECK(along_curve(std::vector<Vec3>(1, Vec3(1, 2, 3))) == std::vector<int>{0});
    CHECK(along_curve(std::vector<Vec3>(7, Vec3(1, 2, 3))) == counted(7));
}

TEST_CASE("An order is a permutation and its inverse") {
    for (const int wished : {300, 1000}) {
        const TriangleMesh mesh = shuffled(t_shirt(wished));
        const VertexOrder order = memory_order(mesh.vertices, std::vector<int>(mesh.vertices.size(), 6));
        CHECK_FALSE(order.kept());
        CHECK(sorted(order.place) == counted(mesh.vertices.size()));
        for (int i = 0; i < static_cast<int>(mesh.vertices.size()); ++i) CHECK(order.vertex_at(order.place_of(i)) == i);
    }
    const VertexOrder kept;
    CHECK(kept.kept());
    CHECK(kept.place_of(5) == 5);
    CHECK(kept.vertex_at(7) == 7);
}

TEST_CASE("Each window holds the vertices that the curve passes there, those with the most springs first") {
    Random random(2);
    const TriangleMesh mesh = shuffled(irregular_sheet(1.0, 1000));
    std::vector<int> springs;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) springs.push_back(random.index(20));
    const VertexOrder order = memory_order(mesh.vertices, springs);
    const std::vector<int> curve = along_curve(mesh.vertices);
    for (std::size_t from = 0; from < curve.size(); from += stretch) {
        const std::size_t to = std::min(curve.size(), from + stretch);
        CHECK(std::set<int>(order.vertex.begin() + from, order.vertex.begin() + to) ==
              std::set<int>(curve.begin() + from, curve.begin() + to));
        for (std::size_t i = from + 1; i < to; ++i) CHECK(springs[order.vertex[i - 1]] >= springs[order.vertex[i]]);
    }
}

TEST_CASE("However a mesh is numbered, neighbours lie near each other in memory and slices are nearly full") {
    for (const auto& mesh : {irregular_sheet(1.0, 4000), tube_skirt(4000), t_shirt(4000)}) {
        const ClothModel natural = cloth_model(mesh, free_fabric()), mixed = cloth_model(shuffled(mesh), free_fabric());
        const ClothModel ordered = ordered_model(shuffled(mesh));
        CAPTURE(mean_distance(natural), mean_distance(mixed), mean_distance(ordered));
        CHECK(mean_distance(ordered) < 2.5 * mean_distance(natural));
        CHECK(mean_distance(ordered) < 0.2 * mean_distance(mixed));
        CHECK(padding(natural) > 1.1);
        CHECK(padding(ordered) < 1.05);
    }
}

TEST_CASE("The order in memory follows from the mesh, not from its numbers") {
    const TriangleMesh mesh = t_shirt(1000);
    const ClothModel one = ordered_model(mesh), other = ordered_model(shuffled(mesh));
    CHECK(one.rest == other.rest);
    CHECK(one.mass == other.mass);
    CHECK(one.triangles == other.triangles);
    CHECK(one.springs.first == other.springs.first);
    CHECK(one.springs.second == other.springs.second);
    CHECK(one.springs.rest_length == other.springs.rest_length);
}

}  // namespace percale::test::vertex_order_test
