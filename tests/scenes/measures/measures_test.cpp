#include "measures/measures.h"

#include <cmath>
#include <vector>

#include "format/expectations.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::measures_test {
namespace {

FrameCheck frame_check(int pairs, double depth, double distance) {
    FrameCheck check;
    check.intersections = pairs;
    check.deepest_penetration = depth;
    check.smallest_distance = distance;
    return check;
}

StepReport step_report(double kinetic, double gravity, double work) {
    StepReport report;
    report.energy.kinetic = kinetic;
    report.energy.gravity = gravity;
    report.energy.work = work;
    report.smallest_distance = std::numeric_limits<double>::infinity();
    return report;
}

/// A sheet of 2 x 2 vertices without springs between anything far away, and its id.
struct Sheet {
    Simulation simulation{StepSettings{}};
    std::vector<ClothId> cloths = {simulation.add_cloth(make_grid(1.0, 1.0, 2, 2), Fabric{})};
};

}  // namespace

TEST_CASE("certificates of one frame add up: pairs and vertices sum, depth and distance take the extreme") {
    Certificate first, second;
    first.pairs = {{0, 1}, {2, 3}};
    first.touching_pairs = 4;
    first.vertices_inside = 1;
    first.deepest_penetration = 0.01;
    first.smallest_distance = 0.0;
    second.pairs = {{5, 6}};
    second.vertices_inside = 2;
    second.deepest_penetration = 0.03;
    second.smallest_distance = 0.2;
    FrameCheck check;
    CHECK(check.clean());
    add_certificate(check, first);
    add_certificate(check, second);
    CHECK(check.intersections == 3);
    CHECK(check.touching_pairs == 4);
    CHECK(check.vertices_inside == 3);
    CHECK(check.deepest_penetration == 0.03);
    CHECK(check.smallest_distance == 0.0);
    CHECK_FALSE(check.clean());
}

TEST_CASE("cloths that meet are joined to one mesh, with their pairs and stitches") {
    const std::vector<TriangleMesh> cloths{make_grid(1, 1, 2, 2), make_grid(1, 1, 3, 3), make_grid(1, 1, 2, 2)};
    const PairsOfCloths meeting{{0, 2}};
    const std::vector<ClothStitches> seams{{{0, 2}, {{.vertex = 1, .from = 2, .to = 3, .share = 0.5}}},
                                           {{0, 1}, {{.vertex = 0, .from = 4, .to = 4, .share = 0.0}}}};
    const MeetingMesh joined = joined_meeting_cloth(cloths, seams, meeting);
    CHECK(joined.mesh.vertices.size() == 8);  // not the second
    CHECK(joined.owner == std::vector<int>{0, 0, 2, 2});
    CHECK(joined.mesh.triangles[2][0] == cloths[2].triangles[0][0] + 4);
    REQUIRE(joined.stitches.size() == 1);
    CHECK((joined.stitches[0].vertex < 4 && joined.stitches[0].from >= 4));
    CHECK(joined.pairs.of(0, 2).contact);
    CHECK_FALSE(joined.pairs.of(0, 0).contact);
}

TEST_CASE("a vertex inside an obstacle makes a frame unclean even if no triangles cross") {
    FrameCheck check;
    check.vertices_inside = 1;
    CHECK_FALSE(check.clean());
}

TEST_CASE("intersecting pairs sum over the frames, the deepest penetration is the largest") {
    Measures measures;
    add_frame(measures, 0, frame_check(1, 0.002, 0.0));
    add_frame(measures, 1, frame_check(0, 0.0, 0.1));
    add_frame(measures, 2, frame_check(4, 0.001, 0.0));
    CHECK(measures.intersections == 5);
    CHECK(measures.deepest_penetration == 0.002);
    CHECK(measures.smallest_distance == 0.0);
}

TEST_CASE("the worst frame is the first with the smallest distance") {
    Measures measures;
    add_frame(measures, 0, frame_check(0, 0.0, 0.3));
    add_frame(measures, 1, frame_check(0, 0.0, 0.1));
    add_frame(measures, 2, frame_check(0, 0.0, 0.1));
    add_frame(measures, 3, frame_check(0, 0.0, 0.2));
    CHECK(measures.worst_frame == 1);
}

TEST_CASE("among frames that intersect the worst one has the most pairs") {
    Measures measures;
    add_frame(measures, 0, frame_check(1, 0.0, 0.0));
    add_frame(measures, 1, frame_check(3, 0.0, 0.0));
    add_frame(measures, 2, frame_check(2, 0.0, 0.0));
    CHECK(measures.worst_frame == 1);
}

TEST_CASE("without anything near there is no worst frame and the distance is infinite") {
    Measures measures;
    add_frame(measures, 0, FrameCheck{});
    CHECK(measures.worst_frame == -1);
    CHECK(std::isinf(measures.smallest_distance));
    CHECK(measure_values(measures).at("worst_frame") == -1.0);
}

TEST_CASE("energy gain is the largest rise of one step beyond the work done on the cloth") {
    Measures measures;
    add_step(measures, step_report(3.0, 1.0, 0.0), 10.0);  // falls by 6
    CHECK(measures.energy_gain == 0.0);
    add_step(measures, step_report(3.0, 2.0, 1.5), 4.0);  // rises by 1, work 1.5
    CHECK(measures.energy_gain == 0.0);
    add_step(measures, step_report(5.0, 2.0, 1.5), 5.0);  // rises by 2, work 1.5
    CHECK(measures.energy_gain == Approx(0.5));
    add_step(measures, step_report(5.25, 2.0, 0.0), 7.0);
    CHECK(measures.energy_gain == Approx(0.5));
}

TEST_CASE("negative work counts: energy taken out by an obstacle must be gone") {
    Measures measures;
    add_step(measures, step_report(5.0, 0.0, -2.0), 5.0);
    CHECK(measures.energy_gain == Approx(2.0));
}

TEST_CASE("strain and distance take their extreme over the steps") {
    Measures measures;
    double time = 0.0;
    for (const double strain : {0.05, 0.2, 0.1}) {
        StepReport report = step_report(0.0, 0.0, 0.0);
        report.time = time += 1.0;
        report.largest_strain = strain;
        report.smallest_distance = 0.5 - strain;
        add_step(measures, report, 0.0);
    }
    CHECK(measures.largest_strain == 0.2);
    CHECK(measures.strain_time == 2.0);
    CHECK(measures.smallest_distance == Approx(0.3));
}

TEST_CASE("what failed over a whole run is reported with the frame, what passed or is of a time is not") {
    Measures measures;
    measures.intersections = 3;
    measures.worst_frame = 12;
    std::vector<Expectation> none(3);
    for (Expectation& expectation : none) expectation.measure = "intersections";
    none[1].highest = 5.0;
    none[2].at = 1.0;
    const std::vector<double> timed = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN(), 2.0};
    const auto verdicts = judge_run(none, measures, timed, Scene{});
    CHECK(verdicts[0].text == "intersections 3, expected = 0: failed (nearest in frame 12)");
    CHECK(verdicts[1].text.ends_with(": passed"));
    CHECK(verdicts[2].text.ends_with(": failed"));
}

TEST_CASE("speeds at the end are the largest and the root mean square over all vertices") {
    Sheet sheet;
    sheet.simulation.set_velocities(sheet.cloths[0],
                                    std::vector<Vec3>{{3.0, 0.0, 4.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}});
    Measures measures;
    add_end(measures, sheet.simulation, sheet.cloths);
    CHECK(measures.speed_at_end == Approx(5.0));
    CHECK(measures.rms_speed_at_end == Approx(std::sqrt(26.0 / 4.0)));
}

TEST_CASE("the lowest vertex is looked for in every cloth") {
    Sheet sheet;
    sheet.cloths.push_back(
        sheet.simulation.add_cloth(make_grid(1.0, 1.0, 2, 2), Fabric{}, {.translation = Vec3(0.0, -0.75, 0.0)}));
    Measures measures;
    add_end(measures, sheet.simulation, sheet.cloths);
    CHECK(measures.lowest_vertex == Approx(-0.75));
}

TEST_CASE("the distance from a reference is that of the farthest vertex, in order") {
    const Sheet sheet;
    const std::span<const Vec3> positions = sheet.simulation.positions(sheet.cloths[0]);
    std::vector<Vec3> reference(positions.begin(), positions.end());
    CHECK(largest_vertex_distance(sheet.simulation, sheet.cloths, reference) == 0.0);
    reference[2] += Vec3(0.0, 0.03, 0.04);
    reference[3] += Vec3(0.0, 0.01, 0.0);
    CHECK(largest_vertex_distance(sheet.simulation, sheet.cloths, reference) == Approx(0.05));
    std::swap(reference[0], reference[1]);
    CHECK(largest_vertex_distance(sheet.simulation, sheet.cloths, reference) == Approx(1.0));
}

TEST_CASE("every measure that a scene may expect has a value, matches only with a reference, gaps only with seams") {
    Measures measures;
    CHECK(measure_values(measures).count("largest_seam_gap") == 0);
    measures.largest_seam_gap = 0.1;
    for (const MeasureDescription& description : measure_descriptions()) {
        INFO(description.name);
        CHECK(measure_values(measures).count(description.name) == 1);
    }
    CHECK(measure_values(measures).count("matches") == 0);
    measures.matches = 0.25;
    CHECK(measure_values(measures).at("matches") == 0.25);
}

TEST_CASE("checks of states add up, and the worst is the nearest, of equally near ones the one with most pairs") {
    StepChecks checks;
    add_state(checks, 0, 0.0, frame_check(0, 0.0, std::numeric_limits<double>::infinity()));
    CHECK(checks.worst_step == -1);
    add_state(checks, 1, 0.1, frame_check(0, 0.0, 0.2));
    CHECK(checks.worst_step == 1);
    add_state(checks, 2, 0.2, frame_check(1, 0.01, 0.0));
    add_state(checks, 3, 0.3, frame_check(4, 0.005, 0.0));
    add_state(checks, 4, 0.4, frame_check(0, 0.0, 0.1));
    CHECK(checks.states == 5);
    CHECK(checks.intersections == 5);
    CHECK(checks.deepest_penetration == 0.01);
    CHECK(checks.smallest_distance == 0.0);
    CHECK(checks.worst_step == 3);
    CHECK(checks.worst_time == 0.3);
    CHECK(checks.worst.intersections == 4);
}

TEST_CASE("what every step is judged by has values only where every step was certified") {
    Measures measures;
    CHECK(measure_values(measures).count("intersections_at_every_step") == 0);
    measures.steps.emplace();
    add_state(*measures.steps, 3, 0.1, frame_check(2, 0.01, 0.0));
    CHECK(measure_values(measures).at("intersections_at_every_step") == 2.0);
    CHECK(measure_values(measures).at("deepest_penetration_at_every_step") == 0.01);
}

TEST_CASE("steps in which obstacles give way are one pinch as long as they pause for few steps, by pair of obstacles") {
    std::vector<Pinch> pinches;
    const auto step = [&](double time, std::array<int, 2> pinching, double yielded) {
        StepReport report;
        report.time = time;
        report.dt = 0.1;
        report.pinched = pinching[0] < 0 ? 0 : 3;
        report.pinching = pinching;
        report.yielded = yielded;
        add_pinch(pinches, report);
    };
    step(1.0, {2, 0}, 0.01);
    step(1.1, {1, 1}, 0.02);
    step(1.2, {-1, -1}, 0.02);
    step(1.3, {0, 2}, 0.005);
    step(3.0, {0, 2}, 0.001);
    REQUIRE(pinches.size() == 3);
    CHECK(pinches[0].obstacles == std::array{0, 2});
    CHECK(pinches[0].from == Approx(0.9));
    CHECK(pinches[0].to == 1.3);
    CHECK(pinches[0].yielded == 0.01);
    CHECK(pinches[1].obstacles == std::array{1, 1});
    CHECK(pinches[2].from == Approx(2.9));
    Scene scene;
    for (const char* name : {"arm", "trunk", "leg"}) scene.obstacles.emplace_back().name = name;
    scene.obstacles[0].place = {.file = "a.toml", .line = 3, .column = 1};
    CHECK(pinch_warning(pinches[0], scene).kind == "pinched");
    CHECK(pinch_warning(pinches[0], scene).place == "a.toml:3:1");
    CHECK(finding_text(pinch_warning(pinches[0], scene)) ==
          "'arm' and 'leg' pinched cloth; the compliant obstacle (on_pinch) gave way by up to 0.01 m, from 0.9 s to 1.3 s");
    CHECK(pinch_warning(pinches[1], scene).what.find("'trunk' pinched cloth") == 0);
}

}  // namespace percale::scenes::test::measures_test
