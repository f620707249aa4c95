#include <memory>
#include <utility>

#include "c/handles.h"
#include "c/rest.h"
#include "c/structs.h"
#include "percale/certify.h"
#include "percale/strain.h"

// Meshes of percale.h, and queries about them alone.

using namespace percale::c_interface;

namespace {

template <class Make>
percale_status make_mesh(const char* function, percale_mesh** mesh, Make make) noexcept {
    return call(function, [&] {
        percale_mesh*& place = demanded(mesh, "the place for the mesh");
        place = std::make_unique<percale_mesh>(percale_mesh{make()}).release();
    });
}

percale::TriangleMesh mesh_of(const std::vector<percale::Vec3>& vertices, std::span<const int> indices) {
    percale::TriangleMesh mesh;
    mesh.vertices = vertices;
    mesh.triangles.reserve(indices.size() / 3);
    for (std::size_t i = 0; i < indices.size(); i += 3) mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    percale::check_mesh(mesh, "mesh", false);
    return mesh;
}

/// Mesh and rest shape of a cloth at the scale of its pose.
std::pair<percale::TriangleMesh, percale::RestShape> scaled_rest(const percale::TriangleMesh& mesh,
                                                                 const percale_cloth_settings& settings) {
    percale::TriangleMesh scaled = mesh;
    percale::RestShape rest = rest_shape(mesh, settings);
    if (rest.said()) percale::check_rest_shape(mesh, rest, settings.name);
    for (percale::Vec3& x : scaled.vertices) x *= settings.pose.scale;
    for (auto& corners : rest.corners) {
        for (percale::Vec3& x : corners) x *= settings.pose.scale;
    }
    return {scaled, rest};
}

percale_certificate c_certificate(const percale::Certificate& found) {
    auto reported = default_struct<percale_certificate>();
    reported.watertight = found.watertight;
    reported.intersecting_pairs = found.pairs.size();
    reported.touching_pairs = static_cast<std::uint64_t>(found.touching_pairs);
    if (!found.pairs.empty()) {
        reported.first_cloth_triangle = found.pairs.front().first;
        reported.first_obstacle_triangle = found.pairs.front().second;
    }
    reported.vertices_inside = found.vertices_inside;
    reported.deepest_vertex = found.deepest_vertex;
    reported.deepest_penetration = found.deepest_penetration;
    reported.smallest_distance = found.smallest_distance;
    return reported;
}

}  // namespace

percale_status percale_create_mesh(const double* vertices, size_t vertex_count, const int* triangles, size_t triangle_count,
                                   percale_mesh** mesh) {
    return make_mesh(__func__, mesh, [&] {
        counted_items(triangle_count, "triangle_count");
        const auto places = vectors_of(vertices, vertex_count, "vertices");
        return mesh_of(places, items_of(triangles, 3 * triangle_count, "triangles"));
    });
}

percale_status percale_make_grid(double width, double depth, int columns, int rows, percale_mesh** mesh) {
    return make_mesh(__func__, mesh, [&] { return percale::make_grid(width, depth, columns, rows); });
}

percale_status percale_make_sphere(double radius, int level, percale_mesh** mesh) {
    return make_mesh(__func__, mesh, [&] { return percale::make_sphere(radius, level); });
}

percale_status percale_make_box(const double* size, percale_mesh** mesh) {
    return make_mesh(__func__, mesh, [&] { return percale::make_box(vector_of(size, "size")); });
}

percale_status percale_make_cylinder(double radius, double height, int segments, percale_mesh** mesh) {
    return make_mesh(__func__, mesh, [&] { return percale::make_cylinder(radius, height, segments); });
}

percale_status percale_make_capsule(double radius, double height, int segments, percale_mesh** mesh) {
    return make_mesh(__func__, mesh, [&] { return percale::make_capsule(radius, height, segments); });
}

percale_status percale_make_plane(double half_size, percale_mesh** mesh) {
    return make_mesh(__func__, mesh, [&] { return percale::make_plane(half_size); });
}

void percale_destroy_mesh(percale_mesh* mesh) { delete mesh; }

const double* percale_mesh_vertices_view(const percale_mesh* mesh, size_t* count) {
    const double* view = nullptr;
    call(__func__, [&] {
        const auto& vertices = demanded(mesh, "mesh").value.vertices;
        if (count != nullptr) *count = vertices.size();
        view = vertices.data()->data();
    });
    return view;
}

const int* percale_mesh_triangles_view(const percale_mesh* mesh, size_t* count) {
    const int* view = nullptr;
    call(__func__, [&] {
        const auto& triangles = demanded(mesh, "mesh").value.triangles;
        if (count != nullptr) *count = triangles.size();
        view = triangles.data()->data();
    });
    return view;
}

percale_status percale_certify(const percale_mesh* cloth, const percale_mesh* obstacle, double distance_limit,
                               percale_certificate* certificate) {
    return call(__func__, [&] {
        percale_certificate& place = known(certificate, "certificate");
        place =
            c_certificate(percale::certify(demanded(cloth, "cloth").value, demanded(obstacle, "obstacle").value, distance_limit));
    });
}

percale_status percale_certify_cloth(const percale_mesh* cloth, size_t* crossing_pairs, size_t* touching_pairs) {
    return call(__func__, [&] {
        size_t& crossing = demanded(crossing_pairs, "crossing_pairs");
        size_t& touching = demanded(touching_pairs, "touching_pairs");
        const percale::ClothCertificate found = percale::certify_cloth(demanded(cloth, "cloth").value);
        crossing = found.crossing.size();
        touching = found.touching.size();
    });
}

percale_status percale_triangle_strains(const percale_mesh* mesh, const percale_cloth_settings* settings, const double* positions,
                                        size_t vertex_count, double* strains, size_t capacity) {
    return call(__func__, [&] {
        const auto cloth = known_or_default(settings, "settings");
        const auto [scaled, rest] = scaled_rest(demanded(mesh, "mesh").value, cloth);
        const auto found = percale::triangle_strains(scaled, rest, vectors_of(positions, vertex_count, "positions"));
        Buffer<double>{&demanded(strains, "strains"), capacity, nullptr}.fill(found.size(), [&](double* to) {
            for (const percale::TriangleStrain& strain : found) {
                for (const double value : {strain.warp, strain.weft, strain.shear}) *to++ = value;
            }
        });
    });
}
