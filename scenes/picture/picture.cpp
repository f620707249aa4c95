#include "picture/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "common/text.h"
#include "common/whole_file.h"
#include "percale/error.h"
#include "picture/colour_bar.h"
#include "report/stroke_font.h"

namespace percale::scenes {

namespace {

// Pixels.
constexpr int min_side = 16, largest_side = 8192, max_pixels = 1 << 24, min_cell = 16;
// In diagonals of the box around cloth: the distance from it up to which bodies are fitted, too.
constexpr double near_cloth = 1.5;
// In radii of all that is fitted: how far the ground shows shadows.
constexpr double ground_radius_share = 3.2;
// The strip for a cell's label: fraction of the cell's height, minimum in pixels; and its capitals, as a fraction of the strip.
constexpr double label_share = 0.07, min_label = 14.0, label_capital = 0.5;

/// What all drawings of one source have in common.
struct Scenery {
    ViewFit fit;
    Eigen::AlignedBox3d fitted = {};
    double lowest = std::numeric_limits<double>::infinity();

    void add(const ShownFrame& frame) {
        const std::vector<Vec3> points = fitted_points(frame);
        fit.add(points);
        for (const Vec3& x : points) fitted.extend(x);
        for (const ShownShape& shape : frame.shapes)
            for (const Vec3& x : shape.mesh.vertices) lowest = std::min(lowest, x.y());
    }

    std::optional<Ground> ground() const {
        Vec3 middle = fitted.center();
        middle.y() = lowest;
        return Ground{lowest, middle, ground_radius_share * std::max(0.5 * fitted.diagonal().norm(), 1e-6)};
    }
};

/// Where drawings lie in a picture.
struct SheetLayout {
    int columns = 1, strip = 0;           // strip: for labels, below each cell
    int cell_width = 0, cell_height = 0;  // without strip
    int drawing_width = 0;                // of the cell and, where there is one column, of what is left of the bar's strip
    int gap = 0;
};

SheetLayout layout_of(const std::vector<PictureCell>& cells, const CellGrid& grid, const PictureStyle& style) {
    const bool has_labels = std::ranges::any_of(cells, [](const PictureCell& cell) { return !cell.label.empty(); });
    SheetLayout layout{grid.columns};
    layout.gap = grid.columns * grid.rows > 1 ? std::max(1, style.width / 600) : 0;
    const int bar = style.field != nullptr ? colour_bar_width(style.height) : 0;
    const int whole = (style.height - (grid.rows - 1) * layout.gap) / grid.rows;
    layout.strip = has_labels ? static_cast<int>(std::max(min_label, label_share * whole)) : 0;
    layout.cell_width = (style.width - bar - (grid.columns - 1) * layout.gap) / grid.columns;
    layout.cell_height = whole - layout.strip;
    layout.drawing_width = grid.columns == 1 ? style.width : layout.cell_width;
    if (layout.cell_width < min_cell || layout.cell_height < min_cell)
        throw SceneError("a picture of " + std::to_string(style.width) + "x" + std::to_string(style.height) +
                         " pixels has no room for " + std::to_string(grid.columns) + "x" + std::to_string(grid.rows) +
                         " drawings" + (bar > 0 ? " and a bar of colours" : ""));
    return layout;
}

Image empty_picture(int width, int height, Background background) {
    Image image(width, height);
    for (int row = 0; row < height && background != Background::transparent; ++row) {
        const Bytes3 colour = srgb_bytes(background_colour(background, (row + 0.5) / height));
        for (int column = 0; column < width; ++column) blend(image, column, row, colour, 1.0f);
    }
    return image;
}

PaintSettings paint_settings(const PictureStyle& style, const Scenery& scenery, const std::optional<FieldRange>& range) {
    PaintSettings settings{style.background, style.wire, {}, range};
    if (style.ground) settings.ground = scenery.ground();
    return settings;
}

std::optional<FieldRange> range_of(const PictureStyle& style, const FieldSpread& spread, const PictureNews& news) {
    if (style.field == nullptr) return {};
    const FieldRange range = style.range ? spread.range(style.range->first, style.range->second) : spread.range();
    if (news.range) news.range(range);
    return range;
}

void draw_label(Image& picture, const std::string& label, const SheetLayout& layout, int left, int top) {
    if (label.empty()) return;
    TextPen pen;
    pen.capital = label_capital * layout.strip;
    const double room = 0.94 * layout.cell_width, width = text_width(label, pen.capital);
    if (width > room) pen.capital *= room / width;
    pen.x = left + 0.5 * (layout.cell_width - text_width(label, pen.capital));
    pen.y = top + layout.cell_height + 0.5 * (layout.strip + pen.capital) - 1.0;
    draw_text(picture, label, pen);
}

std::string movie_file(const std::string& folder, int number) {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%05d.png", number);
    return (std::filesystem::path(folder) / name).string();
}

/// Files that go again unless all are there.
struct WrittenFiles {
    std::vector<std::string> files;

    ~WrittenFiles() {
        for (const std::string& file : files) std::remove(file.c_str());
    }
};

}  // namespace

void check_picture_size(int width, int height) {
    const bool fits = width >= min_side && height >= min_side && width <= largest_side && height <= largest_side;
    if (!fits || width > max_pixels / height)
        throw SceneError("a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                         " pixels: each side must be in " + std::to_string(min_side) + " ... " + std::to_string(largest_side) +
                         ", and all at most " + std::to_string(max_pixels));
}

CellGrid grid_for(int cells, int width, int height) {
    CellGrid best;
    int largest = -1;
    for (int columns = 1; columns <= cells; ++columns) {
        const int rows = (cells + columns - 1) / columns, side = std::min(width / columns, height / rows);
        if (side <= largest) continue;
        largest = side;
        best = {columns, rows};
    }
    return best;
}

std::vector<Vec3> fitted_points(const ShownFrame& frame) {
    std::vector<Vec3> points;
    Eigen::AlignedBox3d cloth;
    for (const ShownShape& shape : frame.shapes) {
        if (!shape.is_cloth) continue;
        points.insert(points.end(), shape.mesh.vertices.begin(), shape.mesh.vertices.end());
        for (const Vec3& x : shape.mesh.vertices) cloth.extend(x);
    }
    const bool has_cloth = !points.empty();
    const Vec3 around = has_cloth ? Vec3(Vec3::Constant(near_cloth * cloth.diagonal().norm())) : Vec3(Vec3::Zero());
    const Eigen::AlignedBox3d near(cloth.min() - around, cloth.max() + around);
    for (const ShownShape& shape : frame.shapes) {
        if (shape.is_cloth) continue;
        std::ranges::copy_if(shape.mesh.vertices, std::back_inserter(points),
                             [&](const Vec3& x) { return !has_cloth || near.contains(x); });
    }
    return points;
}

Image draw_picture(const std::vector<PictureCell>& cells, const CellGrid& grid, const PictureStyle& style, Workers* workers,
                   const PictureNews& news) {
    check_picture_size(style.width, style.height);
    if (cells.size() > static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows))
        throw SceneError(counted(static_cast<long>(cells.size()), "frame") + " do not fit a sheet of " +
                         std::to_string(grid.columns) + "x" + std::to_string(grid.rows));
    const SheetLayout layout = layout_of(cells, grid, style);
    std::map<FrameSource*, Scenery> sceneries;
    FieldSpread spread;
    for (const PictureCell& cell : cells) {
        const ShownFrame frame = cell.source->load(cell.frame);
        const Scenery empty{ViewFit(style.aim, layout.cell_width, layout.cell_height)};
        sceneries.try_emplace(cell.source, empty).first->second.add(frame);
        spread.add(frame);
    }
    const std::optional<FieldRange> range = range_of(style, spread, news);
    Image picture = empty_picture(style.width, style.height, style.background);
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const Scenery& scenery = sceneries.at(cells[k].source);
        const int column = static_cast<int>(k) % layout.columns, row = static_cast<int>(k) / layout.columns;
        const int left = column * (layout.cell_width + layout.gap);
        const int top = row * (layout.cell_height + layout.strip + layout.gap);
        const Image drawing = paint(cells[k].source->load(cells[k].frame), scenery.fit.camera_of_wider(layout.drawing_width),
                                    paint_settings(style, scenery, range), workers);
        paste(picture, drawing, left, top);
        draw_label(picture, cells[k].label, layout, left, top);
    }
    if (range) draw_colour_bar(picture, *style.field, *range);
    return picture;
}

void write_movie(const std::string& folder, FrameSource& source, const std::vector<int>& frames, const PictureStyle& style,
                 Workers* workers, const PictureNews& news) {
    check_picture_size(style.width, style.height);
    const SheetLayout layout = layout_of({}, {}, style);
    Scenery scenery{ViewFit(style.aim, layout.cell_width, layout.cell_height)};
    FieldSpread spread;
    for (const int number : frames) {
        const ShownFrame frame = source.load(number);
        scenery.add(frame);
        spread.add(frame);
    }
    const std::optional<FieldRange> range = range_of(style, spread, news);
    const OutputFolder made(folder);
    WrittenFiles written;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        const Image drawing = paint(source.load(frames[k]), scenery.fit.camera_of_wider(layout.drawing_width),
                                    paint_settings(style, scenery, range), workers);
        Image picture = empty_picture(style.width, style.height, style.background);
        paste(picture, drawing, 0, 0);
        if (range) draw_colour_bar(picture, *style.field, *range);
        const std::string file = movie_file(folder, static_cast<int>(k));
        write_png(file, picture);
        written.files.push_back(file);
        if (news.done) news.done(static_cast<int>(k) + 1);
    }
    written.files.clear();
}

}  // namespace percale::scenes
