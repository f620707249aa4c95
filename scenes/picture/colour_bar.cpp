#include "picture/colour_bar.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/text.h"
#include "report/stroke_font.h"

namespace percale::scenes {

namespace {

// Fractions of the picture's height: capitals, the strip, and the bar in it.
constexpr double capital_share = 0.0135, strip_share = 0.135, bar_top = 0.26, bar_bottom = 0.76, bar_share = 0.022;
constexpr double min_capital = 6.0;
// In steps: the minimum distance between two numbers.
constexpr double nearest_numbers = 0.45;

double bar_capital(int height) { return std::max(min_capital, capital_share * height); }

}  // namespace

int colour_bar_width(int picture_height) {
    return static_cast<int>(std::ceil(std::max(strip_share * picture_height, 10.0 * min_capital)));
}

std::vector<BarNumber> bar_numbers(const FieldRange& range) {
    const double slack = 1e-9 * range.step, near_end = nearest_numbers * range.step;
    const auto on_step = [&](double value) { return std::abs(value - range.step * std::round(value / range.step)) < slack; };
    std::vector<BarNumber> numbers;
    if (range.some_below)
        numbers.push_back({0.0, "< " + (on_step(range.low) ? multiple_text(range.low, range.step) : number_text(range.low))});
    const double from = range.low + (range.some_below ? near_end : -slack),
                 to = range.high - (range.some_above ? near_end : -slack);
    for (double k = std::ceil(from / range.step); k * range.step <= to; ++k)
        numbers.push_back({range.share(k * range.step), multiple_text(k * range.step, range.step)});
    if (range.some_above)
        numbers.push_back({1.0, "> " + (on_step(range.high) ? multiple_text(range.high, range.step) : number_text(range.high))});
    return numbers;
}

void draw_colour_bar(Image& picture, const PictureField& field, const FieldRange& range) {
    const double capital = bar_capital(picture.height);
    const int left = picture.width - colour_bar_width(picture.height), width = static_cast<int>(bar_share * picture.height) + 2;
    const int top = static_cast<int>(bar_top * picture.height), bottom = static_cast<int>(bar_bottom * picture.height);
    for (int row = top; row < bottom; ++row) {
        const Bytes3 colour = srgb_bytes(ramp_colour((bottom - row - 0.5) / (bottom - top), range.diverging()));
        for (int column = left; column < left + width; ++column) blend(picture, column, row, colour, 1.0f);
    }
    TextPen pen;
    pen.capital = capital;
    for (const BarNumber& number : bar_numbers(range)) {
        const double y = bottom - number.share * (bottom - top);
        const int row = std::clamp(static_cast<int>(std::lround(y - 0.5)), top, bottom - 1);
        for (int k = 0; k < width / 3; ++k) blend(picture, left + width + k, row, pen.colour, 0.8f);
        pen.x = left + width + 0.6 * width;
        pen.y = y + 0.5 * capital;
        draw_text(picture, number.text, pen);
    }
    // A line for each word of the name and one for the unit, so that they fit the strip.
    std::string words = field.word;
    std::ranges::replace(words, '_', ' ');
    std::istringstream lines(words + " [" + field.unit + "]");
    const auto count = std::ranges::count(words, ' ') + 2;
    pen.x = left;
    pen.y = top - 1.6 * capital - 1.9 * capital * static_cast<double>(count - 1);
    for (std::string line; lines >> line; pen.y += 1.9 * capital) draw_text(picture, line, pen);
}

}  // namespace percale::scenes
