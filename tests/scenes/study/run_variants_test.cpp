#include "scenes/study/run_variants.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/support/catch.h"

namespace percale::scenes::test::run_variants_test {

TEST_CASE("Every variant is run once, its end reported once and never two at a time, whatever the number of jobs") {
    for (const int jobs : {1, 3, 64}) {
        std::vector<int> runs(20, 0), ends(20, 0);
        std::atomic<int> reporting = 0;
        const VariantWork work{.jobs = jobs, .ended = [&](std::size_t k) {
                                   CHECK(++reporting == 1);
                                   CHECK(runs[k] == 1);
                                   ++ends[k];
                                   --reporting;
                               }};
        CHECK(run_variants(runs.size(), work, [&](std::size_t k) { ++runs[k]; }));
        CHECK(runs == std::vector<int>(20, 1));
        CHECK(ends == runs);
    }
    CHECK(run_variants(0, {.jobs = 4}, [](std::size_t) { FAIL("there is none"); }));
}

TEST_CASE("One job runs variants in their order") {
    std::vector<std::size_t> order;
    run_variants(5, {}, [&](std::size_t k) { order.push_back(k); });
    CHECK(order == std::vector<std::size_t>{0, 1, 2, 3, 4});
}

TEST_CASE("After a stop no other variant is begun, and a stop behind the last one changes nothing") {
    std::size_t begun = 0;
    CHECK_FALSE(run_variants(5, {.stop_asked = [&] { return begun == 2; }}, [&](std::size_t) { ++begun; }));
    CHECK(begun == 2);
    begun = 0;
    CHECK(run_variants(2, {.stop_asked = [&] { return begun == 2; }}, [&](std::size_t) { ++begun; }));
    CHECK(begun == 2);
}

TEST_CASE("What a variant throws ends the study with that, and those that run end first") {
    for (const int jobs : {1, 4}) {
        std::atomic<int> begun = 0, ended = 0;
        const auto run = [&](std::size_t k) {
            ++begun;
            if (k == 3) throw std::runtime_error("three");
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            ++ended;
        };
        CHECK_THROWS_WITH(run_variants(1000, {.jobs = jobs}, run), "three");
        CHECK(begun == ended + 1);
        CHECK(begun < 1000);
    }
}

}  // namespace percale::scenes::test::run_variants_test
