#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adjacency.h"
#include "cloth_state.h"
#include "hinges.h"
#include "membrane.h"
#include "mesh/vertex_order.h"
#include "percale/fabric.h"
#include "percale/mesh.h"
#include "sewn_points.h"
#include "spring_network.h"
#include "strain_limits.h"
#include "vec3_arrays.h"
#include "weld.h"

namespace percale {

/// The vertices of one cloth among all vertices of a simulation.
struct ClothRange {
    std::string name;
    int first = 0;
    int count = 0;
    double mass = 0.0;  // kg
    bool grid = false;  // otherwise a free mesh
    int columns = 0;    // of a grid
    Fabric fabric = {};
    VertexOrder order = {};
    int first_spring = 0;  // its own first one in the network; springs of seams follow those of the cloths that existed then
    std::shared_ptr<const RestShape> shape = {};  // m; null: the cloth has no strain where its vertices lie at rest

    /// The number in the system of a vertex in the user's mesh, and back.
    int index_of(int user_vertex) const { return first + order.place_of(user_vertex); }
    int user_vertex(int index) const { return order.vertex_at(index - first); }
};

/// Consecutive vertices that no spring joins to others: a cloth, or all from the first to the last that seams join.
struct Body {
    int first = 0, count = 0;
    double mass = 0.0;  // kg
};

/// All cloth of a simulation as one system: what does not change from step to step.
struct ClothModel {
    std::vector<ClothRange> cloths;
    std::vector<double> mass;         // kg, one a vertex
    std::vector<double> thickness;    // m, one a vertex
    std::vector<double> modulus;      // N/m, one a vertex: the larger one of warp and weft
    std::vector<double> length;       // m, one a vertex: root of its area
    std::vector<Vec3> rest;           // m, positions of the meshes; without strain unless a rest shape says otherwise
    std::vector<Triangle> triangles;  // in the user's order, whatever the order of the vertices
    SpringNetwork springs;
    Hinges hinges;
    std::vector<SewnPoint> sewn_points;
    std::vector<Weld> welds;
    std::vector<MembraneTriangle> membrane;
    Adjacency adjacency;
    StrainLimits limits;  // empty where no fabric has one
    std::vector<Body> bodies;

    /// Whether there are welds or strain limits, which no explicit scheme takes.
    bool has_holds() const { return !welds.empty() || !limits.empty(); }
    int vertex_count() const { return static_cast<int>(mass.size()); }
};

/// The multipliers of a model's welds and strain limits, which steps change.
struct Holds {
    std::vector<Vec3> welds;     // N, Weld::hold
    std::vector<double> limits;  // N, LimitedEdge::hold
};
void copy_holds(const ClothModel& model, Holds& holds);
void put_holds(const Holds& holds, ClothModel& model);

/// Appends a cloth, its vertices in the user's order; `mesh` in m, world, without strain unless `shape` gives the rest shape.
/// Throws SceneError naming `name`. finish_model makes the adjacency anew.
void append_cloth(ClothModel& model, const TriangleMesh& mesh, const Fabric& fabric, const std::string& name,
                  const RestShape& shape = {});
/// Puts the vertices of the cloth that was appended last into memory_order, if it is a free mesh; grids keep theirs, in which
/// their springs lie in bands.
void order_last_cloth(ClothModel& model);
/// Gives the cloth that was appended last hinges of its own, after its order is settled.
void append_hinges_of_last_cloth(ClothModel& model, double bend_stiffness, const RestShape& shape = {});
/// Does all three of these. finish_model has to follow.
void append_whole_cloth(ClothModel& model, const TriangleMesh& mesh, const Fabric& fabric, const std::string& name,
                        const RestShape& shape = {});
void finish_model(ClothModel& model);
/// Sets springs.bending, the part of hinges and of sewn points.
void set_bending(ClothModel& model);
/// Makes hinges beside clamps stiffer. `free`: 1, or 0 at pinned vertices.
void set_model_clamps(std::span<const double> free, ClothModel& model);

/// The triangles of one cloth.
std::span<const Triangle> triangles_of(const ClothModel& model, const ClothRange& cloth);
/// The number of the cloth that a vertex belongs to.
int cloth_of(const ClothModel& model, int vertex);
/// The number of the body that a vertex belongs to.
int body_of(std::span<const Body> bodies, int vertex);

/// Longest edge of a triangle over its height there at rest, the largest in a cloth of moduli on a free mesh: its stiffness
/// across the edge exceeds that along it by this factor. 0 for other cloth.
double largest_aspect(const ClothModel& model, const ClothRange& cloth);

}  // namespace percale
