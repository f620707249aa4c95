#include "frames/cloth_fit.h"

#include <algorithm>
#include <limits>

#include "percale/certify.h"
#include "percale/strain.h"

namespace percale::scenes {
namespace {

double area_of(const TriangleMesh& mesh, const Triangle& t) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    return 0.5 * (b - a).cross(c - a).norm();
}

/// The mean of what the triangles at a vertex have, each by its area in a mesh.
std::vector<double> vertex_means(const TriangleMesh& mesh, std::span<const double> of_triangles) {
    std::vector<double> sum(mesh.vertices.size(), 0.0), areas(mesh.vertices.size(), 0.0);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double area = area_of(mesh, mesh.triangles[i]);
        for (const int v : mesh.triangles[i]) {
            sum[v] += area * of_triangles[i];
            areas[v] += area;
        }
    }
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = areas[v] > 0.0 ? sum[v] / areas[v] : 0.0;
    return sum;
}

void add_strain(const DressedCloth& cloth, MeshFields& fields) {
    MeshField warp{"strain_warp", {}}, weft{"strain_weft", {}}, shear{"strain_shear", {}};
    for (const TriangleStrain& strain : triangle_strains(cloth.start, cloth.rest, cloth.now.vertices)) {
        warp.values.push_back(strain.warp);
        weft.values.push_back(strain.weft);
        shear.values.push_back(strain.shear);
    }
    for (const MeshField* field : {&warp, &weft, &shear}) {
        fields.vertex.push_back({field->name, vertex_means(cloth.start, field->values)});
    }
    for (MeshField* field : {&warp, &weft, &shear}) fields.triangle.push_back(std::move(*field));
}

}  // namespace

std::string fit_words_meaning() {
    return "strain: strain_warp, strain_weft (share of the length) and strain_shear (rad) of vertices and triangles; pressure: "
           "of "
           "obstacles on vertices, Pa; distance: of vertices from the nearest obstacle, m";
}

std::vector<double> contact_pressure(const TriangleMesh& now, std::span<const ContactLoad> loads) {
    const std::vector<double> area = vertex_areas(now);
    std::vector<double> pressure(now.vertices.size(), 0.0);
    for (const ContactLoad& load : loads) {
        if (area[load.vertex] > 0.0) pressure[load.vertex] += load.normal.norm() / area[load.vertex];
    }
    return pressure;
}

std::vector<double> obstacle_distances(std::span<const Vec3> points, std::span<const TriangleMesh> obstacles,
                                       const std::atomic<bool>* cancel) {
    std::vector<double> nearest(points.size(), std::numeric_limits<double>::infinity());
    for (const TriangleMesh& obstacle : obstacles) {
        const std::vector<double> distances = surface_distances(obstacle, points, cancel);
        for (std::size_t v = 0; v < nearest.size(); ++v) nearest[v] = std::min(nearest[v], distances[v]);
    }
    return nearest;
}

MeshFields fit_fields(const DressedCloth& cloth, std::span<const std::string> words) {
    MeshFields fields;
    for (const std::string& word : words) {
        if (word == "strain") add_strain(cloth, fields);
        if (word == "pressure") fields.vertex.push_back({word, contact_pressure(cloth.now, cloth.loads)});
        if (word == "distance")
            fields.vertex.push_back({word, obstacle_distances(cloth.now.vertices, cloth.obstacles, cloth.cancel)});
    }
    return fields;
}

Spread spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t last = values.size() - 1;
    return {values.front(), values[last / 2], values[95 * last / 100], values.back()};
}

}  // namespace percale::scenes
