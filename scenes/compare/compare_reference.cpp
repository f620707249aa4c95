#include "compare/compare_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "percale/error.h"
#include "tolerances.h"

namespace percale::scenes {

namespace {

/// Stretch of an edge beyond which a finite end is none.
constexpr double torn_stretch = 10.0;

/// How often a search for a surviving step halves it. Fewer: schemes that survive short steps alone count as surviving none.
/// More: the search takes twice as long for each where a scheme survives none.
constexpr int max_step_halvings = 14;

/// Changes that fall by less than this factor, as often in turn as a candidate has patience, have stopped falling.
constexpr double min_halving_progress = 1.25;

/// How much smaller a change may be than the one before it for Richardson's estimate. Below the minimum the change itself is
/// taken; above the maximum the estimate would be trusted too much.
constexpr double min_richardson_ratio = 2.0, max_richardson_ratio = 16.0;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Candidate {
    const char* scheme;
    bool contact;         // whether the scheme takes contact
    double vertex_steps;  // maximum of a run: about 10 s of one core
    int patience;         // contact, whose depth depends on the step, takes a few halvings to begin to converge
};
constexpr std::array<Candidate, 3> candidates = {
    {{"rk4", false, 3e8, 3}, {"tr_bdf2", true, 2e6, 4}, {"backward_euler", true, 4e6, 4}}};

/// The runs of one scheme with smaller and smaller steps.
class Refinement {
public:
    Refinement(const SceneSource& source, const Candidate& candidate, const std::function<bool()>& stop_asked)
        : source_(source), stop_asked_(stop_asked), candidate_(candidate) {}

    /// False if not even two runs can be made.
    bool refine(double wanted);
    Reference reference() const;

private:
    Variant variant(double step) const { return {.scheme = candidate_.scheme, .time_step = step}; }
    bool affordable(double step) const;
    bool halve();
    /// How far a disturbed run of the coarser step ends from the undisturbed one.
    Distances disturbed() const;

    const SceneSource& source_;
    const std::function<bool()>& stop_asked_;
    Candidate candidate_;
    Survivor coarse_, fine_;
    Distances uncertainty_;
    double change_ = infinity;  // m rms, of the last halving
    int stalled_ = 0;           // halvings in turn after which the change had hardly fallen
};

bool Refinement::affordable(double step) const {
    const double steps = fine_.run.totals.simulated_s / step;
    return steps * static_cast<double>(fine_.run.state.positions.size()) <= candidate_.vertex_steps;
}

bool Refinement::halve() {
    const double step = 0.5 * fine_.step;
    VariantRun run = run_variant(source_, variant(step), stop_asked_);
    if (run.end != VariantEnd::finished) return false;
    coarse_ = std::exchange(fine_, {step, std::move(run)});
    const Distances change = distances_between(coarse_.run.state, fine_.run.state);
    uncertainty_ = richardson(change, change_);
    stalled_ = change.rms * min_halving_progress > change_ ? stalled_ + 1 : 0;
    change_ = change.rms;
    return true;
}

bool Refinement::refine(double wanted) {
    std::optional<Survivor> first = largest_surviving_step(source_, candidate_.scheme, stop_asked_);
    if (!first) return false;
    fine_ = std::move(*first);
    if (!affordable(0.25 * fine_.step) || !halve()) return false;
    while (uncertainty_.rms > wanted && stalled_ < candidate_.patience && affordable(0.5 * fine_.step))
        if (!halve()) break;
    return true;
}

Distances Refinement::disturbed() const {
    const VariantRun twin = run_variant(source_, variant(coarse_.step), stop_asked_, disturbance_at_start);
    return twin.end == VariantEnd::finished ? distances_between(twin.state, coarse_.run.state)
                                            : scaled({1.0, 1.0, 1.0, 1.0, 1.0, 1.0}, infinity);
}

Reference Refinement::reference() const {
    const Distances apart = disturbed();
    Reference reference{.variant = variant(fine_.step),
                        .state = fine_.run.state,
                        .uncertainty = uncertainty_,
                        .growth = apart.rms / disturbance_at_start};
    reference.chaotic = reference.growth > chaos_growth;
    if (reference.chaotic) reference.uncertainty = larger(uncertainty_, apart);
    return reference;
}

}  // namespace

std::optional<Survivor> largest_surviving_step(const SceneSource& source, const std::string& scheme,
                                               const std::function<bool()>& stop_asked) {
    double step = largest_compared_step;
    for (int k = 0; k <= max_step_halvings; ++k, step *= 0.5) {
        VariantRun run = run_variant(source, {.scheme = scheme, .time_step = step}, stop_asked);
        if (run.end == VariantEnd::refused) throw SceneError(run.reason);
        if (run.end == VariantEnd::finished && run.state.stretch < torn_stretch) return Survivor{step, std::move(run)};
    }
    return std::nullopt;
}

Distances richardson(const Distances& change, double before) {
    const double ratio = std::min(before / change.rms, max_richardson_ratio);
    return std::isfinite(before) && ratio >= min_richardson_ratio ? scaled(change, 1.0 / (ratio - 1.0)) : change;
}

Reference make_reference(const SceneSource& source, double wanted, const std::function<bool()>& stop_asked) {
    const bool contact = source({}).has_contact();
    std::string refused;  // why a scheme refused the scene, as tr_bdf2 refuses projection
    for (const Candidate& candidate : candidates) {
        if (contact && !candidate.contact) continue;
        Refinement refinement(source, candidate, stop_asked);
        try {
            if (refinement.refine(wanted)) return refinement.reference();
        } catch (const SceneError& error) {
            refused = error.what();
        }
    }
    throw SceneError("no reference: no scheme brings this scene to its end at two time steps" +
                     (refused.empty() ? "" : " (" + refused + ")"));
}

}  // namespace percale::scenes
