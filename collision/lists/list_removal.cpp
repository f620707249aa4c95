#include "lists/list_removal.h"

#include <algorithm>

namespace percale {
namespace {

/// Removes the features at an obstacle, with their packs; the numbers of later obstacles decrease by one. Bounds of the others do
/// not change.
void remove_features_of(int obstacle, ClusterList& list) {
    if (list.features.empty() || list.features.back().obstacle < obstacle) return;
    const auto is_of_it = [&](const ContactPair& feature) { return feature.obstacle == obstacle; };
    if (std::none_of(list.features.begin(), list.features.end(), is_of_it)) {
        for (ContactPair& feature : list.features) feature.obstacle -= feature.obstacle > obstacle ? 1 : 0;
        return;
    }
    std::vector<int> number;  // of each feature now; -1: gone
    std::vector<ContactPair> features;
    for (const ContactPair& feature : list.features) {
        number.push_back(is_of_it(feature) ? -1 : static_cast<int>(features.size()));
        if (is_of_it(feature)) continue;
        features.push_back(feature);
        if (feature.obstacle > obstacle) --features.back().obstacle;
    }
    ListedPacks packs;
    list.has_persistent = false;
    for (std::size_t i = 0; i < list.packs.size(); ++i) {
        ListedPack pack = list.packs.at[i];
        pack.feature = number[pack.feature];
        if (pack.feature < 0) continue;
        packs.reach.push_back(list.packs.reach[i]);
        packs.wake.push_back(list.packs.wake[i]);
        packs.at.push_back(pack);
        list.has_persistent = list.has_persistent || pack.persistent != 0;
    }
    list.features = std::move(features);
    list.packs = std::move(packs);
    CandidateLists::set_smallest_bounds(list);
}

}  // namespace

void remove_obstacle(int obstacle, int version, const Obstacles& left, CandidateListsState& memory) {
    const int now = total_version(left);
    const auto go_on = [&](int& known) { known = known == version ? now : no_version; };
    go_on(memory.room_version);
    memory.empty = true;
    for (ClusterList& list : memory.lists) {
        go_on(list.version);
        remove_features_of(obstacle, list);
        memory.empty = memory.empty && list.features.empty();
    }
}

}  // namespace percale
