#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "percale/percale.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/c_objects.h"

namespace percale::test {

inline std::unique_ptr<ContactDetector> cpp_detector(const std::string& word) {
    for (const Backend& backend : backends()) {
        if (backend.name == word) return backend.make_detector();
    }
    return nullptr;
}

/// The same simulation made twice, by equivalent calls of C++ and of C.
class Twin {
public:
    /// `settings` and `options` have the same values.
    Twin(const char* detector, const StepSettings& settings, const Options& options)
        : cpp_(settings, cpp_detector(detector)), c_(c_simulation(detector, options)) {}

    Simulation& cpp() { return cpp_; }
    percale_simulation* c() { return c_.get(); }
    int failed_steps() const { return failed_steps_; }

    int add_cloth(const TriangleMesh& mesh, const Fabric& fabric, const Options& options, const Vec3& place = Vec3::Zero()) {
        auto settings = c_struct(percale_init_cloth_settings);
        std::copy_n(place.data(), 3, settings.pose.translation);
        return add_cloth_as({mesh, fabric, options, {.translation = place}, {}}, settings);
    }

    struct Cloth {
        TriangleMesh mesh;
        Fabric fabric;
        Options options;  // the same values as fabric
        Pose pose;
        RestShape rest;
    };
    /// `settings` have the same values as pose and rest.
    int add_cloth_as(const Cloth& cloth, const percale_cloth_settings& settings) {
        percale_mesh* grid = nullptr;
        if (cloth.mesh.is_grid()) {
            const Vec3 size = -2.0 * cloth.mesh.vertices.front();
            well(percale_make_grid(size.x(), size.z(), cloth.mesh.grid_columns, cloth.mesh.grid_rows, &grid));
        }
        const CMesh mesh = grid != nullptr ? CMesh(grid) : c_mesh(cloth.mesh);
        int number = -1;
        well(percale_add_cloth(c(), mesh.get(), c_fabric(cloth.options).get(), &settings, &number));
        REQUIRE(cpp_.add_cloth(cloth.mesh, cloth.fabric, cloth.pose, "cloth", cloth.rest).index == number);
        return number;
    }

    int add_obstacle(const TriangleMesh& mesh, const ObstacleSettings& settings = {}) {
        auto same = c_struct(percale_init_obstacle_settings);
        same.friction = settings.friction;
        same.restitution = settings.restitution;
        same.deforming = settings.deforming;
        same.yields = settings.yields;
        int number = -1;
        well(percale_add_obstacle(c(), c_mesh(mesh).get(), &same, &number));
        REQUIRE(cpp_.add_obstacle(mesh, {}, settings).index == number);
        return number;
    }

    void pin(int cloth, int vertex) {
        cpp_.pin({cloth}, vertex);
        well(percale_pin(c(), cloth, vertex));
    }
    void unpin(int cloth, int vertex) {
        cpp_.unpin({cloth}, vertex);
        well(percale_unpin(c(), cloth, vertex));
    }
    void move_pin(int cloth, int vertex, const Vec3& target) {
        cpp_.move_pin({cloth}, vertex, target);
        well(percale_move_pin(c(), cloth, vertex, target.data()));
    }
    void move_obstacle(int obstacle, const Pose& end) {
        cpp_.move_obstacle({obstacle}, end);
        percale_pose same = percale_identity_pose();
        std::copy_n(end.translation.data(), 3, same.translation);
        const std::array<double, 4> turn{end.rotation.w, end.rotation.x, end.rotation.y, end.rotation.z};
        std::ranges::copy(turn, same.rotation);
        same.scale = end.scale;
        well(percale_move_obstacle(c(), obstacle, &same));
    }
    void deform_obstacle(int obstacle, const std::vector<Vec3>& end) {
        cpp_.deform_obstacle({obstacle}, end);
        well(percale_deform_obstacle(c(), obstacle, end[0].data(), end.size()));
    }

    /// One step of both; their reports and the state's bits must agree.
    void step() {
        const StepReport report = cpp_.step();
        auto same = c_struct(percale_init_step_report);
        const percale_status status = percale_step(c(), &same);
        INFO(report.explanation() << " " << percale_last_error(c()));
        REQUIRE((status == PERCALE_OK) == report.ok());
        CHECK(same.status == static_cast<int>(report.status));
        failed_steps_ += report.ok() ? 0 : 1;
        CHECK(same.contact_hash == report.contact_hash);
        CHECK(same.newton_iterations == report.newton_iterations);
        CHECK(same.linear_iterations == report.linear_iterations);
        CHECK(same.contacts == report.contacts);
        CHECK(same.time == report.time);
        CHECK(percale_explanation(c()) == report.explanation());
        REQUIRE(c_hash(c()) == cpp_.state_hash());
    }

private:
    Simulation cpp_;
    CSimulation c_;
    int failed_steps_ = 0;
};

}  // namespace percale::test
