#include "engine/support/thread_pool.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "engine/kernels/compute.h"
#include "percale/simulation.h"
#include "tests/support/catch.h"

namespace percale::test {
namespace {

const Fabric sheet{.area_density = 0.2, .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0}, .spring_damping = 0.1};

/// The states of a hanging sheet that is large enough to be shared out.
std::vector<std::uint64_t> hanging_sheet(int threads, int steps) {
    StepSettings settings;
    settings.threads = threads;
    Simulation simulation(settings);
    const ClothId cloth = simulation.add_cloth(make_grid(1.0, 1.0, 97, 97), sheet);
    simulation.pin(cloth, 0);
    simulation.pin(cloth, 96);
    std::vector<std::uint64_t> hashes;
    for (int k = 0; k < steps; ++k) {
        simulation.step();
        hashes.push_back(simulation.state_hash());
    }
    return hashes;
}

}  // namespace

TEST_CASE("every part is done once, and the same parts by the same thread in every run") {
    for (const int threads : {1, 2, 3, 5}) {
        ThreadPool pool(threads);
        CHECK(pool.threads() == threads);
        for (const int parts : {0, 1, 2, 7, 100}) {
            std::vector<std::atomic<int>> times(parts);
            std::vector<int> first_owner(parts, -1), owner(parts, -1);
            pool.run(parts, [&](int part, int thread) { first_owner[part] = thread; });
            for (int repeat = 0; repeat < 50; ++repeat) {
                pool.run(parts, [&](int part, int thread) {
                    ++times[part];
                    owner[part] = thread;
                });
                CHECK(owner == first_owner);
            }
            for (const std::atomic<int>& count : times) CHECK(count == 50);
        }
    }
}

TEST_CASE("the threads of a pool work at the same time, and what they wrote is there after the run") {
    ThreadPool pool(3);
    std::atomic<int> arrived = 0;
    // Each part waits for the others: a pool that did them one after the other would never return.
    pool.run(3, [&](int, int) {
        ++arrived;
        while (arrived < 3) std::this_thread::yield();
    });
    CHECK(arrived == 3);
    std::vector<int> written(10000, 0);
    for (int round = 1; round <= 200; ++round) {
        pool.run(10, [&](int part, int) { std::fill_n(written.begin() + 1000 * part, 1000, round); });
        CHECK(std::count(written.begin(), written.end(), round) == 10000);
    }
}

TEST_CASE("CPU time of the other threads is counted") {
    ThreadPool pool(2);
    CHECK(pool.other_cpu_seconds() == 0.0);
    std::atomic<double> sink = 0.0;
    pool.run(2, [&](int, int) {
        double sum = 0.0;
        for (int k = 0; k < 20'000'000; ++k) sum += 1.0 / (1.0 + k);
        sink = sum;
    });
    CHECK(sink > 0.0);
    CHECK(pool.other_cpu_seconds() > 1e-3);
}

TEST_CASE("sums over chunks have the same bits for any number of threads") {
    const int slices = 3000;
    const auto sum = [&](ThreadPool* pool) {
        const Compute compute{.pool = pool};
        return sum_chunks(compute, slices, [](Slices range) {
            double part = 0.0;
            for (int s = range.first; s < range.last; ++s) part += 1.0 / (3.0 + s);
            return part;
        });
    };
    const double alone = sum(nullptr);
    for (const int threads : {1, 2, 4, 7}) {
        ThreadPool pool(threads);
        CHECK(sum(&pool) == alone);
    }
}

TEST_CASE("a simulation has the same bits for any number of threads") {
    const std::vector<std::uint64_t> alone = hanging_sheet(1, 12);
    CHECK(alone.front() != alone.back());
    for (const int threads : {2, 4}) CHECK(hanging_sheet(threads, 12) == alone);
}

}  // namespace percale::test
