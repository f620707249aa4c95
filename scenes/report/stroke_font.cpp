#include "report/stroke_font.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace percale::scenes {

namespace {

/// Strokes of ' ' ... '~': points are two digits, x to the right and y downwards; a capital goes from y = 0 to the baseline y =
/// 6, small letters begin at y = 2 and hang down to y = 8. A slash ends a stroke.
constexpr std::array<std::string_view, 95> glyph_strokes = {
    "",                                                    // space
    "00 04/06 06",                                         // !
    "00 01/20 21",                                         // "
    "10 06/30 26/02 42/04 44",                             // #
    "41 30 10 01 02 13 33 44 45 36 16 05/20 26",           // $
    "40 06/00 10 11 01 00/35 45 46 36 35",                 // %
    "46 11 10 20 21 04 05 16 26 44",                       // &
    "00 01",                                               // '
    "10 02 04 16",                                         // (
    "00 12 14 06",                                         // )
    "21 25/02 44/42 04",                                   // *
    "04 44/22 26",                                         // +
    "16 07",                                               // ,
    "04 34",                                               // -
    "06 06",                                               // .
    "06 30",                                               // /
    "10 30 41 45 36 16 05 01 10",                          // 0
    "01 20 26",                                            // 1
    "01 10 30 41 42 06 46",                                // 2
    "01 10 30 41 42 33 13/33 44 45 36 16 05",              // 3
    "36 30 04 44",                                         // 4
    "40 00 02 32 43 45 36 16 05",                          // 5
    "41 30 10 01 05 16 36 45 44 33 13 04",                 // 6
    "00 40 16",                                            // 7
    "10 30 41 42 33 13 02 01 10/13 04 05 16 36 45 44 33",  // 8
    "05 16 36 45 41 30 10 01 02 13 33 42",                 // 9
    "02 02/06 06",                                         // :
    "12 12/16 07",                                         // ;
    "42 04 46",                                            // <
    "03 43/05 45",                                         // =
    "02 44 06",                                            // >
    "01 10 30 41 42 23 24/26 26",                          // ?
    "44 33 13 14 34 45 41 30 10 01 05 16 36",              // @
    "06 20 46/14 34",                                      // A
    "06 00 30 41 42 33 03/33 44 45 36 06",                 // B
    "41 30 10 01 05 16 36 45",                             // C
    "00 06 26 44 42 20 00",                                // D
    "40 00 06 46/03 33",                                   // E
    "40 00 06/03 33",                                      // F
    "41 30 10 01 05 16 36 45 43 23",                       // G
    "00 06/40 46/03 43",                                   // H
    "00 06",                                               // I
    "30 35 26 16 05",                                      // J
    "00 06/40 03 46",                                      // K
    "00 06 36",                                            // L
    "06 00 24 40 46",                                      // M
    "06 00 46 40",                                         // N
    "10 40 51 55 46 16 05 01 10",                          // O
    "06 00 30 41 42 33 03",                                // P
    "10 40 51 55 46 16 05 01 10/34 57",                    // Q
    "06 00 30 41 42 33 03/23 46",                          // R
    "41 30 10 01 02 13 33 44 45 36 16 05",                 // S
    "00 40/20 26",                                         // T
    "00 05 16 36 45 40",                                   // U
    "00 26 40",                                            // V
    "00 16 30 46 60",                                      // W
    "00 46/40 06",                                         // X
    "00 23 40/23 26",                                      // Y
    "00 40 06 46",                                         // Z
    "10 00 06 16",                                         // [
    "00 36",                                               // backslash
    "00 10 16 06",                                         // ]
    "02 20 42",                                            // ^
    "07 47",                                               // _
    "00 11",                                               // `
    "12 32 43 46/44 14 05 16 36 45",                       // a
    "00 06/03 12 32 43 45 36 16 05",                       // b
    "43 32 12 03 05 16 36 45",                             // c
    "40 46/43 32 12 03 05 16 36 45",                       // d
    "04 44 43 32 12 03 05 16 36 45",                       // e
    "30 20 11 16/02 32",                                   // f
    "42 47 38 18 07/43 32 12 03 05 16 36 45",              // g
    "00 06/03 12 32 43 46",                                // h
    "02 06/00 00",                                         // i
    "12 17 08/10 10",                                      // j
    "00 06/32 04 36",                                      // k
    "00 05 16",                                            // l
    "02 06/03 12 22 33 36/33 42 52 63 66",                 // m
    "02 06/03 12 32 43 46",                                // n
    "12 32 43 45 36 16 05 03 12",                          // o
    "02 08/03 12 32 43 45 36 16 05",                       // p
    "42 48/43 32 12 03 05 16 36 45",                       // q
    "02 06/03 12 32",                                      // r
    "42 12 03 14 34 45 36 06",                             // s
    "10 15 26 36/02 32",                                   // t
    "02 05 16 36 45/42 46",                                // u
    "02 26 42",                                            // v
    "02 16 32 46 62",                                      // w
    "02 46/42 06",                                         // x
    "02 26/42 18 08",                                      // y
    "02 42 06 46",                                         // z
    "20 11 12 03 14 15 26",                                // {
    "00 07",                                               // |
    "00 11 12 23 14 15 06",                                // }
    "04 13 34 43",                                         // ~
};
constexpr std::string_view glyph_box = "00 40 46 06 00";

// In units of the grid: between glyphs, of a space, and of the pen.
constexpr double glyph_gap = 1.7, space_width = 2.2, pen_radius = 0.42, grid_capital = 6.0;

struct PenStroke {
    double x1 = 0.0, y1 = 0.0, x2 = 0.0, y2 = 0.0;
};

/// The strokes of a character, each a line between two points; gives its width.
double add_glyph(std::string_view strokes, double start, std::vector<PenStroke>& lines) {
    double width = 0.0, x = 0.0, y = 0.0;
    bool goes_on = false;
    for (std::size_t k = 0; k + 1 < strokes.size(); k += 3) {
        const double next_x = strokes[k] - '0', next_y = strokes[k + 1] - '0';
        if (goes_on) lines.push_back({start + x, y, start + next_x, next_y});
        x = next_x;
        y = next_y;
        width = std::max(width, x);
        goes_on = k + 2 < strokes.size() && strokes[k + 2] == ' ';
    }
    return width;
}

/// All strokes of a text in units of the grid; gives its width.
double add_strokes(const std::string& text, std::vector<PenStroke>& lines) {
    double start = 0.0, end = 0.0;
    for (const char letter : text) {
        const auto code = static_cast<unsigned char>(letter);
        if ((code & 0xc0u) == 0x80u) continue;  // goes on with a character of UTF-8
        const bool known = code >= ' ' && code <= '~';
        const double width = add_glyph(known ? glyph_strokes[code - std::size_t{' '}] : glyph_box, start, lines);
        end = start + (letter == ' ' ? space_width : width);
        start = end + (letter == ' ' ? 0.0 : glyph_gap);
    }
    return end;
}

double distance_to(const PenStroke& line, double x, double y) {
    const double dx = line.x2 - line.x1, dy = line.y2 - line.y1, square = dx * dx + dy * dy;
    const double share = square > 0.0 ? std::clamp(((x - line.x1) * dx + (y - line.y1) * dy) / square, 0.0, 1.0) : 0.0;
    return std::hypot(x - line.x1 - share * dx, y - line.y1 - share * dy);
}

}  // namespace

double text_width(const std::string& text, double capital) {
    std::vector<PenStroke> lines;
    return add_strokes(text, lines) * capital / grid_capital;
}

void draw_text(Image& image, const std::string& text, const TextPen& pen) {
    std::vector<PenStroke> lines;
    const double unit = pen.capital / grid_capital, radius = std::max(pen_radius * unit, 0.5);
    const double width = add_strokes(text, lines) * unit;
    const int reach = static_cast<int>(std::ceil(radius)) + 1, start = static_cast<int>(std::floor(pen.x)) - reach,
              first_row = static_cast<int>(std::floor(pen.y - pen.capital)) - reach;
    const int end = static_cast<int>(std::ceil(pen.x + width)) + reach,
              last_row = static_cast<int>(std::ceil(pen.y + 2.0 * unit)) + reach;
    for (int row = std::max(first_row, 0); row < std::min(last_row, image.height); ++row) {
        for (int column = std::max(start, 0); column < std::min(end, image.width); ++column) {
            const double x = (column + 0.5 - pen.x) / unit, y = (row + 0.5 - pen.y) / unit + grid_capital;
            double nearest = 1e30;
            for (const PenStroke& line : lines) nearest = std::min(nearest, distance_to(line, x, y));
            blend(image, column, row, pen.colour, static_cast<float>(std::clamp(radius + 0.5 - nearest * unit, 0.0, 1.0)));
        }
    }
}

}  // namespace percale::scenes
