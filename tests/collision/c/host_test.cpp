#include "collision/c/host.h"

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "collision/c/call.h"
#include "tests/support/collision/c_objects.h"

namespace percale::test::host_test {
namespace {

/// A host that begins threads for every run.
struct ThreadHost {
    int threads = 3;
    std::atomic<int> runs = 0;
    int left_out = 0;    // parts of every run that are not done
    int slot_shift = 0;  // added to slots
};

void run_on_threads(void* host, int parts, void (*work)(void* data, int part, int slot), void* data) {
    ThreadHost& of = *static_cast<ThreadHost*>(host);
    ++of.runs;
    std::atomic<int> next = 0;
    const auto take = [&](int slot) {
        for (int part = next++; part < parts - of.left_out; part = next++) work(data, part, slot + of.slot_shift);
    };
    std::vector<std::thread> others;
    for (int slot = 1; slot < of.threads; ++slot) others.emplace_back(take, slot);
    take(0);
    for (std::thread& other : others) other.join();
}

percale_workers workers_of(ThreadHost& host) {
    auto workers = c_struct(percale_init_workers);
    workers.threads = host.threads;
    workers.host = &host;
    workers.run = run_on_threads;
    return workers;
}

/// The state's hashes of a sheet that swings for some steps.
std::vector<std::uint64_t> swinging_hashes(const percale_workers* workers, const Options& options) {
    const CSimulation simulation = c_simulation("none", options, workers);
    const CFabric fabric = c_fabric({{"springs.shear", "500"}, {"springs.bend", "10"}});
    c_add_cloth(simulation.get(), c_grid(1.0, 40).get(), fabric.get());
    for (const int corner : {0, 39}) well(percale_pin(simulation.get(), 0, corner));
    std::vector<std::uint64_t> hashes;
    for (int step = 0; step < 5; ++step) {
        well(percale_step(simulation.get(), nullptr));
        hashes.push_back(c_hash(simulation.get()));
    }
    return hashes;
}

}  // namespace

TEST_CASE("A host's threads give the same state in every bit as the library's, and as none") {
    ThreadHost host;
    const percale_workers workers = workers_of(host);
    const auto alone = swinging_hashes(nullptr, {{"threads", "1"}});
    CHECK(swinging_hashes(&workers, {{"threads", "1"}}) == alone);
    CHECK(host.runs > 0);
    CHECK(swinging_hashes(nullptr, {{"threads", "2"}}) == alone);
}

TEST_CASE("A simulation whose host leaves out parts, or numbers its threads wrongly, reports it from then on") {
    ThreadHost host;
    const percale_workers workers = workers_of(host);
    const CSimulation simulation = c_simulation("none", {}, &workers);
    c_add_cloth(simulation.get(), c_grid(1.0, 40).get(), c_fabric().get());
    well(percale_pin(simulation.get(), 0, 0));
    well(percale_step(simulation.get(), nullptr));
    REQUIRE(host.runs > 0);
    SECTION("a part less") { host.left_out = 1; }
    SECTION("slots that there are not") { host.slot_shift = 64; }
    fails(percale_step(simulation.get(), nullptr), PERCALE_INTERNAL_ERROR, "percale_step", "workers.run");
    host.left_out = host.slot_shift = 0;
    fails(percale_step(simulation.get(), nullptr), PERCALE_INTERNAL_ERROR, "percale_step", "workers.run");
}

TEST_CASE("Threads of a host are refused out of range and without a callback") {
    ThreadHost host;
    percale_simulation* made = nullptr;
    auto setup = c_struct(percale_init_setup);
    percale_workers workers = workers_of(host);
    setup.workers = &workers;
    for (const int threads : {0, -1, 65}) {
        workers.threads = threads;
        fails(percale_create_simulation(&setup, &made), PERCALE_INVALID_ARGUMENT, "percale_create_simulation", "1 ... 64");
    }
    workers = workers_of(host);
    workers.run = nullptr;
    fails(percale_create_simulation(&setup, &made), PERCALE_INVALID_ARGUMENT, "percale_create_simulation", "workers.run");
    workers = workers_of(host);
    workers.struct_size = 4;
    fails(percale_create_simulation(&setup, &made), PERCALE_INVALID_ARGUMENT, "percale_create_simulation", "struct_size");
    CHECK(made == nullptr);
}

TEST_CASE("A detector is chosen by its word, and one that is not built is refused as such") {
    CHECK(c_interface::make_detector("none") == nullptr);
    CHECK(c_interface::make_detector("brute_force") != nullptr);
    CHECK_THROWS_WITH(c_interface::make_detector("fc"), Catch::Contains("fcl, bullet, brute_force, none"));
#ifdef PERCALE_HAS_FCL
    CHECK(percale_has_detector("fcl") == 1);
#else
    CHECK_THROWS_AS(c_interface::make_detector("fcl"), c_interface::CallError);
    CHECK(percale_has_detector("fcl") == 0);
#endif
#ifdef PERCALE_HAS_BULLET
    CHECK(percale_has_detector("bullet") == 1);
#else
    CHECK_THROWS_AS(c_interface::make_detector("bullet"), c_interface::CallError);
    CHECK(percale_has_detector("bullet") == 0);
#endif
}

}  // namespace percale::test::host_test
