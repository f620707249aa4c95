#include "contact_loads.h"

#include <algorithm>
#include <map>
#include <utility>

namespace percale {
namespace {

/// A load, and what its obstacle point is the mean of.
struct SummedLoad {
    ContactLoad load;
    Vec3 points = Vec3::Zero();  // m N, by normal force
    double press = 0.0;          // N
};

using LoadMap = std::map<std::pair<int, int>, SummedLoad>;

SummedLoad& load_at(LoadMap& loads, int vertex, int obstacle) {
    SummedLoad& sum = loads[{vertex, obstacle}];
    sum.load.vertex = vertex;
    sum.load.obstacle = obstacle;
    return sum;
}

}  // namespace

std::vector<ContactLoad> contact_loads(const ContactRows& rows, const ContactTerms& terms,
                                       const std::vector<RowForce>& row_forces, int only) {
    const auto asked = [only](int obstacle) { return obstacle >= 0 && (only < 0 || obstacle == only); };
    LoadMap loads;
    for (std::size_t row = 0; row < std::min(rows.size(), row_forces.size()); ++row) {
        const RowForce& force = row_forces[row];
        if (!asked(rows.obstacle[row]) || force.normal == 0.0) continue;
        for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
            const double weight = rows.weight[row][k];
            if (weight == 0.0) continue;
            SummedLoad& sum = load_at(loads, rows.vertex[row][k], rows.obstacle[row]);
            sum.load.normal += weight * force.normal * rows.direction[row];
            sum.load.friction += weight * force.friction;  // of projection; penalty has it by touches
            sum.points += weight * force.normal * rows.obstacle_point[row];
            sum.press += weight * force.normal;
        }
    }
    for (const Touch& touch : terms.touches.all) {
        if (asked(touch.obstacle)) load_at(loads, touch.vertex, touch.obstacle).load.friction += friction_force(touch);
    }
    std::vector<ContactLoad> result;
    for (auto& [key, sum] : loads) {
        if (sum.press > 0.0) sum.load.obstacle_point = sum.points / sum.press;
        result.push_back(sum.load);
    }
    return result;
}

}  // namespace percale
