#pragma once

#include <string>

#include "report/image.h"

// Letters as strokes of a pen, of any size: what a picture says about itself.
namespace percale::scenes {

/// How tall a capital is, and how wide a text gets, pixels. ASCII; another character is a box.
double text_width(const std::string& text, double capital);

/// Where a text stands: its left end on the baseline, pixels from the upper left corner of the image.
struct TextPen {
    double x = 0.0, y = 0.0;
    double capital = 12.0;  // height of a capital, pixels, > 0
    Bytes3 colour = {40, 44, 52};
};

/// Draws the text over the image, antialiased; what lies outside is cut off.
void draw_text(Image& image, const std::string& text, const TextPen& pen);

}  // namespace percale::scenes
