#pragma once

#include "picture/picture_field.h"
#include "report/image.h"

namespace percale::scenes {

/// How wide the strip for a bar is at the right of a picture of this height, pixels.
int colour_bar_width(int picture_height);

/// Draws bar, numbers, the field's name and unit into the right `colour_bar_width` pixels of a picture. Numbers at the ends have
/// a sign in front where values lie beyond: "< ", "> ".
void draw_colour_bar(Image& picture, const PictureField& field, const FieldRange& range);

/// The numbers beside the bar and where they stand, 0 below ... 1 above: multiples of the range's step within it; its ends where
/// values lie beyond them.
struct BarNumber {
    double share = 0.0;
    std::string text;
};
std::vector<BarNumber> bar_numbers(const FieldRange& range);

}  // namespace percale::scenes
