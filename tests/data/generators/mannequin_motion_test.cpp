#include "data/generators/mannequin_motion.h"

#include <set>

#include "data/generators/mannequin.h"
#include "percale/certify.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::mannequin_motion_test {
namespace {

const Rig& rig() {
    static const Rig made = make_mannequin_rig(make_mannequin(0.02));
    return made;
}

std::vector<Vec3> walking(double phase) { return pose_mannequin(rig(), walk_pose(phase)); }
std::vector<Vec3> waving(double time) { return pose_mannequin(rig(), wave_pose(time)); }

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double largest = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) largest = std::max(largest, (a[v] - b[v]).norm());
    return largest;
}

double lowest(const std::vector<Vec3>& points) {
    double y = 1e9;
    for (const Vec3& x : points) y = std::min(y, x[1]);
    return y;
}

double degrees_of(const Rotation& r) { return angle_between({}, r) * 180.0 / EIGEN_PI; }

/// Vertices that follow none but these joints.
std::vector<int> vertices_of(const std::set<int>& joints) {
    std::vector<int> found;
    for (std::size_t v = 0; v < rig().weights.size(); ++v) {
        bool all = true;
        for (int k = 0; k < 4; ++k)
            all = all && (rig().weights[v].weights[k] == 0.0 || joints.contains(rig().weights[v].joints[k]));
        if (all) found.push_back(static_cast<int>(v));
    }
    return found;
}

Vec3 centre(const std::vector<Vec3>& posed, const std::vector<int>& vertices) {
    Vec3 sum = Vec3::Zero();
    for (const int v : vertices) sum += posed[v];
    return sum / static_cast<double>(vertices.size());
}

/// The triangles of head, trunk and legs, posed.
TriangleMesh without_arms(const std::vector<Vec3>& posed) {
    std::set<int> others;
    for (int j = 0; j < joint_count; ++j) {
        const int left = std::min(j, mirrored_joint(j));
        if (left < joint::clavicle || left > joint::wrist) others.insert(j);
    }
    std::vector<bool> kept(posed.size());
    for (const int v : vertices_of(others)) kept[v] = true;
    TriangleMesh mesh{posed, {}};
    for (const Triangle& t : rig().mesh.triangles)
        if (kept[t[0]] && kept[t[1]] && kept[t[2]]) mesh.triangles.push_back(t);
    return mesh;
}

std::size_t crossings(const std::vector<Vec3>& posed) {
    TriangleMesh mesh = rig().mesh;
    mesh.vertices = posed;
    const CrossingSearch search = find_crossings(mesh, 1000, 100000000);
    REQUIRE(search.complete);
    return search.pairs.size();
}

const std::set<int> left_hand = {joint::wrist}, left_foot = {joint::ankle};
const std::set<int> right_hand = {mirrored_joint(joint::wrist)}, right_foot = {mirrored_joint(joint::ankle)};

}  // namespace

TEST_CASE("the walk has the period 1") {
    for (const double phase : {0.0, 0.13, 0.5, 0.61, 0.99}) {
        CHECK(largest_difference(walking(phase), walking(phase + 1.0)) < 1e-12);
        CHECK(largest_difference(walking(phase), walking(phase - 7.0)) < 1e-12);
    }
    CHECK(largest_difference(walking(1.0 - 1e-9), walking(0.0)) < 1e-7);
}

TEST_CASE("half a period later the walk is its mirror image") {
    for (double phase = 0.0; phase < 1.0; phase += 0.07)
        CHECK(largest_difference(walking(phase + 0.5), pose_mannequin(rig(), mirrored_pose(walk_pose(phase)))) < 1e-12);
}

TEST_CASE("the walk goes on smoothly: no more than 5 cm in 1/60 s, and the velocity does not jump") {
    double fastest = 0.0, hardest = 0.0;
    const double step = 1.0 / 60.0 / walk_period, small = 1e-3;
    for (double phase = 0.0; phase < 1.0; phase += 0.011) {
        fastest = std::max(fastest, largest_difference(walking(phase), walking(phase + step)));
        const std::vector<Vec3> before = walking(phase - small), here = walking(phase), after = walking(phase + small);
        for (std::size_t v = 0; v < here.size(); ++v)
            hardest = std::max(hardest, (before[v] - 2.0 * here[v] + after[v]).norm() / small / walk_period);
    }
    INFO("largest step " << fastest << " m, change of velocity within 1 ms " << hardest << " m/s");
    CHECK(fastest < 0.05);
    CHECK(hardest < 0.25);
}

TEST_CASE("walking, the lower foot stands on the floor to a millimetre") {
    for (double phase = 0.0; phase < 1.0; phase += 0.01) {
        INFO("phase " << phase);
        CHECK(std::abs(lowest(walking(phase))) < 1e-3);
    }
}

TEST_CASE("a standing foot passes backwards with the floor and does not turn, and a swinging one is lifted") {
    const std::vector<int> foot = vertices_of(left_foot);
    REQUIRE(foot.size() > 50);
    const std::vector<Vec3> from = walking(0.12), to = walking(0.33), swinging = walking(0.8);
    const Vec3 passed(0.0, 0.0, -walk_speed * walk_period * 0.21);
    for (const int v : foot) REQUIRE((to[v] - from[v] - passed).norm() < 1e-12);
    for (const int v : foot) REQUIRE(swinging[v][1] > 0.01);
    CHECK(centre(walking(0.0), foot)[2] > 0.2);
    CHECK(centre(walking(0.6), foot)[2] < -0.2);
}

TEST_CASE("while the foot rolls, what it rolls over passes backwards with the floor") {
    const std::vector<int> toes = vertices_of({joint::toes});
    REQUIRE(toes.size() > 20);
    const std::vector<Vec3> flat = walking(0.33), rolling = walking(0.58);
    const Vec3 passed(0.0, 0.0, -walk_speed * walk_period * 0.25);
    for (const int v : toes) REQUIRE((rolling[v] - flat[v] - passed).norm() < 1e-12);
}

TEST_CASE("walking, knees and elbows bend one way, by no more than 65 degrees") {
    for (double phase = 0.0; phase < 1.0; phase += 0.02) {
        const MannequinPose pose = walk_pose(phase);
        for (const int knee : {static_cast<int>(joint::knee), mirrored_joint(joint::knee)}) {
            CHECK(pose.rotations[knee].x > 0.0);  // the shank backwards
            CHECK(degrees_of(pose.rotations[knee]) > 2.0);
            CHECK(degrees_of(pose.rotations[knee]) < 65.0);
        }
        CHECK(degrees_of(pose.rotations[joint::elbow]) > 5.0);
        CHECK(degrees_of(pose.rotations[joint::elbow]) < 65.0);
    }
}

TEST_CASE("walking, each arm swings with the leg of the other side, and keeps off the body") {
    const std::vector<int> hands[] = {vertices_of(left_hand), vertices_of(right_hand)};
    const std::vector<int> feet[] = {vertices_of(left_foot), vertices_of(right_foot)};
    const std::vector<Vec3> step = walking(0.0), other = walking(0.5);
    CHECK(centre(step, feet[0])[2] > centre(step, feet[1])[2] + 0.4);
    CHECK(centre(step, hands[0])[2] < centre(step, hands[1])[2] - 0.3);
    CHECK(centre(other, feet[0])[2] < centre(other, feet[1])[2] - 0.4);
    CHECK(centre(other, hands[0])[2] > centre(other, hands[1])[2] + 0.3);

    const std::vector<int> forearm = vertices_of({joint::elbow, joint::wrist});
    double nearest = 1e9;
    for (double phase = 0.0; phase < 1.0; phase += 0.1) {
        const std::vector<Vec3> posed = walking(phase);
        std::vector<Vec3> points;
        for (const int v : forearm) points.push_back(posed[v]);
        for (const double distance : surface_distances(without_arms(posed), points))
            nearest = std::min(nearest, std::abs(distance));
    }
    INFO("nearest " << nearest << " m");
    CHECK(nearest > 0.08);
}

TEST_CASE("the body crosses itself neither walking nor waving") {
    std::size_t found = 0;
    for (int k = 0; k < 16; ++k) found += crossings(walking(k / 16.0)) + crossings(waving(wave_duration * k / 16.0));
    CHECK(found == 0);
}

TEST_CASE("the wave begins and ends in the pose in which the mesh was made") {
    for (const double time : {-1.0, 0.0, wave_duration, wave_duration + 1.0})
        CHECK(largest_difference(waving(time), rig().mesh.vertices) < 1e-14);
    CHECK(largest_difference(waving(0.01), rig().mesh.vertices) < 1e-3);
}

TEST_CASE("the right arm goes up above the head, and the hand goes to and fro") {
    const std::vector<int> hand = vertices_of(right_hand), forearm = vertices_of({mirrored_joint(joint::elbow)});
    std::vector<double> places;
    for (double time = 0.75; time <= 1.75; time += 0.013) {
        const std::vector<Vec3> posed = waving(time);
        CHECK(centre(posed, hand)[1] > mannequin_height);
        CHECK(centre(posed, hand)[1] > centre(posed, forearm)[1] + 0.1);
        places.push_back(centre(posed, hand)[0]);
    }
    int turns = 0;
    for (std::size_t k = 2; k < places.size(); ++k)
        turns += (places[k] - places[k - 1]) * (places[k - 1] - places[k - 2]) < 0.0 ? 1 : 0;
    CHECK(turns == 4);
    const auto [least, most] = std::minmax_element(places.begin(), places.end());
    CHECK(*most - *least > 0.15);
}

TEST_CASE("nothing but the right shoulder and arm moves while it waves") {
    const std::vector<Vec3> up = waving(1.2);
    for (std::size_t v = 0; v < up.size(); ++v) {
        const Vec3& x = rig().mesh.vertices[v];
        if (x[0] >= 0.0 || x[1] < 0.84) REQUIRE((up[v] - x).norm() < 1e-14);
    }
}

TEST_CASE("the wave goes on smoothly: no more than 7 cm in 1/60 s, the elbow by no more than 65 degrees") {
    double fastest = 0.0, sharpest = 0.0;
    for (double time = 0.0; time < wave_duration; time += 1.0 / 60.0) {
        fastest = std::max(fastest, largest_difference(waving(time), waving(time + 1.0 / 60.0)));
        sharpest = std::max(sharpest, degrees_of(wave_pose(time).rotations[mirrored_joint(joint::elbow)]));
    }
    INFO("largest step " << fastest << " m, elbow " << sharpest << " degrees");
    CHECK(fastest < 0.07);
    CHECK(sharpest < 66.0);
}

}  // namespace percale::scenes::test::mannequin_motion_test
