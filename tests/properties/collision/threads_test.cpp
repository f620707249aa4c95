#include <cmath>

#include "percale/percale.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"

namespace percale::test::threads_test {
namespace {

/// States and contacts of a sheet that falls on a ball, step by step.
std::vector<std::uint64_t> fall(StepSettings settings, bool self_contact, int threads) {
    settings.threads = threads;
    Simulation simulation(settings, backends().back().make_detector());
    const Fabric fabric{.self_contact = self_contact, .springs = {.structural = 1000.0, .shear = 500.0, .bend = 10.0}};
    simulation.add_cloth(make_grid(1.0, 1.0, 49, 49), fabric, {.translation = {0.01, 0.27, 0.02}});
    simulation.add_obstacle(make_sphere(0.25, 4));
    std::vector<std::uint64_t> hashes;
    int contacts = 0;
    for (int k = 0; k < 12; ++k) {
        const StepReport report = simulation.step();
        REQUIRE(report.ok());
        contacts += report.contacts;
        hashes.push_back(simulation.state_hash());
        hashes.push_back(report.contact_hash);
    }
    CHECK(contacts > 100);
    return hashes;
}

}  // namespace

TEST_CASE("Cloth in contact has the same bits for any number of threads", "[slow]") {
    const StepSettings penalty{.measure = StepMeasures::ledger};
    const StepSettings projection{.contact_response = ContactResponse::projection};
    for (const auto& settings : {penalty, projection}) {
        const std::vector<std::uint64_t> alone = fall(settings, false, 1);
        for (const int threads : {2, 3, 7}) CHECK(fall(settings, false, threads) == alone);
    }
    CHECK(fall(penalty, true, 4) == fall(penalty, true, 1));
}

}  // namespace percale::test::threads_test
