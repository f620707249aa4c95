#include "contact_loads.h"

#include <map>
#include <utility>

namespace percale {
namespace {

/// A load, with the sums of which its obstacle point is the mean.
struct SummedLoad {
    ContactLoad load;
    Vec3 points = Vec3::Zero();  // m N, sum of points times normal force
    double normal_force = 0.0;   // N
};

using LoadMap = std::map<std::pair<int, int>, SummedLoad>;

SummedLoad& load_at(LoadMap& loads, int vertex, int obstacle) {
    SummedLoad& sum = loads[{vertex, obstacle}];
    sum.load.vertex = vertex;
    sum.load.obstacle = obstacle;
    return sum;
}

}  // namespace

std::vector<ContactLoad> contact_loads(const ContactConstraints& constraints, const ContactTerms& terms,
                                       const std::vector<ConstraintForce>& constraint_forces, int only) {
    LoadMap loads;
    for_each_push(constraints, terms, constraint_forces, [&](const Push& push) {
        if (only >= 0 && push.obstacle != only) return;
        SummedLoad& sum = load_at(loads, push.vertex, push.obstacle);
        sum.load.normal += push.normal;
        sum.load.friction += push.friction;
        if (push.where) sum.points += push.normal_force * *push.where;
        sum.normal_force += push.normal_force;
    });
    std::vector<ContactLoad> result;
    for (auto& [key, sum] : loads) {
        if (sum.normal_force > 0.0) sum.load.obstacle_point = sum.points / sum.normal_force;
        result.push_back(sum.load);
    }
    return result;
}

}  // namespace percale
