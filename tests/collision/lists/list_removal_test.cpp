#include "collision/lists/list_removal.h"

#include <algorithm>

#include "percale/detectors.h"
#include "tests/support/catch.h"
#include "tests/support/collision/backends.h"
#include "tests/support/collision/pairs.h"
#include "tests/support/collision/shapes.h"
#include "tests/support/random.h"

namespace percale::test::list_removal_test {
namespace {

constexpr double thickness = 0.06;

/// Three balls side by side, and a sheet that touches all of them.
struct BallsUnderSheet {
    TriangleMesh cloth = make_grid(1.4, 0.4, 29, 9);
    std::vector<double> thickness_of_vertex = std::vector<double>(cloth.vertices.size(), thickness);
    Obstacles obstacles;

    BallsUnderSheet() {
        for (const double x : {-0.45, 0.0, 0.45}) {
            const Pose pose{.translation = {x, -0.22, 0.0}};
            obstacles.push_back(std::make_unique<Obstacle>(make_sphere(0.2, 2), pose, 0.1, make_brute_force_tree));
        }
    }
    /// Lists for the cloth where it lies; every other pack is made persistent.
    CandidateLists lists() {
        CandidateLists made(cloth.triangles, thickness_of_vertex, cloth.vertices);
        std::vector<Vec3> to = cloth.vertices;
        for (Vec3& x : to) x.y() -= 0.01;
        made.cover({.from = cloth.vertices, .to = to, .fraction = {0.0, 1.0}}, obstacles);
        for (ClusterList& list : made.lists()) {
            for (std::size_t i = 0; i < list.packs.size(); i += 2) list.packs.make_persistent(i, i % 8, thickness);
            list.has_persistent = list.packs.size() > 0;
        }
        return made;
    }
};

/// Contents of a list for all obstacles but one: obstacle, feature's vertices, pack, persistent lanes and bounds.
using Said = std::tuple<int, std::array<int, 3>, unsigned, unsigned, float, float>;
std::vector<Said> said_by(const ClusterList& list, int without) {
    std::vector<Said> all;
    for (std::size_t i = 0; i < list.packs.size(); ++i) {
        const ListedPack& pack = list.packs.at[i];
        const ContactPair& feature = list.features[pack.feature];
        if (feature.obstacle == without) continue;
        const int number = without >= 0 && feature.obstacle > without ? feature.obstacle - 1 : feature.obstacle;
        all.emplace_back(number, feature.cloth, pack.number, pack.persistent, list.packs.reach[i], list.packs.wake[i]);
    }
    return all;
}

}  // namespace

TEST_CASE("lists without an obstacle keep their contents about the others, and stay valid") {
    for (const int gone : {0, 1, 2}) {
        CAPTURE(gone);
        BallsUnderSheet scene;
        CandidateLists lists = scene.lists();
        std::vector<std::vector<Said>> before;
        std::size_t of_it = 0;
        for (const ClusterList& list : lists.lists()) {
            before.push_back(said_by(list, gone));
            of_it += list.packs.size() - before.back().size();
        }
        REQUIRE(of_it > 100);
        const int version = total_version(scene.obstacles);
        scene.obstacles.erase(scene.obstacles.begin() + gone);
        remove_obstacle(gone, version, scene.obstacles, lists.memory());
        std::size_t packs = 0;
        for (std::size_t c = 0; c < before.size(); ++c) {
            const ClusterList& list = lists.lists()[c];
            CHECK(said_by(list, -1) == before[c]);
            CHECK(list.version == total_version(scene.obstacles));
            const bool persistent =
                std::ranges::any_of(list.packs.at, [](const ListedPack& pack) { return pack.persistent != 0; });
            CHECK(list.has_persistent == persistent);
            const auto& reach = list.packs.reach;
            if (!reach.empty()) CHECK(list.smallest_reach == static_cast<double>(*std::ranges::min_element(reach)));
            packs += list.packs.size();
        }
        CHECK(packs > 200);
        CHECK_FALSE(lists.empty());
        // They are not rebuilt: the next call finds them valid.
        lists.cover({.from = scene.cloth.vertices, .to = scene.cloth.vertices, .fraction = {0.0, 1.0}}, scene.obstacles);
        for (std::size_t c = 0; c < before.size(); ++c) CHECK(lists.lists()[c].packs.size() == before[c].size());
    }
}

TEST_CASE("lists that were not valid before are not valid after, and without obstacles nothing is near") {
    BallsUnderSheet scene;
    CandidateLists lists = scene.lists();
    lists.memory().lists[0].version = no_version;
    for (int left = 2; left >= 0; --left) {
        const int version = total_version(scene.obstacles);
        scene.obstacles.erase(scene.obstacles.begin());
        remove_obstacle(0, version, scene.obstacles, lists.memory());
        CHECK(lists.memory().lists[0].version == no_version);
        CHECK(lists.empty() == (left == 0));
    }
}

}  // namespace percale::test::list_removal_test
