#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>

#include "tests/support/collision/c_twin.h"

namespace percale::test::twin_scenes_test {

// The same scenes made through C++ and through C step alike in every bit.
namespace {

const Fabric towel{.thickness = 0.02, .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0}};
const Options towel_options{
    {"thickness", "0.02"}, {"springs.structural", "1000"}, {"springs.shear", "500"}, {"springs.bend", "10"}};
const Fabric meeting{.thickness = 0.02, .self_contact = true, .springs = towel.springs};
const Options meeting_options{{"thickness", "0.02"}, {"self_contact", "true"}, {"springs.shear", "500"}, {"springs.bend", "10"}};
const StepSettings plain{.time_step = 1.0 / 64.0};
const Options plain_options{{"time_step", "0.015625"}};

struct TwinScene {
    const char* name;
    const char* detector;
    int steps;
    std::function<void(Twin&)> make;
    std::function<void(Twin&, int step)> before_step = [](Twin&, int) {};
    StepSettings settings = plain;
    Options options = plain_options;
    bool fails = false;
};

void hang(Twin& twin) {
    const int cloth = twin.add_cloth(make_grid(1.0, 1.0, 11, 11), towel, towel_options);
    for (const int corner : {0, 10}) twin.pin(cloth, corner);
}

void drape(Twin& twin) {
    twin.add_cloth(make_grid(0.6, 0.6, 13, 13), towel, towel_options, {0.0, 0.33, 0.0});
    twin.add_obstacle(make_sphere(0.3, 2), {.friction = 0.4});
}

void sew_two(Twin& twin) {
    const int left = twin.add_cloth(make_grid(0.4, 0.4, 7, 7), towel, towel_options);
    const int right = twin.add_cloth(make_grid(0.4, 0.4, 7, 7), towel, towel_options, {0.45, 0.0, 0.0});
    for (const int corner : {0, 42}) twin.pin(left, corner);
    std::vector<Stitch> stitches;
    std::vector<percale_stitch> same;
    for (int row = 0; row < 7; ++row) stitches.push_back({7 * row + 6, 7 * row, 7 * std::min(row + 1, 6), 0.25});
    for (const Stitch& stitch : stitches) same.push_back({stitch.vertex, stitch.from, stitch.to, stitch.share});
    auto settings = c_struct(percale_init_seam_settings);
    settings.over = 0.1;
    settings.weld = 1;
    settings.stiffness = 500.0;
    const int cloths[2] = {left, right};
    int seam = -1;
    well(percale_add_seam(twin.c(), cloths, same.data(), same.size(), &settings, &seam));
    REQUIRE(twin.cpp().add_seam({left}, {right}, stitches, {.over = 0.1, .stiffness = 500.0, .weld = true}).index == seam);
}

void stack_two(Twin& twin) {
    const int lower = twin.add_cloth(make_grid(0.4, 0.4, 7, 7), meeting, meeting_options, {0.0, 0.05, 0.0});
    const int upper = twin.add_cloth(make_grid(0.3, 0.3, 6, 6), meeting, meeting_options, {0.02, 0.09, 0.01});
    twin.add_obstacle(make_plane(1.0));
    const double thickness = 0.015;
    twin.cpp().set_pair({lower}, {upper}, {.thickness = thickness});
    well(percale_set_pair(twin.c(), lower, upper, 1, &thickness));
    twin.cpp().set_layer({upper}, 2);
    well(percale_set_layer(twin.c(), upper, 2));
}

void save_and_restore(Twin& twin, int step) {
    static std::vector<char> bytes;
    static std::vector<std::byte> same;
    if (step == 5) {
        bytes = c_saved(twin.c());
        same = twin.cpp().save();
        REQUIRE(bytes.size() == same.size());
        CHECK(std::memcmp(bytes.data(), same.data(), same.size()) == 0);
    }
    if (step != 12) return;
    well(percale_restore(twin.c(), same.data(), same.size()));  // what C++ has saved, and the other way round
    twin.cpp().restore(std::as_bytes(std::span(bytes)));
    CHECK(c_hash(twin.c()) == twin.cpp().state_hash());
}

std::vector<Vec3> swollen(const TriangleMesh& mesh, double share) {
    std::vector<Vec3> vertices = mesh.vertices;
    for (Vec3& x : vertices) x.x() *= 1.0 + share;
    return vertices;
}

void change_weather(Twin& twin, int step) {
    const Vec3 gravity(0.5, -5.0, 0.0), wind(0.0, 0.0, 3.0 + step);
    if (step == 3) {
        twin.cpp().set_gravity(gravity);
        well(percale_set_gravity(twin.c(), gravity.data()));
    }
    if (step < 6) return;
    twin.cpp().set_wind(wind);
    well(percale_set_wind(twin.c(), wind.data()));
    twin.cpp().set_time_step(0.01);
    well(percale_set_time_step(twin.c(), 0.01));
    twin.cpp().set_work_limit(500);
    well(percale_set_work_limit(twin.c(), 500));
    twin.cpp().set_time_limit(1e3);
    well(percale_set_time_limit(twin.c(), 1e3));
}

void teleport_all(Twin& twin, int step) {
    if (step != 6) return;
    const double half = std::numbers::pi / 8.0;
    const Pose motion{.translation = {3.0, 1.0, 0.0}, .rotation = {std::cos(half), 0.0, std::sin(half), 0.0}};
    percale_pose same = percale_identity_pose();
    same.translation[0] = 3.0;
    same.translation[1] = 1.0;
    same.rotation[0] = motion.rotation.w;
    same.rotation[2] = motion.rotation.y;
    const ClothId cloth{0};
    const ObstacleId ball{0};
    twin.cpp().teleport({&cloth, 1}, {&ball, 1}, motion, TeleportVelocities::clear);
    const int zero = 0;
    const std::size_t counts[2] = {1, 1};
    well(percale_teleport(twin.c(), &zero, &zero, counts, &same, 0));
}

void throw_cloth(Twin& twin, int step) {
    if (step != 2) return;
    std::vector<Vec3> places(twin.cpp().positions({0}).begin(), twin.cpp().positions({0}).end()), speeds;
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i].y() += 0.1;
        speeds.emplace_back(0.5, 0.01 * static_cast<double>(i), 0.0);
    }
    twin.cpp().set_positions({0}, places);
    twin.cpp().set_velocities({0}, speeds);
    well(percale_set_positions(twin.c(), 0, places[0].data(), places.size()));
    well(percale_set_velocities(twin.c(), 0, speeds[0].data(), speeds.size()));
}

void change_what_it_is_made_of(Twin& twin, int step) {
    const Fabric silk{.thickness = 0.01, .springs = {.structural = 400.0, .shear = 100.0, .bend = 1.0}};
    const Options silk_options{
        {"thickness", "0.01"}, {"springs.structural", "400"}, {"springs.shear", "100"}, {"springs.bend", "1"}};
    if (step == 8) {
        twin.cpp().set_fabric({0}, silk);
        well(percale_set_fabric(twin.c(), 0, c_fabric(silk_options).get()));
    }
    if (step != 4) return;
    twin.cpp().set_friction({0}, 0.05);
    well(percale_set_friction(twin.c(), 0, 0.05));
    twin.cpp().set_restitution({0}, 0.8);
    well(percale_set_restitution(twin.c(), 0, 0.8));
}

void start_again(Twin& twin, int step) {
    if (step == 10) {
        twin.cpp().reset({0});
        well(percale_reset(twin.c(), 0));
    }
    twin.cpp().keep_previous_positions(step < 12);
    well(percale_keep_previous_positions(twin.c(), step < 12));
}

void drape_two(Twin& twin) {
    drape(twin);
    twin.add_cloth(make_grid(0.3, 0.3, 6, 6), towel, towel_options, {0.0, 0.38, 0.0});
    twin.add_obstacle(make_plane(1.0));
}

void take_out(Twin& twin, int step) {
    if (step == 6) {
        twin.cpp().remove_cloth({0});
        well(percale_remove_cloth(twin.c(), 0));
    }
    if (step == 14) {
        twin.cpp().remove_obstacle({0});
        well(percale_remove_obstacle(twin.c(), 0));
    }
    if (step == 16) twin.pin(1, 5);
}

/// A free mesh of a measured fabric, cut along x, that is a tenth too wide where it starts.
void wear(Twin& twin) {
    TriangleMesh mesh = make_grid(0.5, 0.5, 8, 8);
    mesh.grid_columns = mesh.grid_rows = 0;
    const TriangleMesh flat = mesh;
    for (Vec3& x : mesh.vertices) x.z() *= 1.1;
    const Pose pose{.translation = {0.0, 1.0, 0.0}, .scale = 2.0};
    auto settings = c_struct(percale_init_cloth_settings);
    settings.pose.translation[1] = 1.0;
    settings.pose.scale = 2.0;
    settings.warp[0] = 1.0;
    const CMesh rest_mesh = c_mesh(flat);
    settings.rest_mesh = rest_mesh.get();
    RestShape rest = rest_shape_of(mesh, flat, "cloth");
    rest.warp = {1.0, 0.0, 0.0};
    const Fabric fabric{
        .thickness = 0.01, .stretch_stiffness = {{800.0, 600.0}}, .shear_stiffness = 90.0, .bend_stiffness = 1e-4};
    const Options same{
        {"thickness", "0.01"}, {"stretch_stiffness", "800 600"}, {"shear_stiffness", "90"}, {"bend_stiffness", "1e-4"}};
    const int first = twin.add_cloth_as({mesh, fabric, same, pose, rest}, settings);
    for (const int corner : {0, 7}) twin.pin(first, corner);
    std::vector<double> corners;
    for (const auto& triangle : rest.corners) {
        for (const Vec3& x : triangle) corners.insert(corners.end(), x.data(), x.data() + 3);
    }
    settings.rest_mesh = nullptr;
    settings.rest_corners = corners.data();
    settings.rest_corner_triangles = rest.corners.size();
    const int second = twin.add_cloth_as({mesh, fabric, same, pose, rest}, settings);
    for (const int corner : {0, 7}) twin.pin(second, corner);
}

void squeeze(Twin& twin) {
    twin.add_cloth(make_grid(0.3, 0.3, 7, 7), towel, towel_options, {0.0, 0.025, 0.0});
    twin.add_obstacle(make_plane(0.5));
    TriangleMesh lid = make_plane(0.5);
    for (Triangle& triangle : lid.triangles) std::swap(triangle[1], triangle[2]);
    for (Vec3& x : lid.vertices) x.y() = 0.3;
    twin.add_obstacle(lid);
}

const TriangleMesh ball = make_sphere(0.3, 2);

const TwinScene twin_scenes[] = {
    {"hanging sheet", "none", 20, hang},
#ifdef PERCALE_HAS_FCL
    {"sheet on a ball, fcl", "fcl", 30, drape},
#endif
#ifdef PERCALE_HAS_BULLET
    {"sheet on a ball, bullet", "bullet", 30, drape},
#endif
    {"sheet on a ball, brute force", "brute_force", 30, drape},
    {"pins that move, and go", "none", 20, hang,
     [](Twin& twin, int step) {
         if (step < 12) twin.move_pin(0, 0, {-0.5 + 0.01 * step, 0.01 * step, -0.5});
         if (step == 12) twin.unpin(0, 10);
     }},
    {"a ball that moves and turns", "brute_force", 25, drape,
     [](Twin& twin, int step) {
         const double half = 0.02 * step;
         twin.move_obstacle(0, {.translation = {0.004 * step, 0.0, 0.0}, .rotation = {std::cos(half), 0.0, std::sin(half), 0.0}});
     }},
    {"a seam between vertices and points", "none", 25, sew_two},
    {"two sheets that meet, in pairs and layers", "brute_force", 25, stack_two},
    {"saved by one, restored by the other", "brute_force", 20, drape, save_and_restore},
    {"a ball that deforms", "brute_force", 20,
     [](Twin& twin) {
         twin.add_cloth(make_grid(0.6, 0.6, 13, 13), towel, towel_options, {0.0, 0.33, 0.0});
         twin.add_obstacle(ball, {.restitution = 0.2, .deforming = true});
     },
     [](Twin& twin, int step) { twin.deform_obstacle(0, swollen(ball, 0.01 * step)); }},
    {"gravity, wind and time step that change", "none", 15, hang, change_weather},
    {"teleported, velocities cleared", "brute_force", 20, drape, teleport_all},
    {"thrown", "none", 10, hang, throw_cloth},
    {"another fabric, friction and restitution", "brute_force", 20, drape, change_what_it_is_made_of},
    {"put back to where it was added", "brute_force", 20, drape, start_again},
    {"a cloth and an obstacle that are taken out", "brute_force", 25, drape_two, take_out},
    {"a rest shape of its own, by mesh and by corners", "none", 15, wear},
    {"projected contact",
     "brute_force",
     15,
     drape,
     [](Twin&, int) {},
     {.time_step = 1.0 / 64.0, .contact_response = ContactResponse::projection},
     {{"time_step", "0.015625"}, {"contact_response", "projection"}}},
    {"steps of automatic length, TR-BDF2, all figures",
     "none",
     10,
     hang,
     [](Twin&, int) {},
     {.adaptive = true, .tolerance = 1e-2, .scheme = Scheme::tr_bdf2, .measure = StepMeasures::ledger},
     {{"time_step", "auto"}, {"tolerance", "0.01"}, {"scheme", "tr_bdf2"}, {"measure", "ledger"}}},
    {"a lid that comes down on the sheet until a step fails", "brute_force", 12, squeeze,
     [](Twin& twin, int step) {
         twin.move_obstacle(1, {.translation = {0.0, std::max(-0.3, -0.03 * step), 0.0}});
     },
     plain, plain_options, true},
};

}  // namespace

TEST_CASE("The same scenes through C++ and through C have equal state hashes after every step") {
    CHECK(std::size(twin_scenes) >= 15);
    for (const TwinScene& scene : twin_scenes) {
        INFO(scene.name);
        Twin twin(scene.detector, scene.settings, scene.options);
        scene.make(twin);
        const std::uint64_t start = twin.cpp().state_hash();
        REQUIRE(c_hash(twin.c()) == start);
        for (int step = 0; step < scene.steps; ++step) {
            INFO("step " << step);
            scene.before_step(twin, step);
            twin.step();
        }
        CHECK(twin.cpp().state_hash() != start);
        CHECK((twin.failed_steps() > 0) == scene.fails);
    }
}

}  // namespace percale::test::twin_scenes_test
