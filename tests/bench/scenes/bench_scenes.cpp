#include "bench_scenes.h"

#include "percale/certify.h"
#include "percale/detectors.h"
#include "scenes/meshes/mesh_import.h"
#include "tests/support/bench_unit.h"
#include "tests/support/real_meshes.h"

namespace percale::test {

Simulation make_sheet_scene(int n, const TriangleMesh* body, double height, const StepSettings& settings, bool deforming) {
    Simulation simulation(settings, body ? make_fcl_detector() : nullptr);
    const ClothId cloth = simulation.add_cloth(make_grid(1.0, 1.0, n, n), bench_fabric(), {.translation = {0.0, height, 0.0}});
    if (body) {
        simulation.add_obstacle(*body, {}, {.deforming = deforming});
    } else {
        simulation.pin(cloth, 0);
        simulation.pin(cloth, n - 1);
    }
    return simulation;
}

double total(const StageTimes& stages) {
    return stages.refresh + stages.evaluate + stages.force + stages.setup + stages.solve + stages.cut + stages.measure;
}

bool is_crossed(const TriangleMesh& sheet, const TriangleMesh& body) {
    const Certificate certificate = certify(sheet, body, 0.0);
    return !certificate.pairs.empty() || certificate.vertices_inside > 0;
}

TriangleMesh body_scan(const std::string& file_name) {
    const std::filesystem::path file = real_mesh_folder() / file_name;
    if (!std::filesystem::exists(file)) return {};
    TriangleMesh mesh = scenes::import_mesh(file.string());
    Vec3 low = mesh.vertices[0], high = low;
    for (const Vec3& x : mesh.vertices) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    for (Vec3& x : mesh.vertices) x = (x - 0.5 * (low + high)) * (0.5 / (high - low).maxCoeff());
    return mesh;
}

TriangleMesh bunny_scan() { return body_scan("bunny00.off"); }

}  // namespace percale::test
