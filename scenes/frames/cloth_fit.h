#pragma once

#include <atomic>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/mesh_fields.h"
#include "percale/contact_load.h"
#include "percale/rest_shape.h"

// How cloth sits: what a scene's output.fields asks for.
namespace percale::scenes {

/// The words of output.fields.
inline constexpr std::string_view fit_words[] = {"strain", "pressure", "distance"};

/// "strain: ...; pressure: ...".
std::string fit_words_meaning();

/// One cloth as it hangs.
struct DressedCloth {
    const TriangleMesh& start;  // and `rest`: as given to Simulation::add_cloth, m
    const RestShape& rest;
    const TriangleMesh& now;                    // m, world
    std::span<const ContactLoad> loads;         // on its vertices
    std::span<const TriangleMesh> obstacles;    // m, world
    const std::atomic<bool>* cancel = nullptr;  // as of certify
};

/// The contact pressure on each vertex, Pa: the sum of |normal| over all obstacles, divided by its present area (vertex_areas).
std::vector<double> contact_pressure(const TriangleMesh& now, std::span<const ContactLoad> loads);

/// The distance of each point from the nearest obstacle, m, negative inside a closed one; infinity without obstacles. World
/// coordinates.
std::vector<double> obstacle_distances(std::span<const Vec3> points, std::span<const TriangleMesh> obstacles,
                                       const std::atomic<bool>* cancel = nullptr);

/// The fields of these words. strain: strain_warp, strain_weft, strain_shear (TriangleStrain) of triangles, and of vertices as
/// their mean by rest area; pressure: Pa, of vertices; distance: of vertices, obstacle_distances.
MeshFields fit_fields(const DressedCloth& cloth, std::span<const std::string> words);

/// The spread of the values of a field.
struct Spread {
    double smallest = 0.0, median = 0.0, of_95_percent = 0.0, largest = 0.0;
};

/// `values`: at least one.
Spread spread_of(std::vector<double> values);

}  // namespace percale::scenes
