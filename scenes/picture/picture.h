#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "picture/frame_source.h"
#include "picture/painter.h"

namespace percale::scenes {

/// How pictures look.
struct PictureStyle {
    int width = 1200, height = 900;  // pixels of the whole picture
    CameraAim aim = {};
    Background background = Background::studio;
    bool ground = true, wire = false;
    const PictureField* field = nullptr;                  // the one that the sources have
    std::optional<std::pair<double, double>> range = {};  // of its colours; none: what is shown decides
};

/// One drawing of a picture.
struct PictureCell {
    FrameSource* source = nullptr;
    int frame = 0;
    std::string label = {};
};

/// Cells lie side by side, row by row from the top.
struct CellGrid {
    int columns = 1, rows = 1;
};

/// Throws SceneError for a size outside 16 ... 8192 pixels or of more than 2^24 in all.
void check_picture_size(int width, int height);

/// The grid in which n cells get largest in a picture.
CellGrid grid_for(int cells, int width, int height);

/// The points that the camera is fitted to: all cloth, and bodies as far as they are near it; all bodies where there is no cloth.
std::vector<Vec3> fitted_points(const ShownFrame& frame);

/// Is called while pictures are made; each may be empty.
struct PictureNews {
    std::function<void(const FieldRange&)> range = {};  // of the field, before the first is drawn
    std::function<void(int)> done = {};                 // how many pictures of a movie are written
};

/// One picture of one frame, or a contact sheet of several cells, each with its label below. The cells of one source have the
/// same camera, all the same colours for values. Throws SceneError for more cells than the grid has, or no room for them.
Image draw_picture(const std::vector<PictureCell>& cells, const CellGrid& grid, const PictureStyle& style, Workers* workers,
                   const PictureNews& news = {});

/// Pictures FOLDER/frame_00000.png, ... of these frames of one source, with one camera and one range. Where one cannot be made or
/// written those before it go again, too.
void write_movie(const std::string& folder, FrameSource& source, const std::vector<int>& frames, const PictureStyle& style,
                 Workers* workers, const PictureNews& news = {});

}  // namespace percale::scenes
