#include "report/stroke_font.h"

#include "tests/support/catch.h"

namespace percale::scenes::test::stroke_font_test {
namespace {

/// How dark places of a letter are, on a grid of its capital: (0, 0) upper left, (4, 6) lower right of a digit.
class Letter {
public:
    explicit Letter(const std::string& text) : image_(200, 200) { draw_text(image_, text, {40.0, 140.0, 96.0, {0, 0, 0}}); }
    bool inked(double x, double y) const {
        return image_.at(static_cast<int>(40 + 16 * x), static_cast<int>(44 + 16 * y))[3] > 128;
    }
    const Image& image() const { return image_; }

private:
    Image image_;
};

}  // namespace

TEST_CASE("digits and letters have ink where their shapes have it, and holes where they are hollow") {
    const Letter zero("0"), eight("8"), one("1"), seven("7"), capital_l("L"), t("T"), h("H"), x("x"), g("g"), comma(",");
    CHECK_FALSE(zero.inked(2, 3));
    CHECK(eight.inked(2, 3));
    for (const Letter* letter : {&zero, &eight}) {
        CHECK(letter->inked(2, 0));
        CHECK(letter->inked(2, 6));
        CHECK_FALSE(letter->inked(0, 0));  // round
    }
    CHECK(one.inked(2, 3));
    CHECK_FALSE(one.inked(0, 4));
    CHECK((seven.inked(0, 0) && seven.inked(4, 0) && seven.inked(1, 6) && !seven.inked(4, 6)));
    CHECK((capital_l.inked(0, 0) && capital_l.inked(0, 6) && capital_l.inked(3, 6) && !capital_l.inked(3, 0)));
    CHECK((t.inked(0, 0) && t.inked(4, 0) && t.inked(2, 6) && !t.inked(0, 6)));
    CHECK((h.inked(0, 0) && h.inked(4, 6) && h.inked(2, 3) && !h.inked(2, 0)));
    CHECK((x.inked(0, 2) && x.inked(4, 6) && x.inked(2, 4) && !x.inked(2, 0)));
    CHECK((g.inked(4, 7) && g.inked(2, 8) && !g.inked(0, 0)));
    CHECK((comma.inked(1, 6) && !comma.inked(1, 5)));
}

TEST_CASE("all printable characters are different, and blank is blank") {
    std::vector<std::vector<std::uint8_t>> drawn;
    for (char letter = ' '; letter <= '~'; ++letter) drawn.push_back(Letter(std::string(1, letter)).image().rgba);
    for (std::size_t a = 0; a < drawn.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
            CAPTURE(a, b);
            CHECK((drawn[a] != drawn[b]));
        }
    CHECK((drawn[0] == Image(200, 200).rgba));
}

TEST_CASE("a text is as wide as it says, at any size, and letters of other alphabets are one box each") {
    CHECK(text_width("", 12.0) == 0.0);
    CHECK(text_width("0.50 s", 24.0) == Approx(2.0 * text_width("0.50 s", 12.0)));
    CHECK(text_width("\xc3\xa4", 12.0) == text_width("\x7f", 12.0));
    Image image(300, 60);
    draw_text(image, "strain [%]", {10.0, 40.0, 20.0, {0, 0, 0}});
    int left = 300, right = 0;
    for (int row = 0; row < 60; ++row)
        for (int column = 0; column < 300; ++column)
            if (image.at(column, row)[3] > 100) left = std::min(left, column), right = std::max(right, column);
    CHECK(left == Approx(10.0).margin(3.0));
    CHECK(right == Approx(10.0 + text_width("strain [%]", 20.0)).margin(3.0));
}

TEST_CASE("text beyond an image is cut off") {
    Image image(20, 10);
    draw_text(image, "far too long", {-30.0, 5.0, 40.0, {0, 0, 0}});
    CHECK((image.rgba.size() == 800));
}

}  // namespace percale::scenes::test::stroke_font_test
