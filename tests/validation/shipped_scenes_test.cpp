#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "scenes/doctor/doctor.h"
#include "scenes/format/expectations.h"
#include "scenes/format/scene_file.h"
#include "scenes/run/run_scene.h"
#include "scenes/run/step_lengths.h"
#include "tests/scenes/watched_run.h"
#include "tests/support/catch.h"

namespace percale::scenes::shipped_scenes_test {
namespace {

struct StepHashes {
    std::uint64_t contact, state;
    bool operator==(const StepHashes& other) const = default;
};

struct HashedRun {
    RunResult result;
    std::size_t steps = 0;  // that the scene's duration takes, undivided
    std::vector<StepHashes> hashes;
};

HashedRun run_hashed(const std::filesystem::path& file, std::vector<Override> overrides, const std::string& detector) {
    HashedRun run;
    overrides.push_back({"step.detector", detector});
    RunHooks hooks;
    hooks.step = [&](const StepReport& report, const Simulation& simulation) {
        run.hashes.push_back({report.contact_hash, simulation.state_hash()});
    };
    BuiltScene built = build_scene(load_scene(file.string(), overrides));
    run.steps = static_cast<std::size_t>(count_steps(built.scene.duration, built.scene.step.time_step).steps);
    run.result = run_scene(built, hooks);
    return run;
}

std::vector<std::filesystem::path> shipped_scenes() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(PERCALE_DATA_DIR) / "scenes")) {
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// Contacts and states are the same in every step whatever finds the contacts.
void check_trees(const std::filesystem::path& file, const std::vector<Override>& overrides) {
    const HashedRun with_fcl = run_hashed(file, overrides, "fcl");
    REQUIRE(with_fcl.result.status == RunStatus::finished);
    REQUIRE(with_fcl.steps > 0);
    REQUIRE(with_fcl.hashes.size() >= with_fcl.steps);
    for (const char* detector : {"brute_force", "bullet"}) {
        CAPTURE(detector);
        const HashedRun other = run_hashed(file, overrides, detector);
        CHECK(other.hashes.size() == with_fcl.hashes.size());
        const auto [differs, there] =
            std::mismatch(with_fcl.hashes.begin(), with_fcl.hashes.end(), other.hashes.begin(), other.hashes.end());
        CAPTURE(differs - with_fcl.hashes.begin());
        CHECK(differs == with_fcl.hashes.end());
    }
}

TEST_CASE("Shipped scenes are the same with every tree", "[.night]") {
    const auto file = GENERATE(from_range(shipped_scenes()));
    CAPTURE(file.string());
    check_trees(file, {});
}

TEST_CASE("The first 0.3 s of shipped scenes are the same with every tree") {
    const auto file = GENERATE(from_range(shipped_scenes()));
    CAPTURE(file.string());
    CHECK(diagnose(file.string()).count(Severity::error) == 0);
    check_trees(file, {{"duration", "0.3"}});
}

TEST_CASE("The first 0.3 s of shipped scenes are the same on two threads and where they are resumed") {
    const auto file = GENERATE(from_range(shipped_scenes()));
    CAPTURE(file.string());
    const auto beginning = [&](const std::string& threads) {
        const std::vector<Override> overrides{{"duration", "0.3"}, {"step.threads", threads}};
        return load_scene(file.string(), overrides);
    };
    using test::resumes_as, test::watch;
    const test::WatchedRun plain = watch(beginning("1"), {}), left = watch(beginning("2"), {.checkpoint_every = 0.08});
    CHECK(left.hashes == plain.hashes);
    REQUIRE(left.states.size() == 3);
    for (std::size_t k = 0; k < left.states.size(); ++k)
        CHECK(resumes_as(plain, left, k, watch(beginning("1"), {.from = &left.states[k]})));
}

}  // namespace
}  // namespace percale::scenes::shipped_scenes_test
