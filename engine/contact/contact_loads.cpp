#include "contact_loads.h"

#include <algorithm>
#include <map>
#include <utility>

namespace percale {
namespace {

using LoadMap = std::map<std::pair<int, int>, ContactLoad>;

ContactLoad& load_at(LoadMap& loads, int vertex, int obstacle) {
    ContactLoad& load = loads[{vertex, obstacle}];
    load.vertex = vertex;
    load.obstacle = obstacle;
    return load;
}

}  // namespace

std::vector<ContactLoad> contact_loads(const ContactRows& rows, const ContactTerms& terms,
                                       const std::vector<RowForce>& row_forces) {
    LoadMap loads;
    for (std::size_t row = 0; row < std::min(rows.size(), row_forces.size()); ++row) {
        const RowForce& force = row_forces[row];
        if (rows.obstacle[row] < 0 || force.normal == 0.0) continue;
        for (int k = 0; k < 4 && rows.vertex[row][k] >= 0; ++k) {
            const double weight = rows.weight[row][k];
            if (weight == 0.0) continue;
            ContactLoad& load = load_at(loads, rows.vertex[row][k], rows.obstacle[row]);
            load.normal += weight * force.normal * rows.direction[row];
            load.friction += weight * force.friction;  // of projection; penalty has it by touches
        }
    }
    for (const Touch& touch : terms.touches.all) load_at(loads, touch.vertex, touch.obstacle).friction += friction_force(touch);
    std::vector<ContactLoad> result;
    for (const auto& [key, load] : loads) result.push_back(load);
    return result;
}

}  // namespace percale
