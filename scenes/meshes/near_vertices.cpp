#include "meshes/near_vertices.h"

#include "meshes/point_cells.h"

namespace percale::scenes {

WeldedMesh weld_near(const TriangleMesh& mesh, double distance) {
    WeldedMesh welded;
    PointCells cells(distance);
    std::vector<int> number(mesh.vertices.size());
    for (std::size_t v = 0; v < number.size(); ++v) {
        const Vec3& x = mesh.vertices[v];
        number[v] = static_cast<int>(welded.mesh.vertices.size());
        const bool known = cells.any_around(x, [&](int other) {
            const bool near = (welded.mesh.vertices[static_cast<std::size_t>(other)] - x).norm() <= distance;
            if (near) number[v] = other;
            return near;
        });
        if (known) {
            ++welded.joined_vertices;
            continue;
        }
        cells.add(number[v], x);
        welded.mesh.vertices.push_back(x);
    }
    for (const Triangle& t : mesh.triangles) {
        const Triangle now{number[static_cast<std::size_t>(t[0])], number[static_cast<std::size_t>(t[1])],
                           number[static_cast<std::size_t>(t[2])]};
        if (now[0] == now[1] || now[1] == now[2] || now[2] == now[0])
            ++welded.dropped_triangles;
        else
            welded.mesh.triangles.push_back(now);
    }
    return welded;
}

}  // namespace percale::scenes
