#include "data/generators/shipped_meshes.h"

#include <filesystem>
#include <fstream>

#include "percale/certify.h"
#include "scenes/meshes/mesh_import.h"
#include "tests/scenes/mesh_laws.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::shipped_meshes_test {
namespace {

const std::string folder = PERCALE_DATA_DIR "/meshes/";

std::string stored_bytes(const std::string& file) {
    std::ifstream in(folder + file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_CASE("the mesh files in data are what the code makes today, and nothing else is there") {
    std::set<std::string> made, stored_files;
    for (const auto& [file, mesh, bytes] : make_shipped_meshes()) {
        INFO(file);
        made.insert(file);
        CHECK(std::filesystem::file_size(folder + file) < 1 << 20);
        if (!bytes.empty()) {
            CHECK(stored_bytes(file) == bytes);
            continue;
        }
        const TriangleMesh stored = import_mesh(folder + file);
        REQUIRE(stored.vertices.size() == mesh.vertices.size());
        CHECK(stored.triangles == mesh.triangles);
        double largest = 0.0;
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
            largest = std::max(largest, (stored.vertices[v] - mesh.vertices[v]).lpNorm<Eigen::Infinity>());
        CHECK(largest <= 1e-6);
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder)) stored_files.insert(entry.path().filename().string());
    CHECK(stored_files == made);
}

TEST_CASE("the shipped files hold closed bodies and meshes fit for use, with six decimals") {
    for (const std::string file : {"funnel.obj", "mannequin.obj", "needles.obj", "poncho.obj", "sphere.obj", "spikes.obj"}) {
        INFO(file);
        const TriangleMesh mesh = import_mesh(folder + file);
        CHECK_NOTHROW(check_mesh(mesh, file, true));
        CHECK(is_watertight(mesh) == (file != "poncho.obj"));
        CHECK(self_intersections(mesh).empty());
        CHECK(sharpest_angle(mesh) > 15.0);
        for (const Vec3& x : mesh.vertices)
            for (const double coordinate : x) REQUIRE(std::abs(coordinate * 1e6 - std::round(coordinate * 1e6)) < 1e-6);
    }
}

TEST_CASE("the mannequin with joints has the vertices and triangles of the one without") {
    for (const auto& [file, mesh, bytes] : make_shipped_meshes()) {
        if (file != "mannequin.glb") continue;
        const TriangleMesh alone = import_mesh(folder + "mannequin.obj");
        CHECK(mesh.vertices == alone.vertices);
        CHECK(mesh.triangles == alone.triangles);
        const TriangleMesh read = import_mesh(folder + file);
        CHECK(is_watertight(read));
        CHECK(read.vertices.size() == alone.vertices.size());
        CHECK(volume(read) == Approx(volume(alone)).epsilon(1e-6));
    }
}

}  // namespace percale::scenes::test::shipped_meshes_test
