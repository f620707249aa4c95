#include <vector>

#include "engine/state/state_seal.h"
#include "fuzz_entry.h"
#include "percale/detectors.h"
#include "percale/percale.h"
#include "percale/saved_state.h"

// A saved state, as it lies in a checkpoint file: bytes as they are, and the same behind a seal that is right.
namespace percale::fuzz {
namespace {

using Bytes = std::vector<std::byte>;

/// A small sheet that lies on a box and meets itself. Few iterations, since a state may be one that no step gets out of.
Simulation make_simulation() {
    Simulation simulation({.newton_iterations = 8}, make_brute_force_detector());
    Fabric fabric{.thickness = 5e-3, .self_contact = true, .springs = {.structural = 100.0, .shear = 50.0, .bend = 1.0}};
    const ClothId cloth = simulation.add_cloth(make_grid(0.2, 0.2, 3, 3), fabric, {.translation = Vec3(0.0, 0.056, 0.0)});
    simulation.add_obstacle(make_box(Vec3(0.1, 0.1, 0.1)));
    simulation.pin(cloth, 0);
    return simulation;
}

/// Restores and takes a step. A refusal leaves the simulation as it was.
void try_state(const Bytes& bytes) {
    Simulation simulation = make_simulation();
    const std::uint64_t before = simulation.state_hash();
    try {
        simulation.restore(bytes);
    } catch (const SceneError&) {
        require(simulation.state_hash() == before, "a refused state changes nothing");
        return;
    }
    const StepReport report = simulation.step();
    require(!report.explanation().empty(), "a step says what happened");
    if (!report.ok()) return;
    for (const Vec3& x : simulation.positions({0})) require(x.allFinite(), "positions are finite after a good step");
}

}  // namespace
}  // namespace percale::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace percale;
    const std::byte* first = reinterpret_cast<const std::byte*>(data);
    const fuzz::Bytes bytes(first, first + size);
    fuzz::try_state(bytes);
    fuzz::try_state(sealed(state_seal, bytes));
    return 0;
}
