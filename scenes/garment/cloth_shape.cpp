#include "garment/cloth_shape.h"

#include <algorithm>
#include <filesystem>

#include "common/text.h"
#include "garment/cloth_leftovers.h"
#include "meshes/mesh_import.h"
#include "models/polygon.h"
#include "pattern/pattern_file.h"
#include "pattern/pattern_parts.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

/// m. How much farther out than the one below it the panels of a garment start. Smaller: panels start through those below.
constexpr double layer_offset = 0.04;

/// Edges of a rest shape that are by more longer or shorter than those of the start are likely in another unit.
constexpr double max_rest_ratio = 2.0;

RestShape uv_shape(const std::string& file, const ClothSpec& cloth, const TriangleMesh& start) {
    const TexturedMesh textured = import_textured_mesh(file, cloth.unit, cloth.part);
    RestShape shape;
    for (const auto& corners : textured.uv) {
        auto& own = shape.corners.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) own[k] = cloth.uv_scale * Vec3(corners[k].x(), corners[k].y(), 0.0);
    }
    if (shape.corners.size() != start.triangles.size()) throw SceneError(file, "its vt are not those of the cloth's mesh");
    return shape;
}

PatternMesh pattern_mesh(const Scene& scene, const ClothSpec& cloth) {
    Pattern pattern = read_pattern(path_beside(scene, cloth.pattern));
    move_apart(pattern, cloth.panel_offset + layer_offset * std::max(cloth.layer, 0));
    return mesh_pattern(pattern, cloth.edge_length);
}

/// The flat panels of a pattern; warp runs along their y.
RestShape panel_shape(const PatternMesh& garment, double scale) {
    RestShape shape{.corners = {}, .warp = Vec3::UnitY()};
    for (const auto& corners : textured_mesh(garment).uv) {
        auto& own = shape.corners.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) own[k] = scale * Vec3(corners[k].x(), corners[k].y(), 0.0);
    }
    return shape;
}

/// The sum of the lengths of the three edges.
double length_of(const std::array<Vec3, 3>& x) { return (x[1] - x[0]).norm() + (x[2] - x[1]).norm() + (x[0] - x[2]).norm(); }

void warn_of_scale(const ClothSpec& cloth, const RestShape& shape, const TriangleMesh& start, std::vector<Finding>& warnings) {
    double rest = 0.0, now = 0.0;
    for (std::size_t t = 0; t < start.triangles.size(); ++t) {
        const auto& [a, b, c] = start.triangles[t];
        rest += length_of(shape.corners[t]);
        now += length_of({start.vertices[a], start.vertices[b], start.vertices[c]});
    }
    const double ratio = rest / now;
    if (ratio > 1.0 / max_rest_ratio && ratio < max_rest_ratio) return;
    const std::string uv_scale = "with uv_scale = " + short_number(cloth.uv_scale / ratio) + " they would be as long";
    warnings.push_back(finding(
        "rest_scale", {},
        "cloth '" + cloth.name + "': its edges are " + short_number(ratio) + " times as long in its rest shape as they start",
        cloth.rest == "uv" ? uv_scale : ""));
}

/// Removes leftovers from a cloth; those of an obstacle are removed by its cleaning (Cleaning).
void leave_out(const Scene& scene, const ClothSpec& cloth, ClothShape& shape, std::vector<Finding>& warnings) {
    const Leftovers leftovers = leftovers_of(shape.start);
    if (!leftovers.any()) return;
    const std::size_t kept = shape.start.vertices.size() - leftovers.vertices.size();
    const bool renumbers = !leftovers.vertices.empty() && static_cast<std::size_t>(leftovers.vertices.front()) < kept;
    const std::string use = renumbers ? numbered_use(scene, cloth) : "";
    if (!use.empty())
        throw SceneError("cloth '" + cloth.name + "'", "its mesh has " + leftovers.text() + ", the first is vertex " +
                                                           std::to_string(leftovers.vertices.front()) +
                                                           "; left out they would change the numbers of vertices, which " + use +
                                                           " names: delete them from the mesh");
    warnings.push_back(finding("leftovers", {}, "cloth '" + cloth.name + "': " + leftovers.text() + " of its mesh are left out"));
    drop_leftovers(leftovers, shape.start, shape.rest);
}

}  // namespace

std::string path_beside(const Scene& scene, const std::string& path) {
    return (std::filesystem::path(scene.file).parent_path() / path).string();
}

TriangleMesh start_mesh(const Scene& scene, const ClothSpec& cloth, std::vector<Finding>* warnings) {
    TriangleMesh mesh;
    if (!cloth.pattern.empty()) {
        mesh = pattern_mesh(scene, cloth).mesh;
    } else if (cloth.grid) {
        mesh = make_grid(cloth.grid->size[0], cloth.grid->size[1], cloth.grid->vertices[0], cloth.grid->vertices[1]);
    } else {
        mesh = import_mesh(path_beside(scene, cloth.mesh), cloth.unit, warnings, cloth.part, cloth.weld);
    }
    mesh.vertices = transform(cloth.pose, mesh.vertices);
    return mesh;
}

RestShape rest_shape(const Scene& scene, const ClothSpec& cloth, const TriangleMesh& start, std::vector<Finding>& warnings) {
    RestShape shape;
    const bool uv = cloth.rest == "uv";
    if (cloth.weld > 0.0 && !cloth.rest.empty())
        throw SceneError("cloth '" + cloth.name + "': weld joins vertices of its mesh, so rest is not of the same any more");
    if (uv) {
        shape = uv_shape(path_beside(scene, cloth.mesh), cloth, start);
    } else if (!cloth.rest.empty()) {
        TriangleMesh rest = import_mesh(path_beside(scene, cloth.rest), cloth.unit, &warnings);
        if (are_same_polygons(start.triangles, rest.triangles)) rest.triangles = start.triangles;
        shape = rest_shape_of(start, rest, "cloth '" + cloth.name + "'");
    }
    if (cloth.warp) shape.warp = cloth.warp->direction;
    if (uv && !cloth.warp) shape.warp = Vec3::UnitY();
    if (shape.corners.empty()) {
        shape.warp = transform({.rotation = cloth.pose.rotation}, shape.warp);
        return shape;
    }
    for (auto& corners : shape.corners) {
        for (Vec3& corner : corners) corner *= cloth.pose.scale;
    }
    warn_of_scale(cloth, shape, start, warnings);
    return shape;
}

ClothShape cloth_shape(const Scene& scene, const ClothSpec& cloth, std::vector<Finding>& warnings) {
    ClothShape shape;
    const std::string shown = "cloth '" + cloth.name + "'";
    if (cloth.pattern.empty()) {
        shape.start = start_mesh(scene, cloth, &warnings);
        shape.rest = rest_shape(scene, cloth, shape.start, warnings);
        if (!cloth.grid) leave_out(scene, cloth, shape, warnings);
        check_mesh(shape.start, shown, true);
        return shape;
    }
    PatternMesh garment = pattern_mesh(scene, cloth);
    shape.rest = panel_shape(garment, cloth.pose.scale);
    shape.start = std::move(garment.mesh);
    shape.start.vertices = transform(cloth.pose, shape.start.vertices);
    check_mesh(shape.start, shown, true);
    shape.seams = std::move(garment.seams);
    return shape;
}

}  // namespace percale::scenes
