#include "generators/spikes.h"

#include <algorithm>
#include <string>

#include "percale/error.h"

namespace percale::scenes {

namespace {

void check_spike(double value, const char* field, double lowest, double highest) {
    if (value >= lowest && value <= highest) return;
    throw SceneError(std::string("spikes: ") + field + " is " + std::to_string(value) + ", allowed are " +
                     std::to_string(lowest) + " ... " + std::to_string(highest));
}

/// The plate's lattice lines: its two sides and the two sides of every row of feet.
std::vector<double> lattice_lines(const SpikeBed& bed) {
    std::vector<double> lines = {-0.5 * bed.width};
    for (int k = 0; k < bed.count; ++k) {
        const double centre = bed.width * ((k + 0.5) / bed.count - 0.5);
        lines.push_back(centre - 0.5 * bed.base);
        lines.push_back(centre + 0.5 * bed.base);
    }
    lines.push_back(0.5 * bed.width);
    return lines;
}

/// A quad, counter-clockwise seen from outside.
void add_quad(TriangleMesh& mesh, const std::array<int, 4>& q) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
}

void add_spike(TriangleMesh& mesh, const std::array<int, 4>& foot, double height) {
    const Vec3 centre = 0.5 * (mesh.vertices[foot[0]] + mesh.vertices[foot[2]]);
    const int tip = static_cast<int>(mesh.vertices.size());
    mesh.vertices.emplace_back(centre[0], height, centre[2]);
    for (int k = 0; k < 4; ++k) mesh.triangles.push_back({foot[k], foot[(k + 1) % 4], tip});
}

}  // namespace

TriangleMesh make_spikes(const SpikeBed& bed) {
    check_spike(bed.width, "width", 1e-3, 100.0);
    check_spike(bed.count, "count", 1, 100);
    check_spike(bed.height, "height", 1e-4, 100.0);
    check_spike(bed.thickness, "thickness", 1e-4, 100.0);
    check_spike(bed.base, "base", 1e-4, 0.99 * bed.width / bed.count);
    const std::vector<double> lines = lattice_lines(bed);
    const int n = static_cast<int>(lines.size());
    TriangleMesh mesh;
    for (const double y : {0.0, -bed.thickness})
        for (const double z : lines)
            for (const double x : lines) mesh.vertices.emplace_back(x, y, z);
    const auto top = [n](int column, int row) { return row * n + column; };
    const auto bottom = [n](int column, int row) { return (n + row) * n + column; };
    for (int row = 0; row + 1 < n; ++row)
        for (int column = 0; column + 1 < n; ++column) {
            const std::array<int, 4> cell = {top(column, row), top(column, row + 1), top(column + 1, row + 1),
                                             top(column + 1, row)};
            if (row % 2 == 1 && column % 2 == 1)
                add_spike(mesh, cell, bed.height);
            else
                add_quad(mesh, cell);
            add_quad(mesh, {bottom(column, row), bottom(column + 1, row), bottom(column + 1, row + 1), bottom(column, row + 1)});
        }
    for (int k = 0; k + 1 < n; ++k) {
        add_quad(mesh, {bottom(k, n - 1), bottom(k + 1, n - 1), top(k + 1, n - 1), top(k, n - 1)});  // +z
        add_quad(mesh, {bottom(k + 1, 0), bottom(k, 0), top(k, 0), top(k + 1, 0)});                  // -z
        add_quad(mesh, {bottom(n - 1, k + 1), bottom(n - 1, k), top(n - 1, k), top(n - 1, k + 1)});  // +x
        add_quad(mesh, {bottom(0, k), bottom(0, k + 1), top(0, k + 1), top(0, k)});                  // -x
    }
    return mesh;
}

}  // namespace percale::scenes
