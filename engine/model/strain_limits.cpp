#include "strain_limits.h"

#include <algorithm>
#include <limits>

#include "tolerances.h"

namespace percale {
namespace {

/// N/m: limit of an edge without stiffness, whose ends are sewn together. 0: a division by 0.
constexpr double min_limited = 1e-12;

double length_of(const LimitedEdge& edge, const SpringNetwork& network, const Vec3Arrays& x) {
    return (x.at(network.first[edge.spring]) - x.at(network.second[edge.spring])).norm();
}

double energy_of(const LimitedEdge& edge, double length) {
    const double tension = std::max(0.0, edge.hold + edge.stiffness * (length - edge.length));
    return 0.5 * tension * tension / edge.stiffness;
}

}  // namespace

void StrainLimits::set_hold(LimitedEdge& edge, double hold_now) {
    edge.hold = hold_now;
    const double slack = std::max(0.0, edge.length - hold_now / edge.stiffness);
    for (const int entry : edge.entry) {
        hold[entry] = hold_now;
        slack_square[entry] = slack * slack;
    }
}

double limit_tension(const LimitedEdge& edge, const SpringNetwork& network, const Vec3Arrays& positions) {
    return std::max(0.0, edge.hold + edge.stiffness * (length_of(edge, network, positions) - edge.length));
}

double limit_energy(const StrainLimits& limits, const SpringNetwork& network, const Vec3Arrays& positions) {
    double energy = 0.0;
    for (const LimitedEdge& edge : limits.edges) energy += energy_of(edge, length_of(edge, network, positions));
    return energy;
}

double tighten(StrainLimits& limits, const SpringNetwork& network, const Vec3Arrays& positions, double fraction) {
    double work = 0.0;
    for (LimitedEdge& edge : limits.edges) {
        const double length = length_of(edge, network, positions);
        const double hold = std::clamp(edge.hold + fraction * edge.stiffness * (length - edge.length), 0.0, edge.max_hold);
        if (hold == edge.hold) continue;
        const double before = energy_of(edge, length);
        limits.set_hold(edge, hold);
        work += energy_of(edge, length) - before;
    }
    return work;
}

void set_strain_limits(const SpringNetwork& network, std::span<const double> strain, const Adjacency& adjacency,
                       StrainLimits& limits) {
    const std::vector<LimitedEdge> before = std::move(limits.edges);
    limits.edges.clear();
    const std::size_t entries = adjacency.other.size();
    for (auto* list : {&limits.length, &limits.stiffness, &limits.hold}) list->assign(entries, 0.0);
    limits.slack_square.assign(entries, std::numeric_limits<double>::max());
    for (int k = 0; k < network.size(); ++k) {
        if (strain[k] == 0.0 || network.kind[k] != SpringKind::structural) continue;
        const double own = std::max(adjacency.strength(k), min_limited), rest = network.rest_length[k];
        const auto [first, second] = adjacency.entries_of(network, k);
        LimitedEdge edge{.spring = k,
                         .entry = {first, second},
                         .length = (1.0 + strain[k]) * rest,
                         .stiffness = limit_stiffness * own,
                         .max_hold = max_held_strain * own * rest};
        for (const int entry : edge.entry) {
            limits.length[entry] = edge.length;
            limits.stiffness[entry] = edge.stiffness;
        }
        const std::size_t number = limits.edges.size();
        limits.set_hold(edge, number < before.size() ? std::min(before[number].hold, edge.max_hold) : 0.0);
        limits.edges.push_back(edge);
    }
}

}  // namespace percale
