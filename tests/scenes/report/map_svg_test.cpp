#include "scenes/report/map_svg.h"

#include "tests/support/catch.h"

namespace percale::scenes::test::map_svg_test {

namespace {

int count(const std::string& text, const std::string& part) {
    int found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

ColourMap two_by_two() {
    MapPanel panel{.name = "a & b", .cells = {}, .limit = {{1e-3, 10.0}, {1e-2, 1.0}, {1e5, 1.0}}};
    for (const double x : {1e-3, 1e-2})
        for (const double y : {1.0, 10.0}) panel.cells.push_back({x, y, y > 1.0 ? 1 : 0, "cell"});
    return {.title = "map",
            .x_label = "x, s",
            .y_label = "y, m",
            .legend = {{"#111111", "low"}, {"#222222", "high"}},
            .limit_name = "limit",
            .panels = {panel, panel, panel, panel}};
}

}  // namespace

TEST_CASE("A map has all cells in their colours, names, labels and a line within each panel") {
    const std::string text = map_svg(two_by_two());
    CHECK(count(text, "<title>cell</title>") == 16);
    CHECK(count(text, "fill=\"#111111\"") == 9);  // and the legend
    CHECK(count(text, "fill=\"#222222\"") == 9);
    CHECK(count(text, "a &amp; b") == 4);
    CHECK(count(text, "<polyline") == 4);
    CHECK(count(text, "x, s") == 1);
    CHECK(text.rfind("</svg>\n") == text.size() - 7);
}

TEST_CASE("Cells of a panel fill it without gaps or overlaps") {
    const std::string text = map_svg(two_by_two());
    // Two columns of 125 pixels and two rows of 115 in a panel of 250 x 230 whose corner is at (70, 82).
    for (const char* place :
         {"x=\"70.0\" y=\"82.0\" width=\"125.0\" height=\"115.0\"", "x=\"195.0\" y=\"197.0\" width=\"125.0\" height=\"115.0\""})
        CHECK(count(text, place) == 1);
}

TEST_CASE("A map without panels is a document, too") {
    ColourMap empty = two_by_two();
    empty.panels.clear();
    CHECK(map_svg(empty).rfind("</svg>\n") != std::string::npos);
}

}  // namespace percale::scenes::test::map_svg_test
