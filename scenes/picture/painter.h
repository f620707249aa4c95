#pragma once

#include <optional>

#include "percale/workers.h"
#include "picture/camera.h"
#include "picture/picture_field.h"
#include "picture/surfaces.h"
#include "report/image.h"

namespace percale::scenes {

enum class Background { studio, white, transparent };

/// Throws SceneError, with the nearest name, for a word that is none.
Background background_of(const std::string& word);

/// The light behind everything, at a fraction `share`, 0 ... 1, of the picture's height from its top; white where it is
/// transparent.
Colour background_colour(Background background, double share);

struct PaintSettings {
    Background background = Background::studio;
    bool wire = false;                     // edges of triangles are drawn
    std::optional<Ground> ground = {};     // catches shadows; none: there is no ground
    std::optional<FieldRange> range = {};  // of the field that shapes have
};

/// Draws a frame. Same input, same bytes, for any number of threads. Throws SceneError where this build has no pictures.
Image paint(const ShownFrame& frame, const Camera& camera, const PaintSettings& settings, Workers* workers);

}  // namespace percale::scenes
