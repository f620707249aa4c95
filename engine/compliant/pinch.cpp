#include "pinch.h"

#include <algorithm>
#include <map>

#include "tolerances.h"

namespace percale {
namespace {

/// Surfaces give way from this fraction of the room that two activation distances have, at which the cloth between them begins
/// to be pressed. Larger: they give way before the contacts that show the pinch exist. Smaller: cloth is pressed hard.
constexpr double kept_room = 0.6;

/// Passes over contacts between cloths; each sees through at least one layer. Fewer: thick bundles are pinched unseen.
constexpr int compliant_passes = 3;

/// Minimum of the cosine between the directions of two contacts on one side of cloth. Smaller: pressure is passed on sideways.
/// Larger: slanted layers do not pass it on.
constexpr double same_side = 0.5;

/// Weight in a contact from which it presses a vertex. Larger: pairs that pinch are not seen.
constexpr double min_pressing_weight = 0.05;

/// A point of an obstacle that presses a vertex of cloth.
struct Presser {
    std::size_t constraint;                // in which a point of an obstacle presses
    Vec3 direction;                        // from that point to the cloth
    double distance, activation_distance;  // m, along cloth in between: its distance, and where contact would begin
};
using Pressers = std::map<int, std::vector<Presser>>;  // of each vertex

void add(Pressers& pressers, int vertex, const Presser& more) {
    std::vector<Presser>& here = pressers[vertex];
    const auto known = std::ranges::find_if(here, [&](const Presser& one) { return one.constraint == more.constraint; });
    if (known == here.end())
        here.push_back(more);
    else if (more.distance < known->distance)
        *known = more;
}

template <class Work>
void for_each_vertex(const ContactConstraints& constraints, std::size_t constraint, double sign, Work work) {
    for (int k = 0; k < 4 && constraints.vertex[constraint][k] >= 0; ++k) {
        if (sign * constraints.weight[constraint][k] > min_pressing_weight) work(constraints.vertex[constraint][k]);
    }
}

/// Passes the pressers through a contact between cloths, from one side of it to the other.
void pass_through(const ContactConstraints& constraints, std::size_t constraint, double side, Pressers& pressers) {
    const Vec3 across = side * constraints.direction[constraint];
    std::vector<Presser> passed;
    for_each_vertex(constraints, constraint, -side, [&](int vertex) {
        for (const Presser& one : pressers[vertex]) {
            if (one.direction.dot(across) > same_side)
                passed.push_back({one.constraint, one.direction, one.distance + constraints.distance[constraint],
                                  one.activation_distance + constraints.thickness[constraint]});
        }
    });
    for (const Presser& one : passed)
        for_each_vertex(constraints, constraint, side, [&](int vertex) { add(pressers, vertex, one); });
}

Pressers pressers_of(const ContactConstraints& constraints) {
    Pressers pressers;
    bool layers = false;
    for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
        layers = layers || constraints.obstacle[constraint] < 0;
        if (constraints.obstacle[constraint] < 0 || constraints.mollifier[constraint] < 0.0) continue;
        const Presser one{constraint, constraints.direction[constraint], constraints.distance[constraint],
                          constraints.thickness[constraint]};
        for_each_vertex(constraints, constraint, 1.0, [&](int vertex) { add(pressers, vertex, one); });
    }
    for (int pass = 0; layers && pass < compliant_passes; ++pass) {
        for (std::size_t constraint = 0; constraint < constraints.size(); ++constraint) {
            if (constraints.obstacle[constraint] >= 0 || constraints.mollifier[constraint] < 0.0) continue;
            for (const double side : {1.0, -1.0}) pass_through(constraints, constraint, side, pressers);
        }
    }
    return pressers;
}

}  // namespace

Retreats retreats_of(const ContactConstraints& constraints, const Script& script) {
    Retreats retreats{.by_constraint = std::vector<double>(constraints.size(), -std::numeric_limits<double>::infinity())};
    const auto yields = [&](const Presser& one) {
        return script.obstacles[constraints.obstacle[one.constraint]].compliance.mesh != nullptr;
    };
    const auto keep_apart = [&](const Presser& a, const Presser& b) {
        const int sharers = int{yields(a)} + int{yields(b)};
        if (sharers == 0 || a.direction.dot(b.direction) > opposite_sides) return;
        const Vec3 closing = constraints.obstacle_displacement[b.constraint] - constraints.obstacle_displacement[a.constraint];
        const double room = a.distance + b.distance + closing.dot(a.direction);
        const double lack = kept_room * (a.activation_distance + b.activation_distance) - room;
        for (const Presser& one : {a, b}) {
            if (yields(one))
                retreats.by_constraint[one.constraint] = std::max(retreats.by_constraint[one.constraint], lack / sharers);
        }
        if (lack / sharers <= -deflection_slack * constraints.thickness[a.constraint] || room >= retreats.min_room) return;
        retreats.min_room = room;
        retreats.obstacles = {constraints.obstacle[a.constraint], constraints.obstacle[b.constraint]};
    };
    for (const auto& [vertex, pressers] : pressers_of(constraints)) {
        for (std::size_t i = 0; i < pressers.size(); ++i)
            for (std::size_t j = i + 1; j < pressers.size(); ++j) keep_apart(pressers[i], pressers[j]);
    }
    return retreats;
}

}  // namespace percale
