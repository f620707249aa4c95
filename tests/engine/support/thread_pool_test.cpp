#include "engine/support/thread_pool.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "engine/kernels/compute.h"
#include "percale/simulation.h"
#include "tests/support/catch.h"
#include "tests/support/cloth_scenes.h"

namespace percale::test::thread_pool_test {
namespace {

const Fabric sheet{.area_density = 0.2, .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0}, .spring_damping = 0.1};

/// The states of a hanging sheet that is large enough to be divided.
std::vector<std::uint64_t> hanging_sheet(int threads, int steps, std::shared_ptr<Workers> workers = nullptr) {
    StepSettings settings;
    settings.threads = threads;
    Simulation simulation(settings, nullptr, std::move(workers));
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

TEST_CASE("every part is done once, by slots that no two threads have at a time") {
    for (const int threads : {1, 2, 3, 5}) {
        ThreadPool pool(threads);
        CHECK(pool.threads() == threads);
        for (const int parts : {0, 1, 2, 7, 100}) {
            std::vector<std::atomic<int>> times(parts), in_slot(threads);
            std::atomic<int> clashes = 0;
            auto work = [&](int part, int slot) {
                clashes += in_slot[slot]++;
                ++times[part];
                --in_slot[slot];
            };
            for (int repeat = 0; repeat < 50; ++repeat) run_parts(&pool, parts, work);
            for (const std::atomic<int>& count : times) CHECK(count == 50);
            CHECK(clashes == 0);
        }
    }
}

TEST_CASE("at most as many threads work as there are parts") {
    ThreadPool pool(5);
    std::atomic<int> highest = 0, done = 0;
    auto note = [&](int, int slot) {
        ++done;
        for (int seen = highest; slot > seen && !highest.compare_exchange_weak(seen, slot);) continue;
    };
    for (int repeat = 0; repeat < 2000; ++repeat) run_parts(&pool, 2, note);
    CHECK(done == 4000);
    CHECK(highest <= 1);
    run_parts(&pool, 5, note);
    CHECK(done == 4005);
}

TEST_CASE("the threads of a pool work at the same time, and their results are there after the run") {
    ThreadPool pool(3);
    std::atomic<int> arrived = 0;
    // Each part waits for the others: a pool that did them one after the other would never return.
    auto meet = [&](int, int) {
        ++arrived;
        while (arrived < 3) std::this_thread::yield();
    };
    run_parts(&pool, 3, meet);
    CHECK(arrived == 3);
    std::vector<int> written(10000, 0);
    for (int round = 1; round <= 200; ++round) {
        auto write = [&](int part, int) { std::fill_n(written.begin() + 1000 * part, 1000, round); };
        run_parts(&pool, 10, write);
        CHECK(std::count(written.begin(), written.end(), round) == 10000);
    }
}

TEST_CASE("a pool that is busy for another caller leaves all parts to this one") {
    ThreadPool pool(2);
    std::atomic<bool> inside = false, finish = false;
    auto hold = [&](int, int) {
        inside = true;
        while (!finish) std::this_thread::yield();
    };
    std::thread other([&] { run_parts(&pool, 2, hold); });
    while (!inside) std::this_thread::yield();
    std::vector<std::thread::id> by(8);
    auto note = [&](int part, int slot) {
        by[part] = std::this_thread::get_id();
        CHECK(slot == 0);
    };
    run_parts(&pool, 8, note);
    CHECK(std::count(by.begin(), by.end(), std::this_thread::get_id()) == 8);
    finish = true;
    other.join();
}

TEST_CASE("threads that wait take no CPU time") {
    ThreadPool pool(2);
    auto nothing = [](int, int) {};
    run_parts(&pool, 2, nothing);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    run_parts(&pool, 2, nothing);
    const double before = pool.other_cpu_seconds();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    for (int k = 0; k < 5; ++k) {
        run_parts(&pool, 2, nothing);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    CHECK(pool.other_cpu_seconds() - before < 0.02);
}

TEST_CASE("CPU time of the other threads is counted") {
    ThreadPool pool(2);
    std::atomic<int> arrived = 0;
    std::vector<double> sums(2, 0.0);  // Catch's assertions are for one thread only
    auto work = [&](int part, int) {
        ++arrived;
        while (arrived < 2) std::this_thread::yield();
        double sum = 0.0;
        for (int k = 0; k < 20'000'000; ++k) sum += 1.0 / (1.0 + k);
        sums[part] = sum;
    };
    run_parts(&pool, 2, work);
    CHECK(sums[0] == sums[1]);
    CHECK(pool.other_cpu_seconds() > 1e-3);
}

TEST_CASE("an invalid number of threads is refused") {
    CHECK(make_workers(3)->threads() == 3);
    CHECK(make_workers(0)->threads() >= 1);
    for (const int threads : {-1, 65}) {
        CHECK(mentions(scene_error([&] { make_workers(threads); }), {std::to_string(threads), "0 ... 64"}));
    }
}

TEST_CASE("sums over chunks have the same bits for any number of threads") {
    const int slices = 3000;
    const auto sum = [&](Workers* workers) {
        const Compute on{.workers = workers};
        return sum_chunks(on, slices, [](Slices range) {
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

namespace {

/// A host's own job system, the simplest there is.
class HostJobs : public Workers {
public:
    int threads() const override { return 3; }
    void run(int parts, void (*work)(void* data, int part, int slot), void* data) override {
        ++runs;
        for (int part = parts - 1; part >= 0; --part) work(data, part, part % 3);
    }
    int runs = 0;
};

}  // namespace

TEST_CASE("a simulation has the same bits on a host's job system, and on a pool that two of them share") {
    const std::vector<std::uint64_t> alone = hanging_sheet(1, 5);
    const auto host = std::make_shared<HostJobs>();
    CHECK(hanging_sheet(1, 5, host) == alone);
    CHECK(host->runs > 100);
    const std::shared_ptr<Workers> pool = make_workers(2);
    std::vector<std::uint64_t> first, second;
    std::thread other([&] { first = hanging_sheet(1, 5, pool); });
    second = hanging_sheet(1, 5, pool);
    other.join();
    CHECK(first == alone);
    CHECK(second == alone);
}

TEST_CASE("a simulation has the same bits for any number of threads") {
    const std::vector<std::uint64_t> alone = hanging_sheet(1, 12);
    CHECK(alone.front() != alone.back());
    for (const int threads : {0, 2, 4}) CHECK(hanging_sheet(threads, 12) == alone);
}

}  // namespace percale::test::thread_pool_test
