#pragma once

#include <string>
#include <vector>

#include "meshes/obj_file.h"
#include "pattern/pattern.h"
#include "percale/stitch.h"

namespace percale::scenes {

/// The mesh of one panel among those of all.
struct PanelPart {
    std::string name;
    int first_vertex = 0, vertices = 0;
    int first_triangle = 0, triangles = 0;
};

struct SewnSeam {
    std::string name;
    double length = 0.0;           // m, mean of its sides
    std::vector<Stitch> stitches;  // vertex to vertex
};

/// All panels of a pattern as one mesh.
struct PatternMesh {
    TriangleMesh mesh;       // m, the panels placed; triangles wind as the outline of their panel
    std::vector<Point2> uv;  // m, of each vertex: the flat panels beside each other, none over another
    std::vector<PanelPart> panels;
    std::vector<SewnSeam> seams;  // in the order of the pattern
};

/// Meshes a pattern with edges of about this length, m. Both sides of a seam are sampled alike, corner to corner, so that each of
/// their vertices is sewn to a vertex; of a gathered side some are (divide_edges). Throws SceneError for a length out of range,
/// for an edge in two seams, and where the mesh would be too large.
PatternMesh mesh_pattern(const Pattern& pattern, double edge_length);

/// The mesh with its uv, corner by corner.
TexturedMesh textured_mesh(const PatternMesh& garment);

/// All stitches of all seams.
std::vector<Stitch> all_stitches(const PatternMesh& garment);

/// An OBJ file: v, vt, a group for each panel, f, and a line "stitch i j k t" for each stitch, vertices counted from 0.
std::string pattern_obj_text(const PatternMesh& garment);

}  // namespace percale::scenes
