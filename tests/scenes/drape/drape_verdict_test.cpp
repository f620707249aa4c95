#include "scenes/drape/drape_verdict.h"

#include <algorithm>
#include <fstream>

#include "scenes/meshes/obj_file.h"
#include "tests/scenes/test_folder.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::drape_verdict_test {
namespace {

/// A wide ring of two panels around a thin post on a foot.
DrapeOptions ring_around_post(const TestFolder& folder, double half_width) {
    const std::string w = std::to_string(half_width);
    const std::string strip = "points = [[-" + w + ", 60], [" + w + ", 60], [" + w + ", 70], [-" + w + ", 70]]\n";
    folder.write("ring.toml", "unit = \"cm\"\n[[panel]]\nname = \"a\"\n" + strip + "at = [0, 0, 8]\n[[panel]]\nname = \"b\"\n" +
                                  strip + "at = [0, 0, -8]\nturn = [0, 180, 0]\n[[seam]]\nname = \"left\"\n" +
                                  "sides = [[\"a.1\"], [\"b.3\"]]\n[[seam]]\nname = \"right\"\nsides = [[\"a.3\"], [\"b.1\"]]\n");
    const TriangleMesh post = make_box(Vec3(0.1, 2.0, 0.1));
    write_obj(folder.path("post.obj"), post.vertices, post.triangles);
    DrapeOptions options;
    options.files = {folder.path("ring.toml"), folder.path("post.obj")};
    options.outs = {folder.path("out.obj")};
    options.seconds = 1.35;
    return options;
}

/// The line of the first finding of a kind; "" where there is none.
std::string find(const DrapeVerdict& verdict, const std::string& kind) {
    const auto found = std::ranges::find(verdict.findings, kind, &Finding::kind);
    return found == verdict.findings.end() ? "" : finding_line(*found);
}

}  // namespace

TEST_CASE("a garment that is stretched by a quarter and more is said to be tight, one that would have torn to have torn") {
    const TestFolder folder;
    const DrapeOptions options = ring_around_post(folder, 9.0);
    BuiltScene built = build_scene(drape_scene(options).scene);
    const Drape drape = settle(built, options, [](double) { return false; });
    const std::span<const Vec3> end = built.simulation.positions(built.cloths[0]);
    const std::vector<Vec3> draped(end.begin(), end.end());
    const double draped_strain = built.simulation.largest_strain();
    const auto verdict = [&](double strain) {
        std::vector<Vec3> x = draped;
        for (Vec3& place : x) place *= (1.0 + strain) / (1.0 + draped_strain);
        built.simulation.set_positions(built.cloths[0], x);
        return verdict_of(built, options, drape, {});
    };
    CHECK(find(verdict(0.2), "tight").empty());
    const std::string tight = find(verdict(0.3), "tight");
    CHECK(tight.starts_with("warning: 'ring' is stretched by "));
    CHECK(tight.ends_with(": it may be too small for the body; --scale makes it larger"));
    const DrapeVerdict torn = verdict(1.5);
    CHECK(find(torn, "tight").empty());
    CHECK(torn.findings.at(1).kind == "torn");
}

TEST_CASE("a garment that slides down is reported, one that holds is not") {
    const TestFolder folder;
    for (const double half_width : {14.0, 9.0}) {
        const DrapeOptions options = ring_around_post(folder, half_width);
        BuiltScene built = build_scene(drape_scene(options).scene);
        const Drape drape = settle(built, options, [](double) { return false; });
        const DrapeVerdict verdict = verdict_of(built, options, drape, write_draped(built, options, false));
        CAPTURE(half_width, finding_texts(verdict.findings), verdict.wrong);
        CHECK(find(verdict, "slid").empty() == (half_width < 10.0));
        CHECK(find(verdict, "sewn").find(" stitches, largest gap ") != std::string::npos);
        CHECK(widest_gap(built).stitches > 0);
    }
}

TEST_CASE(
    "draped meshes are written with the axes of the files, and what crosses is said to be the body's where garments do not "
    "meet") {
    const TestFolder folder;
    DrapeOptions options = ring_around_post(folder, 9.0);
    options.seconds = 1.05;
    options.no_self_contact = true;
    BuiltScene built = build_scene(drape_scene(options).scene);
    const Drape drape = settle(built, options, [](double) { return false; });
    const DrapeVerdict verdict = verdict_of(built, options, drape, write_draped(built, options, true));
    CAPTURE(finding_texts(verdict.findings));
    CHECK(find(verdict, "draped").find(" 0 intersecting pairs with the body, ") != std::string::npos);
    CHECK(verdict.wrong.find("not at rest when the time was up") != std::string::npos);
    CHECK(verdict.wrong.find("--seconds gives it longer") != std::string::npos);
    std::ifstream in(folder.path("out.obj"));
    const TriangleMesh written = read_obj(in, "out.obj");
    const std::span<const Vec3> now = built.simulation.positions(built.cloths[0]);
    for (std::size_t i = 0; i < now.size(); ++i) {
        CHECK((written.vertices[i] - Vec3(now[i].x(), -now[i].z(), now[i].y())).norm() < 1e-6);
    }
}

}  // namespace percale::scenes::test::drape_verdict_test
