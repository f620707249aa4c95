#include "doctor/doctor_mesh.h"

#include <algorithm>
#include <functional>

#include "meshes/near_vertices.h"
#include "tests/scenes/faulty_meshes.h"
#include "tests/scenes/split_corners.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::doctor_mesh_test {
namespace {

ExaminedMesh examined(MeshRole role, const TriangleMesh& mesh) {
    return {.role = role,
            .name = role == MeshRole::cloth ? "cloth 'c'" : "obstacle 'o'",
            .place = "a.toml:3:1",
            .mesh = mesh,
            .facts = facts_as(role, mesh)};
}

std::vector<Finding> of_cloth(const TriangleMesh& mesh, const Fabric& fabric = {}) {
    return examine_cloth(examined(MeshRole::cloth, mesh), fabric);
}
std::vector<Finding> of_obstacle(const TriangleMesh& mesh) { return examine_obstacle(examined(MeshRole::obstacle, mesh)); }
std::vector<Finding> of_pair(const TriangleMesh& cloth, const TriangleMesh& obstacle) {
    return examine_pair(examined(MeshRole::cloth, cloth), examined(MeshRole::obstacle, obstacle));
}

const Finding* find(const std::vector<Finding>& found, const std::string& kind) {
    const auto one = std::find_if(found.begin(), found.end(), [&](const Finding& finding) { return finding.kind == kind; });
    return one == found.end() ? nullptr : &*one;
}

/// Exactly this finding beside notes, with a place, a cause and a fix.
void check_only(const std::vector<Finding>& found, const std::string& kind, Severity severity) {
    INFO(kind);
    const Finding* finding = find(found, kind);
    REQUIRE(finding != nullptr);
    CHECK(finding->severity == severity);
    CHECK(finding->place == "a.toml:3:1");
    CHECK(finding->what.find("'") != std::string::npos);
    CHECK(finding->fix.size() > 10);
    for (const Finding& other : found)
        if (other.kind != kind && other.severity != Severity::note) FAIL_CHECK(kind << " comes with " << other.kind);
}

TriangleMesh with_triangle(TriangleMesh mesh, const Triangle& triangle) {
    mesh.triangles.push_back(triangle);
    return mesh;
}

TriangleMesh with_vertex(TriangleMesh mesh, const Vec3& vertex) {
    mesh.vertices.push_back(vertex);
    return mesh;
}

/// Two triangles on one edge, folded onto each other.
TriangleMesh folded() {
    return {.vertices = {{0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.1}, {0, 0, 0.1}}, .triangles = {{0, 1, 2}, {1, 0, 3}}};
}

/// A strip whose last vertex lies `last` m from its neighbours.
TriangleMesh strip(double last) {
    return {.vertices = {{0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.1}, {last, 0, 0.1}}, .triangles = {{0, 2, 1}, {1, 2, 3}}};
}

TriangleMesh open_ball() {
    TriangleMesh ball = make_sphere(0.3, 2);
    ball.triangles.pop_back();
    return ball;
}

TriangleMesh one_turned(TriangleMesh mesh, std::size_t triangle) {
    std::swap(mesh.triangles[triangle][1], mesh.triangles[triangle][2]);
    return mesh;
}

}  // namespace

TEST_CASE("nothing is found in a sound sheet and a sound ball") {
    CHECK(of_cloth(free_sheet()).empty());
    CHECK(of_cloth(free_sheet(), {.self_contact = true}).empty());
    CHECK(of_obstacle(make_sphere(0.3, 3)).empty());
    CHECK(of_pair(free_sheet(), make_sphere(0.3, 2)).empty());
}

TEST_CASE("what cloth is refused for is an error with the numbers of the elements; what is left out of it, a note") {
    const TriangleMesh sheet = free_sheet();
    check_only(of_cloth(with_vertex(sheet, {0, 1, 0})), "unused_vertices", Severity::note);
    const Triangle first = sheet.triangles[0];
    check_only(of_cloth(crowded_sheet()), "crowded_edges", Severity::error);
    CHECK(find(of_cloth(crowded_sheet()), "crowded_edges")->elements == std::vector<int>{0, 8});
    const auto repeated = of_cloth(with_triangle(sheet, {first[1], first[2], first[0]}));
    check_only(repeated, "repeated_triangles", Severity::note);
    CHECK(find(repeated, "repeated_triangles")->elements == std::vector<int>{static_cast<int>(sheet.triangles.size())});
    const auto flat = of_cloth({.vertices = {{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}}, .triangles = {{0, 1, 2}}});
    check_only(flat, "flat_triangles", Severity::error);
    CHECK(find(flat, "flat_triangles")->count == 1);
}

TEST_CASE("a finding names a few elements and counts all") {
    TriangleMesh sheet = free_sheet();
    for (int i = 0; i < 10; ++i) sheet.vertices.emplace_back(0, 1, i);
    const std::vector<Finding> found = of_cloth(sheet);
    const Finding* finding = find(found, "unused_vertices");
    CHECK(finding->count == 10);
    CHECK(finding->elements == std::vector<int>{49, 50, 51, 52});
    CHECK(finding->what.find("10 vertices of no triangle, left out: 49, 50, 51, 52, ...") != std::string::npos);
}

TEST_CASE("a bending spring without length is an error where there are such springs") {
    CHECK(find(of_cloth(folded()), "folded_flat")->severity == Severity::warning);
    CHECK(find(of_cloth(folded(), {.springs = {.bend = 1.0}}), "folded_flat")->severity == Severity::error);
    CHECK(find(of_cloth(strip(0.1), {.springs = {.bend = 1.0}}), "folded_flat") == nullptr);
}

TEST_CASE("what makes cloth come apart, stiff or thick for its mesh is a warning") {
    const TriangleMesh sheet = free_sheet();
    check_only(of_cloth(both(sheet, shifted(sheet, {0.6, 0, 0}))), "repeated_places", Severity::warning);
    CHECK(find(of_cloth(both(sheet, shifted(sheet, {0.7, 0, 0}))), "repeated_places") == nullptr);
    ExaminedMesh halves = examined(MeshRole::cloth, both(sheet, shifted(sheet, {0.6, 0, 0})));
    const std::string fix = find(examine_cloth(halves, {}), "repeated_places")->fix;
    REQUIRE(fix.starts_with("weld = "));
    CHECK(find(of_cloth(weld_near(halves.mesh, std::stod(fix.substr(7))).mesh), "repeated_places") == nullptr);
    halves.sewn = true;
    CHECK(find(examine_cloth(halves, {}), "repeated_places")->fix.starts_with("merge vertices"));
    TriangleMesh hourglass = strip(0.1);
    hourglass.vertices.insert(hourglass.vertices.end(), {{0.2, 0, 0.2}, {0.1, 0, 0.2}});
    hourglass.triangles.push_back({3, 5, 4});
    check_only(of_cloth(hourglass), "pinched_vertices", Severity::warning);
    check_only(of_cloth(strip(20.0)), "slivers", Severity::warning);
    CHECK(find(of_cloth(strip(20.0)), "edge_lengths") == nullptr);
    CHECK(find(of_cloth(strip(1e-5)), "edge_lengths") != nullptr);
    check_only(of_cloth(sheet, {.thickness = 0.15}), "thick_for_edges", Severity::warning);
    CHECK(find(of_cloth(strip(0.02), {.thickness = 0.05}), "thick_for_edges") == nullptr);
    CHECK(find(of_cloth(strip(0.02), {.thickness = 0.05, .self_contact = true}), "thick_for_edges")->severity == Severity::note);
    check_only(of_cloth(shifted(sheet, {100, 0, 0}), {.thickness = 9e-4}), "thin_for_place", Severity::warning);
    CHECK(find(of_cloth(sheet, {.thickness = 9e-4}), "thin_for_place") == nullptr);
}

TEST_CASE("cloth that crosses itself is an error only where it meets itself") {
    check_only(of_cloth(crossed_sheets()), "self_crossing", Severity::warning);
    check_only(of_cloth(crossed_sheets(), {.self_contact = true}), "self_crossing", Severity::warning);
    CHECK(find(of_cloth(both(free_sheet(), shifted(free_sheet(), {0, 0.01, 0}))), "self_crossing") == nullptr);
}

TEST_CASE("a closed cloth and an open obstacle were likely swapped, unless the cloth is filled") {
    const TriangleMesh ball = make_sphere(0.3, 2), sheet = scaled(free_sheet(), 1.2);
    const auto pair = [](const TriangleMesh& cloth, const TriangleMesh& obstacle, bool filled) {
        return examine_pair(
            {.role = MeshRole::cloth, .name = "cloth 'c'", .filled = filled, .mesh = cloth, .facts = mesh_facts(cloth)},
            {.role = MeshRole::obstacle, .name = "obstacle 'o'", .mesh = obstacle, .facts = mesh_facts(obstacle)});
    };
    const auto swapped = pair(ball, sheet, false);
    REQUIRE(find(swapped, "swapped") != nullptr);
    CHECK(find(swapped, "swapped")->severity == Severity::warning);
    CHECK(find(pair(ball, sheet, true), "swapped") == nullptr);
    CHECK(find(pair(sheet, ball, false), "swapped") == nullptr);
    CHECK(find(pair(ball, shifted(ball, {0, 0.5, 0}), false), "swapped") == nullptr);
}

TEST_CASE("rims that lie side by side were likely meant to be joined, unless a seam joins them") {
    const TriangleMesh open = both(free_sheet(), shifted(free_sheet(), {0.602, 0, 0}));
    check_only(of_cloth(open), "near_rims", Severity::warning);
    CHECK(find(of_cloth(open), "near_rims")->count == 14);
    ExaminedMesh sewn = examined(MeshRole::cloth, open);
    sewn.sewn = true;
    CHECK(find(examine_cloth(sewn, {}), "near_rims") == nullptr);
    CHECK(find(of_cloth(both(free_sheet(), shifted(free_sheet(), {0.61, 0, 0}))), "near_rims") == nullptr);
}

TEST_CASE("corners that differ by rounding are reported with the weld that joins them") {
    for (unsigned seed = 0; seed < 10; ++seed) {
        percale::test::Random random(seed);
        const TriangleMesh ball = make_sphere(random.decades(0.05, 1.0), 2);
        const TriangleMesh apart = split_corners(ball, mesh_facts(ball).shortest_edge * random.decades(1e-8, 3e-3), random);
        for (const std::vector<Finding>& findings : {of_cloth(apart), of_obstacle(apart)}) {
            const Finding* rims = find(findings, "near_rims");
            CAPTURE(seed);
            REQUIRE(rims != nullptr);
            REQUIRE(rims->fix.starts_with("weld = "));
            const double weld = std::stod(rims->fix.substr(7));
            CHECK(is_watertight(weld_near(apart, weld).mesh));
            CHECK(find(of_obstacle(weld_near(apart, weld).mesh), "near_rims") == nullptr);
        }
    }
}

TEST_CASE("the weld is named in m of the unit that a mesh looks as if it had, before its pose, and for meshes with slivers") {
    percale::test::Random random(1);
    const TriangleMesh ball = make_sphere(0.5, 3);
    const double edge = mesh_facts(ball).median_edge;
    TriangleMesh apart = split_corners(ball, 1e-3 * edge, random);
    const auto named = [](const ExaminedMesh& mesh) {
        const std::vector<Finding> findings = examine_obstacle(mesh);
        const Finding* rims = find(findings, "near_rims");
        return rims == nullptr ? std::string() : rims->fix;
    };
    const double metres = std::stod(named(examined(MeshRole::obstacle, apart)).substr(7));
    const std::string fix = named(examined(MeshRole::obstacle, scaled(apart, 1000.0)));
    CHECK(std::stod(fix.substr(7)) == Approx(metres));
    CHECK(fix.find(" with unit = \"mm\" beside its mesh") != std::string::npos);
    ExaminedMesh posed = examined(MeshRole::obstacle, scaled(apart, 2.0));
    posed.scale = 2.0;
    CHECK(std::stod(named(posed).substr(7)) == Approx(metres).epsilon(0.3));  // of one digit
    apart.vertices[1] = apart.vertices[0] + Vec3(1e-4 * edge, 0, 0);
    const std::string sliver = named(examined(MeshRole::obstacle, apart));
    REQUIRE(sliver.starts_with("weld = "));
    CHECK(weld_near(apart, std::stod(sliver.substr(7))).dropped_triangles == 1);
}

TEST_CASE("pieces, and triangles wound against each other, are notes for cloth") {
    const auto pieces = of_cloth(both(free_sheet(), shifted(free_sheet(), {0, 0.1, 0})));
    REQUIRE(pieces.size() == 1);
    CHECK(pieces[0].kind == "parts");
    CHECK(pieces[0].severity == Severity::note);
    const auto contrary = of_cloth(one_turned(free_sheet(), 0));
    REQUIRE(contrary.size() == 1);
    CHECK(contrary[0].kind == "contrary_edges");
}

TEST_CASE("meshes that look like another unit, and such far from the origin, are warned of") {
    const std::vector<std::pair<double, std::string>> units = {{300.0, "\"cm\""}, {3000.0, "\"mm\""}, {0.001, "pose.scale"}};
    for (const auto& [factor, fix] : units) {
        const auto found = of_obstacle(scaled(make_sphere(0.3, 2), factor));
        check_only(found, "size", Severity::warning);
        CHECK(find(found, "size")->fix.find(fix) != std::string::npos);
    }
    CHECK(of_obstacle(scaled(make_sphere(0.3, 2), 30.0)).empty());
    check_only(of_obstacle(shifted(make_sphere(0.3, 2), {0, 1e4, 0})), "far_from_origin", Severity::warning);
    CHECK(of_obstacle(shifted(make_sphere(0.3, 2), {0, 1e3, 0})).empty());
    CHECK(find(of_obstacle(scaled(make_sphere(0.3, 1), 1e80)), "size")->severity == Severity::warning);
    const auto beyond = of_obstacle(scaled(make_sphere(0.3, 1), 1e80));
    CHECK(std::any_of(beyond.begin(), beyond.end(), [](const Finding& one) { return one.severity == Severity::error; }));
}

TEST_CASE("for an obstacle without an inside the reason is reported") {
    const auto open = of_obstacle(open_ball());
    REQUIRE(open.size() == 1);
    CHECK(open[0].kind == "open_edges");
    CHECK(open[0].count == 3);
    CHECK(open[0].severity == Severity::note);
    check_only(of_obstacle(one_turned(make_sphere(0.3, 2), 5)), "contrary_edges", Severity::warning);
    check_only(of_obstacle(crowded_sheet()), "crowded_edges", Severity::warning);
    check_only(of_obstacle(turned(make_sphere(0.3, 2))), "inverted_parts", Severity::warning);
}

TEST_CASE("what cleaning leaves out of an obstacle is noted") {
    const TriangleMesh ball = make_sphere(0.3, 2);
    const std::vector<std::pair<std::string, TriangleMesh>> cases = {
        {"repeated_places", split_corners(ball)},
        {"flat_triangles", with_triangle(ball, {0, 1, 1})},
        {"repeated_triangles", with_triangle(ball, ball.triangles[3])},
        {"unused_vertices", with_vertex(ball, {0, 0, 0})},
        {"internal_triangles", both(ball, shifted(make_sphere(0.1, 2), {0.05, 0, 0}))},
    };
    for (const auto& [kind, mesh] : cases) {
        const auto found = of_obstacle(mesh);
        check_only(found, kind, Severity::note);
        for (const Finding& finding : found) CHECK(finding.severity == Severity::note);
    }
    check_only(of_obstacle({.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, .triangles = {{0, 1, 2}}}), "no_surface",
               Severity::error);
}

TEST_CASE("parts of an obstacle that cross are a note where it is closed, a warning where it is open") {
    const TriangleMesh ball = make_sphere(0.3, 2);
    const auto closed = of_obstacle(both(ball, shifted(ball, {0.21, 0.03, 0})));
    CHECK(find(closed, "self_crossing")->severity == Severity::note);
    CHECK(find(closed, "parts")->severity == Severity::note);
    CHECK(find(of_obstacle(crossed_sheets()), "self_crossing")->severity == Severity::warning);
    CHECK(find(of_obstacle(both(ball, shifted(ball, {0.7, 0, 0}))), "self_crossing") == nullptr);
}

TEST_CASE("parts of an obstacle that meet in a point are noted") {
    const TriangleMesh box = make_box({1, 1, 1});
    const auto found = of_obstacle(both(box, shifted(box, {1, 1, 1})));
    CHECK(find(found, "pinched_vertices")->count == 1);
    CHECK(find(found, "pinched_vertices")->severity == Severity::note);
}

TEST_CASE("a mesh too crowded to test for crossings is noted, not searched for ever") {
    TriangleMesh fan{.vertices = {{0, 0, 0}}, .triangles = {}};
    constexpr int count = 4000;
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * 3.14159265358979 * i / count;
        fan.vertices.emplace_back(std::cos(angle), 0.1, std::sin(angle));
        fan.triangles.push_back({0, i + 1, i + 2 > count ? 1 : i + 2});
    }
    CHECK(find(of_cloth(fan), "crossings_unknown") != nullptr);
    CHECK(find(of_cloth(free_sheet()), "crossings_unknown") == nullptr);
}

TEST_CASE("a cloth and an obstacle of different units, and cloth too coarse, are warned of") {
    const TriangleMesh sheet = free_sheet();
    const auto units = of_pair(sheet, scaled(make_sphere(0.3, 2), 100.0));
    check_only(units, "size_ratio", Severity::warning);
    CHECK(units[0].fix.find("\"cm\" for obstacle 'o'") != std::string::npos);
    CHECK(of_pair(scaled(sheet, 1000.0), make_sphere(0.3, 2))[0].fix.find("\"mm\" for it") != std::string::npos);
    check_only(of_pair(sheet, make_sphere(0.07, 1)), "coarse_cloth", Severity::warning);
    CHECK(of_pair(sheet, make_sphere(0.15, 2)).empty());
    const auto fine = of_pair(sheet, make_sphere(0.3, 6));
    REQUIRE(fine.size() == 1);
    CHECK(fine[0].severity == Severity::note);
}

}  // namespace percale::scenes::test::doctor_mesh_test
