#include "impacts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace percale {
namespace {

/// h per second, besides what gravity causes in a stage: what comes more slowly is in no impact. Larger: bounces end early. 0:
/// they never do, and persistent contacts count as impacts.
constexpr double min_impact_rate = 2.0;

/// Fraction of an impact's speed that each step leaves after the point was stopped; until it is slow, contact cannot make the
/// point leave. Larger: persistent contacts count as impacts. Smaller: contact that is still compressed throws it off.
constexpr double impact_fading = 0.9;

/// The nearest constraint first. A constraint changes the motion of the next ones, and the order in which they were found
/// depends on the axes.
void set_order_of_distance(const ContactConstraints& constraints, std::vector<std::size_t>& order) {
    order.resize(constraints.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(constraints.distance[a], constraints.vertex[a], constraints.feature[a]) <
               std::tie(constraints.distance[b], constraints.vertex[b], constraints.feature[b]);
    });
}

bool comes_before(const Impact& a, const Impact& b) { return std::pair(a.vertex, a.obstacle) < std::pair(b.vertex, b.obstacle); }

bool matters_more(const Impact& a, const Impact& b) { return a.stopped != b.stopped ? !a.stopped : a.speed > b.speed; }

/// The weighted motion of a constraint's vertices along its direction.
struct ConstraintMotion {
    double began = 0.0, ends = 0.0;  // m/s, against the obstacle, > 0: away from it
    double moved = 0.0;              // m
    double extrapolated = 0.0;       // m/s, beyond that at the beginning
    double obstacle = 0.0;           // m/s, of the obstacle
    double mobility = 0.0;           // 1/kg, of the free vertices
};

class Settling {
public:
    Settling(const StepScene& scene, const StageMove& move, ClothState& end, ImpactSpace& space,
             std::vector<ObstacleImpulse>& impulses)
        : scene_(scene),
          move_(move),
          constraints_(move.contacts.constraints),
          end_(end),
          space_(space),
          impulses_(impulses),
          fading_(std::pow(impact_fading, move.length / scene.settings.time_step)) {}

    ImpactEnergy run() {
        set_order_of_distance(constraints_, space_.order);
        space_.found.clear();
        space_.jumps.clear();
        for (const std::size_t constraint : space_.order) settle(constraint);
        keep_what_matters();
        return flows_;
    }

private:
    ConstraintMotion motion_of(std::size_t constraint) const {
        const Vec3& n = constraints_.direction[constraint];
        ConstraintMotion motion{.obstacle = n.dot(constraints_.obstacle_displacement[constraint]) / scene_.settings.time_step};
        motion.began = motion.ends = -motion.obstacle;
        motion.moved = -move_.length * motion.obstacle;
        for (int k = 0; k < 4 && constraints_.vertex[constraint][k] >= 0; ++k) {
            const int vertex = constraints_.vertex[constraint][k];
            const double weight = constraints_.weight[constraint][k];
            motion.began += weight * n.dot(move_.start.velocities.at(vertex));
            motion.ends += weight * n.dot(end_.velocities.at(vertex));
            motion.moved += weight * n.dot(end_.positions.at(vertex) - move_.start.positions.at(vertex));
            if (move_.extrapolated) {
                motion.extrapolated += weight * n.dot(move_.extrapolated->at(vertex) - move_.start.velocities.at(vertex));
            }
            motion.mobility += scene_.script.free[vertex] * weight * weight / scene_.model.mass[vertex];
        }
        return motion;
    }

    double restitution(std::size_t constraint) const {
        return constraints_.obstacle[constraint] < 0 ? 0.0
                                                     : scene_.script.obstacles[constraints_.obstacle[constraint]].restitution;
    }

    /// A point that comes at a speed v from a distance d outside the activation distance enters it at the root of v^2 + 2 g d.
    double speed_at_contact(std::size_t constraint, const ConstraintMotion& motion) const {
        const double apart = std::max(0.0, constraints_.distance[constraint] - motion.moved - constraints_.thickness[constraint]);
        const double gravity = std::max(0.0, -constraints_.direction[constraint].dot(scene_.settings.gravity));
        return std::sqrt(motion.began * motion.began + 2.0 * gravity * apart);
    }

    /// The impact of a constraint's vertices from earlier steps: the fastest, and one that still approaches before one that was
    /// stopped.
    Impact remembered(std::size_t constraint) const {
        Impact best{.stopped = true};
        for (int k = 0; k < 4 && constraints_.vertex[constraint][k] >= 0; ++k) {
            const Impact wanted{constraints_.vertex[constraint][k], constraints_.obstacle[constraint]};
            const auto& known = move_.start.impacts;
            const auto found = std::lower_bound(known.begin(), known.end(), wanted, comes_before);
            if (found != known.end() && !comes_before(wanted, *found) && matters_more(*found, best)) best = *found;
        }
        return best;
    }

    void remember(std::size_t constraint, double speed, bool stopped) {
        for (int k = 0; k < 4 && constraints_.vertex[constraint][k] >= 0; ++k) {
            space_.found.push_back({constraints_.vertex[constraint][k], constraints_.obstacle[constraint], speed, stopped});
        }
    }

    void note_jump(std::size_t constraint) {
        for (int k = 0; k < 4 && constraints_.vertex[constraint][k] >= 0; ++k) {
            space_.jumps.push_back(
                {constraints_.vertex[constraint][k], constraints_.obstacle[constraint], constraints_.direction[constraint]});
        }
    }

    /// By how much a constraint's vertices leave faster than they should, m/s; below 0: slower.
    double excess(std::size_t constraint, const ConstraintMotion& motion, double given) {
        const double slow =
            min_impact_rate * constraints_.thickness[constraint] + scene_.settings.gravity.norm() * move_.impulse_time;
        Impact impact = remembered(constraint);
        const double now = -motion.began > slow ? speed_at_contact(constraint, motion) : 0.0;
        if (now > 0.0) impact = {.speed = std::max(now, impact.stopped ? 0.0 : impact.speed)};
        const double max = move_.keeps_to_mean ? std::max(0.0, motion.ends - std::max(0.0, motion.moved / move_.length)) : 0.0;
        if (impact.speed <= slow) return max;
        if (motion.ends < -slow) {
            remember(constraint, impact.speed, false);
            return 0.0;
        }
        remember(constraint, fading_ * impact.speed, true);
        if (!impact.stopped) note_jump(constraint);
        const double share = restitution(constraint);
        const double of_contact = std::max(0.0, std::min(motion.ends, given));
        if (share == 0.0) return std::max(max, of_contact);
        if (impact.stopped) return of_contact;
        return motion.ends - share * impact.speed;
    }

    void settle(std::size_t constraint) {
        if (constraints_.mollifier[constraint] < 0.0) return;  // what is subtracted stops nothing
        const double force = move_.contacts.constraint_forces[constraint].normal;
        // Beside constraints that push, the vertices that they have stopped are thrown back, too.
        if (force <= 0.0 && restitution(constraint) == 0.0) return;
        const ConstraintMotion motion = motion_of(constraint);
        if (motion.mobility == 0.0) return;
        const double given = force * move_.impulse_time * motion.mobility + std::max(0.0, motion.extrapolated);
        const double change = -excess(constraint, motion, given);
        if (change == 0.0) return;
        const Vec3& n = constraints_.direction[constraint];
        for (int k = 0; k < 4 && constraints_.vertex[constraint][k] >= 0; ++k) {
            const int vertex = constraints_.vertex[constraint][k];
            const double part =
                scene_.script.free[vertex] * constraints_.weight[constraint][k] / (scene_.model.mass[vertex] * motion.mobility);
            end_.velocities.add(vertex, part * change * n);
            if (constraints_.obstacle[constraint] < 0 || impulses_.empty()) continue;
            const Vec3 gain = move_.weight * scene_.model.mass[vertex] * part * change * n;
            impulses_[constraints_.obstacle[constraint]].take(end_.positions.at(vertex), gain);
        }
        // The impulse p = change/mobility changes the kinetic energy by p times the mean speed, of which the obstacle supplies
        // the part of its own speed.
        const double impulse = change / motion.mobility;
        flows_.work += impulse * motion.obstacle;
        flows_.loss -= impulse * (motion.ends + 0.5 * change);
    }

    /// Keeps one of several constraints of a vertex with one obstacle.
    void keep_what_matters() {
        std::vector<Impact>& found = space_.found;
        std::sort(found.begin(), found.end(), [](const Impact& a, const Impact& b) {
            return comes_before(a, b) || (!comes_before(b, a) && matters_more(a, b));
        });
        const auto same = [](const Impact& a, const Impact& b) { return a.vertex == b.vertex && a.obstacle == b.obstacle; };
        found.erase(std::unique(found.begin(), found.end(), same), found.end());
        end_.impacts.assign(found.begin(), found.end());
    }

    const StepScene& scene_;
    const StageMove& move_;
    const ContactConstraints& constraints_;
    ClothState& end_;
    ImpactSpace& space_;
    std::vector<ObstacleImpulse>& impulses_;
    double fading_;  // in this stage
    ImpactEnergy flows_;
};

}  // namespace

ImpactEnergy settle_impacts(const StepScene& scene, const StageMove& move, ClothState& end, ImpactSpace& space,
                            std::vector<ObstacleImpulse>& impulses) {
    return Settling(scene, move, end, space, impulses).run();
}

}  // namespace percale
