#include "garment/cloth_warnings.h"

#include <algorithm>

#include "common/scene_file_error.h"
#include "common/text.h"

namespace percale::scenes {
namespace {

/// kg/m^2, of cloth that nothing is said about: from silk gauze to chain mail. Outside a unit is likely wrong.
constexpr double lightest_cloth = 0.005, heaviest_cloth = 15.0;

Finding density_warning(const Scene& scene, const std::string& name, double density) {
    const bool heavy = density > heaviest_cloth;
    return finding("area_density", {scene.file},
                   "fabric '" + name + "': area_density " + short_number(density) + " kg/m^2 is too " +
                       (heavy ? "heavy" : "light") + " for cloth (" + short_number(lightest_cloth) + " ... " +
                       short_number(heaviest_cloth) + ")",
                   "set " + short_number(heavy ? density / 1000.0 : 1000.0 * density) + " kg/m^2, if that was meant");
}

bool in_one_place(const TriangleMesh& a, const TriangleMesh& b, double thickness) {
    return std::ranges::equal(a.vertices, b.vertices,
                              [&](const Vec3& x, const Vec3& y) { return (x - y).squaredNorm() < thickness * thickness; });
}

}  // namespace

std::vector<Finding> cloth_warnings(const Scene& scene, std::span<const TriangleMesh> starts) {
    std::vector<Finding> warnings;
    for (const auto& [name, fabric] : scene.fabrics) {
        const bool used = std::ranges::find(scene.cloths, name, &ClothSpec::fabric) != scene.cloths.end();
        const bool likely = fabric.area_density >= lightest_cloth && fabric.area_density <= heaviest_cloth;
        if (used && !likely) warnings.push_back(density_warning(scene, name, fabric.area_density));
    }
    for (std::size_t b = 0; b < starts.size(); ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            const Fabric &first = scene.fabrics.at(scene.cloths[a].fabric), &second = scene.fabrics.at(scene.cloths[b].fabric);
            const double thickness = std::min(first.thickness, second.thickness);
            if ((first.self_contact && second.self_contact) || !in_one_place(starts[a], starts[b], thickness)) continue;
            warnings.push_back(finding("cloths_in_one_place", scene.cloths[b].place,
                                       "cloths '" + scene.cloths[a].name + "' and '" + scene.cloths[b].name +
                                           "' lie in one place and pass through each other",
                                       "self_contact = true of their fabrics lets them meet"));
        }
    }
    return warnings;
}

}  // namespace percale::scenes
