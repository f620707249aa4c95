// Steps allocate nothing once sizes are known. Every way to the heap is counted, operator new and malloc alike, so these tests
// are a program of their own.
#include <atomic>
#include <cstdlib>

#include "percale/detectors.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace {

std::atomic<bool> counting{false};
std::atomic<long> counted{0};

void count() {
    if (counting.load(std::memory_order_relaxed)) counted.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

// glibc's own entry points, under which its allocator stays reachable.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
    count();
    return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
    count();
    return __libc_calloc(number, size);
}
void* realloc(void* old, std::size_t size) {
    count();
    return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
    count();
    return __libc_memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) {
    count();
    *result = __libc_memalign(alignment, size);
    return *result ? 0 : 12;
}
}

namespace percale::test::allocations_test {
namespace {

constexpr double sheet_size = 0.5;  // m

/// A scene that has reached a quiet motion: its memory has its final size.
struct Scene {
    const char* name;
    StepSettings settings = {};
    bool ball = false, self_contact = false, free_mesh = false, woven = false;
    int warm_up = 60, steps = 20;
    bool keeps_previous = false;  // Simulation::keep_previous_positions
};

Fabric fabric_of(const Scene& scene) {
    Fabric fabric = scene.free_mesh ? free_fabric() : sheet_fabric();
    fabric.self_contact = scene.self_contact;
    if (!scene.woven) return fabric;
    fabric.springs = {.structural = 0.0};
    fabric.stretch_stiffness = {{400.0, 400.0}};
    fabric.bend_stiffness = 1e-4;
    return fabric;
}

Simulation make_scene(const Scene& scene) {
    Simulation simulation(scene.settings, scene.ball || scene.self_contact ? make_brute_force_detector() : nullptr);
    TriangleMesh mesh = make_grid(sheet_size, sheet_size, 17, 17);
    if (scene.free_mesh) mesh.grid_columns = mesh.grid_rows = 0;
    const ClothId cloth = simulation.add_cloth(mesh, fabric_of(scene), {.translation = Vec3(0.0, 0.12, 0.0)});
    if (scene.ball) simulation.add_obstacle(make_sphere(0.1, 3));
    if (scene.self_contact) simulation.add_cloth(mesh, fabric_of(scene), {.translation = Vec3(0.01, 0.14, 0.02)});
    if (!scene.ball) simulation.pin(cloth, 0);
    if (!scene.ball) simulation.pin(cloth, 16);
    return simulation;
}

/// Allocations in each of the steps after the warm-up.
std::vector<long> allocations(const Scene& scene) {
    Simulation simulation = make_scene(scene);
    simulation.keep_previous_positions(scene.keeps_previous);
    for (int n = 0; n < scene.warm_up; ++n) simulation.step();
    std::vector<long> result(static_cast<std::size_t>(scene.steps), 0);
    for (long& of_step : result) {
        counted = 0;
        counting = true;
        const StepReport report = simulation.step();
        counting = false;
        of_step = counted;
        REQUIRE(report.ok());
        REQUIRE_FALSE(report.slept);
        REQUIRE((report.contacts > 0) == (scene.ball || scene.self_contact));
    }
    return result;
}

long sum(const std::vector<long>& numbers) {
    long total = 0;
    for (const long number : numbers) total += number;
    return total;
}

const StepSettings ledger{.measure = StepMeasures::ledger};

std::vector<Scene> scenes() {
    StepSettings explicit_steps{.time_step = 1e-4, .scheme = Scheme::rk4}, two_threads, tr{.scheme = Scheme::tr_bdf2};
    StepSettings multigrid{.linear_solver = LinearSolver::multigrid};
    StepSettings projection{.contact_response = ContactResponse::projection};
    two_threads.threads = 2;
    return {{.name = "hanging grid", .settings = {}},
            {.name = "hanging grid, positions kept", .settings = {}, .keeps_previous = true},
            {.name = "hanging grid with the ledger", .settings = ledger},
            {.name = "hanging grid by multigrid", .settings = multigrid},
            {.name = "hanging grid, two threads", .settings = two_threads},
            {.name = "hanging free mesh", .settings = {}, .free_mesh = true},
            {.name = "hanging woven mesh", .settings = {}, .free_mesh = true, .woven = true},
            {.name = "explicit", .settings = explicit_steps},
            {.name = "TR-BDF2", .settings = tr},
            {.name = "on a ball, penalty", .settings = {}, .ball = true, .warm_up = 240},
            {.name = "on a ball, TR-BDF2", .settings = tr, .ball = true, .warm_up = 240},
            {.name = "on a ball, projection", .settings = projection, .ball = true, .warm_up = 240},
            {.name = "two sheets on a ball", .settings = {}, .ball = true, .self_contact = true, .warm_up = 280}};
}

}  // namespace

TEST_CASE("The counter sees allocations") {
    counted = 0;
    counting = true;
    std::vector<double> some(100, 1.0);
    AlignedVector<double> aligned(100, 1.0);
    counting = false;
    CHECK(counted == 2);
    CHECK(some[99] + aligned[99] == 2.0);
}

TEST_CASE("Interpolation, and normals into the caller's memory except for one list, allocate nothing") {
    Simulation simulation = make_scene({.name = "ball", .settings = {}, .ball = true});
    simulation.keep_previous_positions();
    for (int n = 0; n < 60; ++n) simulation.step();
    std::vector<Vec3> out(17 * 17);
    counted = 0;
    counting = true;
    simulation.interpolate(0.5, {0}, out);
    counting = false;
    CHECK(counted == 0);
    counting = true;
    simulation.normals({0}, out);
    counting = false;
    CHECK(counted == 1);
}

TEST_CASE("Steps allocate nothing after the first ones") {
    for (const Scene& scene : scenes()) {
        const std::vector<long> counts = allocations(scene);
        std::printf("%s: %ld allocations in %d steps\n", scene.name, sum(counts), scene.steps);
        CAPTURE(scene.name);
        CHECK(sum(counts) == 0);
    }
}

}  // namespace percale::test::allocations_test
