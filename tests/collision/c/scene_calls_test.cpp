#include <cmath>
#include <functional>
#include <string>

#include "tests/support/collision/c_objects.h"

namespace percale::test::scene_calls_test {
namespace {

struct BadScene {
    const char* function;
    const char* part;
    std::function<percale_status(percale_simulation*, int* number)> make;
};

const CMesh& sheet() {
    static const CMesh mesh = c_grid(0.3, 4);
    return mesh;
}

const CFabric& cotton() {
    static const CFabric fabric = c_fabric({{"springs.shear", "500"}});
    return fabric;
}

percale_cloth_settings cloth_with(const std::function<void(percale_cloth_settings&)>& change) {
    auto settings = c_struct(percale_init_cloth_settings);
    change(settings);
    return settings;
}

percale_status add_cloth_with(percale_simulation* simulation, int* number,
                              const std::function<void(percale_cloth_settings&)>& change) {
    const percale_cloth_settings settings = cloth_with(change);
    return percale_add_cloth(simulation, sheet().get(), cotton().get(), &settings, number);
}

percale_status add_obstacle_with(percale_simulation* simulation, int* number,
                                 const std::function<void(percale_obstacle_settings&)>& change) {
    auto settings = c_struct(percale_init_obstacle_settings);
    change(settings);
    return percale_add_obstacle(simulation, sheet().get(), &settings, number);
}

percale_status add_seam_with(
    percale_simulation* simulation, int* number, percale_stitch stitch,
    const std::function<void(percale_seam_settings&)>& change = [](auto&) {}) {
    auto settings = c_struct(percale_init_seam_settings);
    change(settings);
    const int cloths[2] = {0, 0};
    return percale_add_seam(simulation, cloths, &stitch, 1, &settings, number);
}

const double corners_of_one[9] = {0, 0, 0, 1, 0, 0, 0, 0, 1};
const int no_cloths[2] = {0, 5}, one_cloth[2] = {0, 0};
const percale_stitch well_sewn{0, 5, 5, 0.0};

const BadScene bad_scenes[] = {
    {"percale_add_cloth", "mesh", [](auto* s, int* n) { return percale_add_cloth(s, nullptr, cotton().get(), nullptr, n); }},
    {"percale_add_cloth", "fabric", [](auto* s, int* n) { return percale_add_cloth(s, sheet().get(), nullptr, nullptr, n); }},
    {"percale_add_cloth", "the place for the number",
     [](auto* s, int*) { return percale_add_cloth(s, sheet().get(), cotton().get(), nullptr, nullptr); }},
    {"percale_add_cloth", "name: is NULL",
     [](auto* s, int* n) { return add_cloth_with(s, n, [](auto& with) { with.name = nullptr; }); }},
    {"percale_add_cloth", "struct_size",
     [](auto* s, int* n) { return add_cloth_with(s, n, [](auto& with) { with.struct_size += 8; }); }},
    {"percale_add_cloth", "scale",
     [](auto* s, int* n) { return add_cloth_with(s, n, [](auto& with) { with.pose.scale = 0.0; }); }},
    {"percale_add_cloth", "towel",
     [](auto* s, int* n) {
         return add_cloth_with(s, n, [](auto& with) { with.pose.translation[0] = std::nan(""), with.name = "towel"; });
     }},
    {"percale_add_cloth", "exclude",
     [](auto* s, int* n) {
         return add_cloth_with(s, n, [](auto& with) {
             with.rest_mesh = sheet().get();
             with.rest_corners = corners_of_one;
             with.rest_corner_triangles = 18;
         });
     }},
    {"percale_add_cloth", "1 triangles, the mesh has 18",
     [](auto* s, int* n) {
         return add_cloth_with(s, n, [](auto& with) { with.rest_corners = corners_of_one, with.rest_corner_triangles = 1; });
     }},
    {"percale_add_cloth", "rest_corners is NULL",
     [](auto* s, int* n) { return add_cloth_with(s, n, [](auto& with) { with.rest_corner_triangles = 18; }); }},
    {"percale_add_cloth", "triangles",
     [](auto* s, int* n) {
         const CMesh other = c_sphere(1.0, 0);
         return add_cloth_with(s, n, [&](auto& with) { with.rest_mesh = other.get(); });
     }},
    {"percale_add_cloth", "exclude",
     [](auto* s, int* n) {
         const CFabric wrong = c_fabric({{"pressure", "10"}, {"gas_volume", "1"}});
         return percale_add_cloth(s, sheet().get(), wrong.get(), nullptr, n);
     }},
    {"percale_add_obstacle", "mesh", [](auto* s, int* n) { return percale_add_obstacle(s, nullptr, nullptr, n); }},
    {"percale_add_obstacle", "NULL", [](auto* s, int*) { return percale_add_obstacle(s, sheet().get(), nullptr, nullptr); }},
    {"percale_add_obstacle", "0 ... 10",
     [](auto* s, int* n) { return add_obstacle_with(s, n, [](auto& with) { with.friction = 11.0; }); }},
    {"percale_add_obstacle", "restitution",
     [](auto* s, int* n) { return add_obstacle_with(s, n, [](auto& with) { with.restitution = std::nan(""); }); }},
    {"percale_add_obstacle", "name: is NULL",
     [](auto* s, int* n) { return add_obstacle_with(s, n, [](auto& with) { with.name = nullptr; }); }},
    {"percale_add_obstacle", "struct_size",
     [](auto* s, int* n) { return add_obstacle_with(s, n, [](auto& with) { with.struct_size = 0; }); }},
    {"percale_add_seam", "cloths", [](auto* s, int* n) { return percale_add_seam(s, nullptr, &well_sewn, 1, nullptr, n); }},
    {"percale_add_seam", "stitches", [](auto* s, int* n) { return percale_add_seam(s, one_cloth, nullptr, 1, nullptr, n); }},
    {"percale_add_seam", "no vertices", [](auto* s, int* n) { return percale_add_seam(s, one_cloth, nullptr, 0, nullptr, n); }},
    {"percale_add_seam", "NULL", [](auto* s, int*) { return percale_add_seam(s, one_cloth, &well_sewn, 1, nullptr, nullptr); }},
    {"percale_add_seam", "5", [](auto* s, int* n) { return percale_add_seam(s, no_cloths, &well_sewn, 1, nullptr, n); }},
    {"percale_add_seam", "81",
     [](auto* s, int* n) {
         return add_seam_with(s, n, {81, 0, 0, 0.0});
     }},
    {"percale_add_seam", "itself",
     [](auto* s, int* n) {
         return add_seam_with(s, n, {3, 3, 3, 0.0});
     }},
    {"percale_add_seam", "share",
     [](auto* s, int* n) {
         return add_seam_with(s, n, {3, 5, 6, 1.5});
     }},
    {"percale_add_seam", "stiffness",
     [](auto* s, int* n) { return add_seam_with(s, n, well_sewn, [](auto& with) { with.stiffness = 0.0; }); }},
    {"percale_add_seam", "name: is NULL",
     [](auto* s, int* n) { return add_seam_with(s, n, well_sewn, [](auto& with) { with.name = nullptr; }); }},
    {"percale_set_pair", "self_contact", [](auto* s, int*) { return percale_set_pair(s, 0, 0, 1, nullptr); }},
    {"percale_set_pair", "7", [](auto* s, int*) { return percale_set_pair(s, 0, 7, 0, nullptr); }},
    {"percale_set_layer", "1001", [](auto* s, int*) { return percale_set_layer(s, 0, 1001); }},
    {"percale_set_layer", "self_contact", [](auto* s, int*) { return percale_set_layer(s, 0, 1); }},
    {"percale_set_layer", "-1", [](auto* s, int*) { return percale_set_layer(s, -1, 1); }},
    {"percale_remove_cloth", "1", [](auto* s, int*) { return percale_remove_cloth(s, 1); }},
    {"percale_remove_obstacle", "-1", [](auto* s, int*) { return percale_remove_obstacle(s, -1); }},
    {"percale_set_fabric", "fabric", [](auto* s, int*) { return percale_set_fabric(s, 0, nullptr); }},
    {"percale_set_fabric", "2", [](auto* s, int*) { return percale_set_fabric(s, 2, cotton().get()); }},
    {"percale_set_fabric", "exclude",
     [](auto* s, int*) {
         return percale_set_fabric(s, 0, c_fabric({{"pressure", "10"}, {"gas_volume", "1"}}).get());
     }},
    {"percale_set_friction", "0 ... 10", [](auto* s, int*) { return percale_set_friction(s, 0, 11.0); }},
    {"percale_set_friction", "4", [](auto* s, int*) { return percale_set_friction(s, 4, 0.5); }},
    {"percale_set_restitution", "0 ... 1", [](auto* s, int*) { return percale_set_restitution(s, 0, std::nan("")); }},
    {"percale_set_restitution", "3", [](auto* s, int*) { return percale_set_restitution(s, 3, 0.5); }},
};

}  // namespace

TEST_CASE("Every wrong call that builds a scene is refused in words and leaves the simulation in every bit") {
    const CSimulation simulation = c_sheet_over_ball();
    for (int step = 0; step < 3; ++step) well(percale_step(simulation.get(), nullptr));
    const std::vector<char> before = c_saved(simulation.get());
    for (const BadScene& bad : bad_scenes) {
        int number = 77;
        fails(bad.make(simulation.get(), &number), PERCALE_INVALID_ARGUMENT, bad.function, bad.part);
        CHECK(number == 77);
        CHECK(percale_last_error(simulation.get()) == std::string(percale_last_error(nullptr)));
        CHECK(c_saved(simulation.get()) == before);
        fails(bad.make(nullptr, &number), PERCALE_INVALID_ARGUMENT, bad.function, "simulation: is NULL");
    }
    CHECK(percale_step(simulation.get(), nullptr) == PERCALE_OK);
}

TEST_CASE("A simulation is refused without a setup, with a wrong one, and for a detector that is none") {
    percale_simulation* made = nullptr;
    const auto refused = [&](const percale_setup* setup, percale_status status, const char* part) {
        fails(percale_create_simulation(setup, &made), status, "percale_create_simulation", part);
        CHECK(made == nullptr);
    };
    refused(nullptr, PERCALE_INVALID_ARGUMENT, "setup");
    auto setup = c_struct(percale_init_setup);
    fails(percale_create_simulation(&setup, nullptr), PERCALE_INVALID_ARGUMENT, "percale_create_simulation", "NULL");
    setup.detector = "ode";
    refused(&setup, PERCALE_INVALID_ARGUMENT, "brute_force");
    setup.detector = nullptr;
    refused(&setup, PERCALE_INVALID_ARGUMENT, "detector");
    for (const char* word : {"fcl", "bullet"}) {
        setup.detector = word;
        if (percale_has_detector(word) == 0) refused(&setup, PERCALE_NOT_BUILT, word);
    }
    setup = c_struct(percale_init_setup);
    setup.struct_size -= 8;
    refused(&setup, PERCALE_INVALID_ARGUMENT, "struct_size");
    setup = c_struct(percale_init_setup);
    setup.gravity[0] = std::nan("");
    refused(&setup, PERCALE_INVALID_ARGUMENT, "gravity");
    setup = c_struct(percale_init_setup);
    setup.wind[1] = 1e6;
    percale_simulation* still = nullptr;
    well(percale_create_simulation(&setup, &still));  // without has_wind it is unused
    percale_destroy_simulation(still);
    setup.has_wind = 1;
    refused(&setup, PERCALE_INVALID_ARGUMENT, "wind");
    percale_destroy_simulation(nullptr);
}

TEST_CASE("An obstacle without a detector is refused") {
    const CSimulation simulation = c_simulation("none");
    int number = -5;
    fails(percale_add_obstacle(simulation.get(), c_plane(1.0).get(), nullptr, &number), PERCALE_INVALID_ARGUMENT,
          "percale_add_obstacle", "detector");
    CHECK(number == -5);
}

TEST_CASE("Numbers of cloths and obstacles count up, and meshes and fabrics may go before the simulation") {
    const CSimulation simulation = c_simulation("brute_force");
    for (int i = 0; i < 3; ++i) {
        CHECK(c_add_cloth(simulation.get(), c_grid(0.2, 3).get(), c_fabric().get(), i) == i);
        int number = -1;
        auto settings = c_struct(percale_init_obstacle_settings);
        settings.pose.translation[1] = i + 0.5;
        well(percale_add_obstacle(simulation.get(), c_plane(0.3).get(), &settings, &number));
        CHECK(number == i);
    }
    well(percale_step(simulation.get(), nullptr));
    int cloths = 0;
    well(percale_cloth_count(simulation.get(), &cloths));
    CHECK(cloths == 3);
}

TEST_CASE("Numbers of what was removed are refused and not given again, all others stay good") {
    const CSimulation simulation = c_sheet_over_ball();
    CHECK(c_add_cloth(simulation.get(), sheet().get(), cotton().get(), 2.0) == 1);
    well(percale_step(simulation.get(), nullptr));
    well(percale_remove_cloth(simulation.get(), 0));
    well(percale_remove_obstacle(simulation.get(), 0));
    int cloths = 0;
    well(percale_cloth_count(simulation.get(), &cloths));
    CHECK(cloths == 1);
    std::size_t count = 0;
    fails(percale_vertex_count(simulation.get(), 0, &count), PERCALE_INVALID_ARGUMENT, "percale_vertex_count", "0");
    fails(percale_set_friction(simulation.get(), 0, 0.1), PERCALE_INVALID_ARGUMENT, "percale_set_friction", "0");
    fails(percale_remove_cloth(simulation.get(), 0), PERCALE_INVALID_ARGUMENT, "percale_remove_cloth", "0");
    well(percale_vertex_count(simulation.get(), 1, &count));
    CHECK(count == 16);
    CHECK(c_add_cloth(simulation.get(), sheet().get(), cotton().get(), 3.0) == 2);
    well(percale_step(simulation.get(), nullptr));
}

}  // namespace percale::test::scene_calls_test
