// Cusick's drape test: a disc of 30 cm hangs over a support of 18 cm; the drape coefficient is the fraction of the overhanging
// ring that its shadow still covers. The support holds what lies on it.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "percale/percale.h"
#include "tests/support/catch.h"

namespace percale::test::cusick_test {
namespace {

constexpr double radius = 0.15, support = 0.09;  // m

int first_of_ring(int ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); }

int ring_vertex(int ring, int place) { return ring == 0 ? 0 : first_of_ring(ring) + place % (6 * ring); }

/// Rings of 6, 12, 18 ... vertices; beyond the support seven shallow waves say where folds may form.
TriangleMesh disc(int rings) {
    TriangleMesh mesh;
    mesh.vertices.push_back(Vec3::Zero());
    for (int ring = 1; ring <= rings; ++ring) {
        for (int k = 0; k < 6 * ring; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / (6 * ring), r = radius * ring / rings;
            const double wave = 2e-3 * std::max(r - support, 0.0) / (radius - support) * std::sin(7.0 * angle + 0.4);
            mesh.vertices.emplace_back(r * std::cos(angle), wave, r * std::sin(angle));
        }
        for (int sector = 0; sector < 6; ++sector) {
            for (int k = 0; k < ring; ++k) {
                const int inner = ring_vertex(ring - 1, sector * (ring - 1) + k),
                          outer = ring_vertex(ring, sector * ring + k + 1);
                mesh.triangles.push_back({inner, outer, ring_vertex(ring, sector * ring + k)});
                if (k + 1 == ring) continue;
                mesh.triangles.push_back({inner, ring_vertex(ring - 1, sector * (ring - 1) + k + 1), outer});
            }
        }
    }
    return mesh;
}

double shadow(std::span<const Vec3> positions, int rings) {
    double twice = 0.0;
    for (int k = 0; k < 6 * rings; ++k) {
        const Vec3 &a = positions[ring_vertex(rings, k)], &b = positions[ring_vertex(rings, k + 1)];
        twice += a.x() * b.z() - a.z() * b.x();
    }
    return 0.5 * std::abs(twice);
}

double drape_coefficient(Fabric fabric, int rings) {
    fabric.damping_time.reset();
    fabric.spring_damping = 0.05;
    // Folds form on the way, and looser steps may form others: the test compares fabrics and meshes.
    Simulation simulation(StepSettings{.newton_error_ratio = 0.05, .measure = StepMeasures::all});
    const TriangleMesh mesh = disc(rings);
    const ClothId cloth = simulation.add_cloth(mesh, fabric, {});
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const double r = std::hypot(mesh.vertices[i].x(), mesh.vertices[i].z());
        if (r <= support + 1e-6) simulation.pin(cloth, static_cast<int>(i));
    }
    StepReport report;
    for (int n = 0; n < 300; ++n) {
        report = simulation.step();
        if (n > 60 && report.largest_speed < 2e-3) break;
    }
    CHECK(report.largest_speed < 5e-3);
    const double inside = std::numbers::pi * support * support, whole = std::numbers::pi * radius * radius;
    return 100.0 * (shadow(simulation.positions(cloth), rings) - inside) / (whole - inside);
}

}  // namespace

TEST_CASE(
    "Drape coefficients of presets are those of such cloth, on two meshes: silk 20 ... 42, cotton 60 ... 76, denim 70 ... 90") {
    struct Range {
        const char* preset;
        double lowest, highest;
    };
    for (const Range& range : {Range{"silk", 20.0, 42.0}, {"cotton", 60.0, 76.0}, {"denim", 70.0, 90.0}}) {
        CAPTURE(range.preset);
        const Fabric fabric = isotropic(fabric_preset(range.preset));
        const double coarse = drape_coefficient(fabric, 10), fine = drape_coefficient(fabric, 15);
        CHECK(std::abs(coarse - fine) <= 4.0);
        CHECK(fine >= range.lowest);
        CHECK(fine <= range.highest);
    }
}

TEST_CASE("The drape coefficient grows with bending stiffness, up to 100 for stiff cloth") {
    double before = 0.0;
    for (const double factor : {0.3, 1.0, 3.0, 10.0, 100.0}) {
        Fabric fabric = isotropic(fabric_preset("cotton"));
        *fabric.bend_stiffness *= factor;
        const double coefficient = drape_coefficient(fabric, 10);
        CHECK(coefficient > before);
        before = coefficient;
    }
    CHECK(before > 97.0);
}

}  // namespace percale::test::cusick_test
