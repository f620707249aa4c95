#include "drape/drape_run.h"

#include <algorithm>
#include <limits>

#include "common/text.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale::scenes {
namespace {

/// s, after sewing: a seam that is open by more than that then does not close. Longer: garments that cannot be sewn take longer.
constexpr double late_closing = 1.0;

std::vector<double> heights(const BuiltScene& built) {
    std::vector<double> all;
    for (const ClothId cloth : built.cloths) all.push_back(mean_height(built.simulation, cloth));
    return all;
}

/// Whether all cloth is below all of the body, where nothing holds it any more.
bool has_fallen(const BuiltScene& built, double lowest) {
    return std::ranges::all_of(built.cloths, [&](const ClothId cloth) {
        return std::ranges::all_of(built.simulation.positions(cloth), [&](const Vec3& x) { return x.y() < lowest; });
    });
}

double lowest_of(const BuiltScene& built) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const Vec3& x : built.obstacle_meshes[0].vertices)
        lowest = std::min(lowest, transform(built.scene.obstacles[0].pose, x).y());
    return lowest;
}

/// What failed in sewing, which another sewing time may mend; empty where nothing did.
std::string sewing_fault(const BuiltScene& built) {
    const WidestGap gap = widest_gap(built);
    return gap.width > widest_sewn_gap ? unsewn_text(gap) : "";
}

}  // namespace

double mean_height(const Simulation& simulation, ClothId cloth) {
    double sum = 0.0;
    const std::span<const Vec3> positions = simulation.positions(cloth);
    for (const Vec3& x : positions) sum += x.y();
    return sum / static_cast<double>(positions.size());
}

Drape settle(BuiltScene& built, const DrapeOptions& options, const std::function<bool(double)>& stop, bool again) {
    Drape drape;
    RestWatch watch;
    const double all_sewn = sewing_end(built.scene), lowest = lowest_of(built) - options.fabric.thickness;
    bool sewn = built.scene.seams.empty(), closed = sewn || !again;
    drape.height = heights(built);
    while (built.simulation.time() < options.seconds - 1e-9) {
        if (!sewn && built.simulation.time() >= all_sewn - 1e-9) {
            built.scene.step.gravity = StepSettings{}.gravity;
            built.simulation.set_gravity(built.scene.step.gravity);
            drape.height = heights(built);
            sewn = true;
        }
        watch.begin(built.simulation, built.cloths);
        try {
            drape.last = built.simulation.step();
        } catch (const StartError& error) {
            if (stop(built.simulation.time())) {
                drape.end = DrapeEnd::stopped;
                return drape;
            }
            drape.end = again ? DrapeEnd::unsewn : DrapeEnd::failed;
            drape.failure = std::string(error.what()) + " (--no-self-contact: as if it did not)";
            return drape;
        }
        if (!closed && built.simulation.time() >= all_sewn + late_closing) {
            closed = true;
            drape.failure = sewing_fault(built);
            if (!drape.failure.empty()) drape.end = DrapeEnd::unsewn;
        }
        if (drape.last.status == StepStatus::cancelled) {
            drape.end = DrapeEnd::stopped;
            return drape;
        }
        if (!drape.last.ok()) {
            drape.end = DrapeEnd::failed;
            drape.failure = drape.last.explanation();
            return drape;
        }
        watch.look(built.simulation, built.cloths, drape.last, built.scene.step.gravity, sewn);
        drape.rest = watch.figures();
        drape.unsolved_steps += drape.last.unsolved();
        drape.met = drape.met || drape.last.contacts > 0;
        const bool stopped = stop(built.simulation.time());
        if (drape.end == DrapeEnd::unsewn) return drape;
        if (drape.rest.at_rest)
            drape.end = DrapeEnd::settled;
        else if (stopped)
            drape.end = DrapeEnd::stopped;
        else if (has_fallen(built, lowest))
            drape.end = DrapeEnd::fell;
        if (drape.end != DrapeEnd::time_up) return drape;
    }
    return drape;
}

}  // namespace percale::scenes
