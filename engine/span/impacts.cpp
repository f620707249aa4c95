#include "impacts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "tolerances.h"

namespace percale {
namespace {

/// The nearest row first. A row changes what the next ones see, and the order in which they were found depends on the axes.
void set_order_of_distance(const ContactRows& rows, std::vector<std::size_t>& order) {
    order.resize(rows.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(rows.distance[a], rows.vertex[a], rows.feature[a]) <
               std::tie(rows.distance[b], rows.vertex[b], rows.feature[b]);
    });
}

bool comes_before(const Impact& a, const Impact& b) { return std::pair(a.vertex, a.obstacle) < std::pair(b.vertex, b.obstacle); }

bool matters_more(const Impact& a, const Impact& b) { return a.stopped != b.stopped ? !a.stopped : a.speed > b.speed; }

/// What a row's vertices do by their weights, along its direction.
struct RowMotion {
    double began = 0.0, ends = 0.0;  // m/s, against the obstacle, > 0: away from it
    double moved = 0.0;              // m
    double extrapolated = 0.0;       // m/s, beyond that at the beginning
    double obstacle = 0.0;           // m/s, of the obstacle
    double mobility = 0.0;           // 1/kg, of the free ones
};

class Settling {
public:
    Settling(const StepScene& scene, const StageMove& move, ClothState& end, ImpactSpace& space,
             std::vector<ObstacleImpulse>& impulses)
        : scene_(scene),
          move_(move),
          rows_(move.contacts.rows),
          end_(end),
          space_(space),
          impulses_(impulses),
          fading_(std::pow(impact_fading, move.length / scene.settings.time_step)) {}

    ImpactFlows run() {
        set_order_of_distance(rows_, space_.order);
        space_.found.clear();
        space_.thrown.clear();
        for (const std::size_t row : space_.order) settle(row);
        keep_what_matters();
        return flows_;
    }

private:
    RowMotion motion_of(std::size_t row) const {
        const Vec3& n = rows_.direction[row];
        RowMotion motion{.obstacle = n.dot(rows_.obstacle_displacement[row]) / scene_.settings.time_step};
        motion.began = motion.ends = -motion.obstacle;
        motion.moved = -move_.length * motion.obstacle;
        for (int k = 0; k < 4 && rows_.vertex[row][k] >= 0; ++k) {
            const int vertex = rows_.vertex[row][k];
            const double weight = rows_.weight[row][k];
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

    double restitution(std::size_t row) const {
        return rows_.obstacle[row] < 0 ? 0.0 : scene_.script.obstacles[rows_.obstacle[row]].restitution;
    }

    /// What comes at a speed v from d outside the zone of contact enters it at the root of v^2 + 2 g d.
    double speed_at_contact(std::size_t row, const RowMotion& motion) const {
        const double apart = std::max(0.0, rows_.distance[row] - motion.moved - rows_.thickness[row]);
        const double gravity = std::max(0.0, -rows_.direction[row].dot(scene_.settings.gravity));
        return std::sqrt(motion.began * motion.began + 2.0 * gravity * apart);
    }

    /// The impact that a row's vertices are in since earlier steps: of one that is still coming before one that was stopped, the
    /// fastest.
    Impact remembered(std::size_t row) const {
        Impact best{.stopped = true};
        for (int k = 0; k < 4 && rows_.vertex[row][k] >= 0; ++k) {
            const Impact wanted{rows_.vertex[row][k], rows_.obstacle[row]};
            const auto& known = move_.start.impacts;
            const auto found = std::lower_bound(known.begin(), known.end(), wanted, comes_before);
            if (found != known.end() && !comes_before(wanted, *found) && matters_more(*found, best)) best = *found;
        }
        return best;
    }

    void remember(std::size_t row, double speed, bool stopped) {
        for (int k = 0; k < 4 && rows_.vertex[row][k] >= 0; ++k) {
            space_.found.push_back({rows_.vertex[row][k], rows_.obstacle[row], speed, stopped});
        }
    }

    /// By how much a row's vertices leave faster than they should, m/s; below 0: slower.
    double excess(std::size_t row, const RowMotion& motion, double given) {
        const double slow = least_impact_rate * rows_.thickness[row] + scene_.settings.gravity.norm() * move_.impulse_time;
        Impact impact = remembered(row);
        const double now = -motion.began > slow ? speed_at_contact(row, motion) : 0.0;
        if (now > 0.0) impact = {.speed = std::max(now, impact.stopped ? 0.0 : impact.speed)};
        const double most = move_.keeps_to_mean ? std::max(0.0, motion.ends - std::max(0.0, motion.moved / move_.length)) : 0.0;
        if (impact.speed <= slow) return most;
        if (motion.ends < -slow) {
            remember(row, impact.speed, false);
            return 0.0;
        }
        remember(row, fading_ * impact.speed, true);
        const double share = restitution(row);
        const double of_contact = std::max(0.0, std::min(motion.ends, given));
        if (share == 0.0) return std::max(most, of_contact);
        if (impact.stopped) return of_contact;
        for (int k = 0; k < 4 && rows_.vertex[row][k] >= 0; ++k) {
            space_.thrown.push_back({rows_.vertex[row][k], rows_.obstacle[row], rows_.direction[row]});
        }
        return motion.ends - share * impact.speed;
    }

    void settle(std::size_t row) {
        const double force = move_.contacts.row_forces[row].normal;
        // Beside rows that push, what they have stopped is thrown back, too.
        if (force <= 0.0 && restitution(row) == 0.0) return;
        const RowMotion motion = motion_of(row);
        if (motion.mobility == 0.0) return;
        const double given = force * move_.impulse_time * motion.mobility + std::max(0.0, motion.extrapolated);
        const double change = -excess(row, motion, given);
        if (change == 0.0) return;
        const Vec3& n = rows_.direction[row];
        for (int k = 0; k < 4 && rows_.vertex[row][k] >= 0; ++k) {
            const int vertex = rows_.vertex[row][k];
            const double part = scene_.script.free[vertex] * rows_.weight[row][k] / (scene_.model.mass[vertex] * motion.mobility);
            end_.velocities.add(vertex, part * change * n);
            if (rows_.obstacle[row] < 0 || impulses_.empty()) continue;
            const Vec3 gain = move_.weight * scene_.model.mass[vertex] * part * change * n;
            impulses_[rows_.obstacle[row]].take(end_.positions.at(vertex), gain);
        }
        // The impulse p = change/mobility changes the kinetic energy by p times the mean speed, of which the obstacle did its
        // own.
        const double impulse = change / motion.mobility;
        flows_.work += impulse * motion.obstacle;
        flows_.loss -= impulse * (motion.ends + 0.5 * change);
    }

    /// Of several rows of a vertex with one obstacle.
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
    const ContactRows& rows_;
    ClothState& end_;
    ImpactSpace& space_;
    std::vector<ObstacleImpulse>& impulses_;
    double fading_;  // in this stage
    ImpactFlows flows_;
};

}  // namespace

ImpactFlows settle_impacts(const StepScene& scene, const StageMove& move, ClothState& end, ImpactSpace& space,
                           std::vector<ObstacleImpulse>& impulses) {
    return Settling(scene, move, end, space, impulses).run();
}

}  // namespace percale
