#include "scenes/report/svg_text.h"

#include "tests/support/catch.h"

namespace percale::scenes::test::svg_text_test {

TEST_CASE("Text in a picture cannot break its markup") {
    CHECK(svg_escaped("a < b & c > \"d\"\x01") == "a &lt; b &amp; c &gt; &quot;d&quot;?");
    CHECK(svg_text(1.0, 2.0, "middle", "<x>") == "<text x=\"1.0\" y=\"2.0\" text-anchor=\"middle\">&lt;x&gt;</text>\n");
    CHECK(svg_opening(10.0, 20.0, "<t>").find("<title>&lt;t&gt;</title>") != std::string::npos);
}

TEST_CASE("Lines have their ends in pixels with one digit") {
    CHECK(svg_line(0.0, 1.25, 2.0, 3.0, "stroke=\"red\"") ==
          "<line x1=\"0.0\" y1=\"1.2\" x2=\"2.0\" y2=\"3.0\" stroke=\"red\"/>\n");
}

}  // namespace percale::scenes::test::svg_text_test
