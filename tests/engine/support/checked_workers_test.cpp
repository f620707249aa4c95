#include "support/checked_workers.h"

#include <functional>
#include <stdexcept>
#include <vector>

#include "percale/simulation.h"

#include "tests/support/catch.h"

namespace percale::test::checked_workers_test {
namespace {

/// A host that violates the contract as the test sets it.
class FaultyHost : public Workers {
public:
    int threads() const override { return said; }
    void run(int parts, void (*work)(void* data, int part, int slot), void* data) override {
        if (fault == "throws") throw std::runtime_error("out of fibres");
        for (int part = fault == "leaves out" ? 1 : 0; part < parts; ++part) work(data, part, fault == "slot" ? said : 0);
        if (fault == "twice") work(data, 0, 0);
        if (fault == "beyond") work(data, parts, 0);
        late = [=] { work(data, 0, 0); };
    }
    std::function<void()> late;
    int said = 2;
    std::string fault;
};

}  // namespace

TEST_CASE("a host without threads is refused") {
    for (const int threads : {0, -1, 65, 1000000000}) {
        const auto host = std::make_shared<FaultyHost>();
        host->said = threads;
        CHECK_THROWS_WITH(CheckedWorkers(host),
                          Catch::Contains("threads() = " + std::to_string(threads)) && Catch::Contains("1 ... 64"));
        CHECK_THROWS_AS(Simulation(StepSettings{}, nullptr, host), SceneError);
    }
}

TEST_CASE("a host that does each part once is accepted; another one is reported at once, and from then on") {
    for (const std::string fault : {"leaves out", "twice", "slot", "beyond", "throws"}) {
        CAPTURE(fault);
        const auto host = std::make_shared<FaultyHost>();
        CheckedWorkers workers(host);
        std::vector<int> done(7, 0);
        const auto run = [&] {
            workers.run(
                7, [](void* data, int part, int) { ++(*static_cast<std::vector<int>*>(data))[static_cast<std::size_t>(part)]; },
                &done);
        };
        run();
        CHECK(done == std::vector<int>(7, 1));
        host->fault = fault;
        if (fault == "throws")
            CHECK_THROWS_WITH(run(), "out of fibres");
        else
            CHECK_THROWS_AS(run(), WorkersError);
        if (fault == "leaves out") host->late();
        for (const int count : done) CHECK(count <= 2);  // once a run
        if (fault == "leaves out") CHECK(done[0] == 1);
        host->fault = "";
        CHECK_THROWS_AS(run(), WorkersError);
        CHECK_THROWS_AS(workers.check(), WorkersError);
    }
}

}  // namespace percale::test::checked_workers_test
