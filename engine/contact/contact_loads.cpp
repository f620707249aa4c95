#include "contact_loads.h"

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
    LoadMap loads;
    for_each_push(rows, terms, row_forces, [&](const Push& push) {
        if (only >= 0 && push.obstacle != only) return;
        SummedLoad& sum = load_at(loads, push.vertex, push.obstacle);
        sum.load.normal += push.normal;
        sum.load.friction += push.friction;
        if (push.where) sum.points += push.press * *push.where;
        sum.press += push.press;
    });
    std::vector<ContactLoad> result;
    for (auto& [key, sum] : loads) {
        if (sum.press > 0.0) sum.load.obstacle_point = sum.points / sum.press;
        result.push_back(sum.load);
    }
    return result;
}

}  // namespace percale
