#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "percale.h"
#include "percale/mesh.h"
#include "tests/support/catch.h"

// Objects of the C interface that free themselves, and calls that must succeed.
namespace percale::test {

template <auto destroy>
struct Freed {
    template <class Handle>
    void operator()(Handle* handle) const {
        destroy(handle);
    }
};
using CSimulation = std::unique_ptr<percale_simulation, Freed<percale_destroy_simulation>>;
using CSettings = std::unique_ptr<percale_step_settings, Freed<percale_destroy_step_settings>>;
using CFabric = std::unique_ptr<percale_fabric, Freed<percale_destroy_fabric>>;
using CMesh = std::unique_ptr<percale_mesh, Freed<percale_destroy_mesh>>;
using Options = std::vector<std::pair<const char*, const char*>>;

/// A call that must succeed.
inline void well(percale_status status) {
    INFO(percale_last_error(nullptr));
    REQUIRE(status == PERCALE_OK);
}

template <class Struct>
Struct c_struct(percale_status (*init)(Struct*, std::size_t)) {
    Struct made;
    well(init(&made, sizeof made));
    return made;
}

/// The mesh without its grid.
inline CMesh c_mesh(const TriangleMesh& mesh) {
    percale_mesh* made = nullptr;
    well(percale_create_mesh(mesh.vertices[0].data(), mesh.vertices.size(), mesh.triangles[0].data(), mesh.triangles.size(),
                             &made));
    return CMesh(made);
}

inline CMesh c_grid(double size, int vertices) {
    percale_mesh* made = nullptr;
    well(percale_make_grid(size, size, vertices, vertices, &made));
    return CMesh(made);
}

inline CMesh c_sphere(double radius, int level) {
    percale_mesh* made = nullptr;
    well(percale_make_sphere(radius, level, &made));
    return CMesh(made);
}

inline CMesh c_plane(double half_size) {
    percale_mesh* made = nullptr;
    well(percale_make_plane(half_size, &made));
    return CMesh(made);
}

inline CFabric c_fabric(const Options& options = {}, const char* preset = nullptr) {
    percale_fabric* made = nullptr;
    well(percale_create_fabric(preset, &made));
    CFabric fabric(made);
    for (const auto& [key, value] : options) well(percale_set_fabric_option(made, key, value));
    return fabric;
}

inline CSettings c_settings(const Options& options) {
    percale_step_settings* made = nullptr;
    well(percale_create_step_settings(&made));
    CSettings settings(made);
    for (const auto& [key, value] : options) well(percale_set_step_option(made, key, value));
    return settings;
}

inline CSimulation c_simulation(const char* detector, const Options& options = {}, const percale_workers* workers = nullptr) {
    const CSettings settings = c_settings(options);
    auto setup = c_struct(percale_init_setup);
    setup.detector = detector;
    setup.settings = settings.get();
    setup.workers = workers;
    percale_simulation* made = nullptr;
    well(percale_create_simulation(&setup, &made));
    return CSimulation(made);
}

inline int c_add_cloth(percale_simulation* simulation, const percale_mesh* mesh, const percale_fabric* fabric,
                       double height = 0.0) {
    auto settings = c_struct(percale_init_cloth_settings);
    settings.pose.translation[1] = height;
    int number = -1;
    well(percale_add_cloth(simulation, mesh, fabric, &settings, &number));
    return number;
}

/// A sheet of 9 x 9 vertices just above a ball; both have the number 0.
inline CSimulation c_sheet_over_ball(const char* detector = "brute_force", const Options& options = {}) {
    CSimulation simulation = c_simulation(detector, options);
    const CFabric fabric = c_fabric({{"thickness", "0.02"}, {"springs.shear", "500"}, {"springs.bend", "10"}});
    c_add_cloth(simulation.get(), c_grid(0.6, 9).get(), fabric.get(), 0.33);
    int ball = -1;
    well(percale_add_obstacle(simulation.get(), c_sphere(0.3, 2).get(), nullptr, &ball));
    return simulation;
}

inline std::uint64_t c_hash(const percale_simulation* simulation) {
    std::uint64_t hash = 0;
    well(percale_state_hash(simulation, &hash));
    return hash;
}

inline std::vector<char> c_saved(const percale_simulation* simulation) {
    std::size_t size = 0;
    well(percale_save(simulation, nullptr, 0, &size));
    std::vector<char> bytes(size);
    well(percale_save(simulation, bytes.data(), bytes.size(), nullptr));
    return bytes;
}

/// A call that must fail: its status, and that the error's text names the function and contains `part`.
inline void fails(percale_status status, percale_status expected, const std::string& function, const std::string& part) {
    const std::string text = percale_last_error(nullptr);
    INFO(function << ": " << text);
    CHECK(percale_status_text(status) == std::string(percale_status_text(expected)));
    CHECK(text.find(function + ": ") == 0);
    CHECK(text.find(part) != std::string::npos);
}

}  // namespace percale::test
