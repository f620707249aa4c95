#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "percale/certify.h"
#include "percale/contact.h"
#include "tests/support/collision/shapes.h"

namespace percale::test {

/// Several cloths as one mesh, with the data of their vertices that a detector needs.
struct Cloths {
    TriangleMesh mesh;  // at rest
    std::vector<int> cloth;
    std::vector<double> thickness, friction;

    void add(const TriangleMesh& more, double h, bool meets_cloth = true) {
        const int number = cloth.empty() ? 0 : 1 + *std::max_element(cloth.begin(), cloth.end());
        mesh = joined(mesh, more);
        cloth.resize(mesh.vertices.size(), meets_cloth ? number : -1);
        thickness.resize(mesh.vertices.size(), h);
        friction.resize(mesh.vertices.size(), 0.1 * (number + 1));
    }
    SelfContact self_contact() const { return {.cloth = cloth, .rest = mesh.vertices, .friction = friction}; }
    /// Whether no cloth crosses or touches cloth at these places.
    bool clean(const std::vector<Vec3>& x) const {
        const ClothCertificate certificate = certify_cloth({.vertices = x, .triangles = mesh.triangles});
        return certificate.crossing.empty() && certificate.touching.empty();
    }
};

/// Sheets above each other, each turned and bumpy, `gap` apart in the mean.
inline Cloths sheet_stack(int sheets, int count, double gap, double thickness, Random& random) {
    Cloths cloths;
    for (int i = 0; i < sheets; ++i) {
        TriangleMesh sheet = make_grid(1, 1, count, count);
        for (Vec3& x : sheet.vertices) x += random.point(0.2 * gap);
        const double half = random.number(-0.3, 0.3);
        cloths.add(placed(sheet, {.translation = {0, gap * i, 0}, .rotation = {std::cos(half), 0, std::sin(half), 0}}),
                   thickness);
    }
    return cloths;
}

}  // namespace percale::test
