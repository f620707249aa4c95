#include "picture/painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/nearest_name.h"
#include "percale/error.h"
#include "picture/light.h"

namespace percale::scenes {

namespace {

// Rays through a pixel at an edge.
constexpr int edge_rays = 16;
// In pixels: the maximum distance of points on one piece of surface from each other's plane.
constexpr float alike_pixels = 4.0f;
// In radii of all shapes: the maximum distance of a surface that hides the sky.
constexpr double sky_reach_share = 0.5;
// Width of edges of triangles, pixels, and how dark they are.
constexpr float wire_width = 0.9f, wire_darkness = 0.6f;
// Fraction of its radius from which on the ground fades out.
constexpr float ground_fade_start = 0.45f;

/// Light of a pixel, times how much of it is covered.
struct Covered {
    Colour light = Colour::Zero();
    float cover = 0.0f;
};

class FramePainter {
public:
    FramePainter(const ShownFrame& frame, const Camera& camera, const PaintSettings& settings)
        : camera_(camera),
          settings_(settings),
          surfaces_(frame.shapes, settings.ground),
          lights_(camera, sky_reach_share * surfaces_.radius()),
          points_(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height)),
          measured_(points_.size()),
          lit_(points_.size()) {}

    Image paint(Workers* workers) {
        Image image(camera_.width, camera_.height);
        each_row(workers, [&](int row) { look_at_row(row); });
        each_row(workers, [&](int row) { smooth_row(row); });
        each_row(workers, [&](int row) { paint_row(row, image); });
        return image;
    }

private:
    template <class Work>
    void each_row(Workers* workers, Work work) {
        auto part = [&](int row, int) { work(row); };
        run_parts(workers, camera_.height, part);
    }

    std::size_t number(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(camera_.width) + static_cast<std::size_t>(column);
    }
    bool inside(int column, int row) const { return column >= 0 && row >= 0 && column < camera_.width && row < camera_.height; }
    float reach(const SurfacePoint& point) const {
        return alike_pixels * static_cast<float>(camera_.pixel_size(static_cast<double>(point.depth)));
    }

    void look_at_row(int row);
    void smooth_row(int row);
    LightShare smoothed(int column, int row, int before, int behind, int* count) const;
    void paint_row(int row, Image& image) const;
    bool is_edge(int column, int row) const;
    LightShare light_near(const SurfacePoint& point, int column, int row) const;
    Covered pixel(int column, int row) const;
    Covered colour_of(const SurfacePoint& point, const Vec3& direction, const LightShare& share) const;
    Colour surface_colour(const SurfacePoint& point) const;
    float wire_cover(const SurfacePoint& point) const;
    float ground_strength(const SurfacePoint& point) const;

    const Camera& camera_;
    const PaintSettings& settings_;
    Surfaces surfaces_;
    Lights lights_;
    std::vector<SurfacePoint> points_;        // through the middle of each pixel
    std::vector<LightShare> measured_, lit_;  // by a part of the directions; by those of the pixels around, too
};

/// The sixteen pixels of a square of four by four take the sixteen parts of the directions.
void FramePainter::look_at_row(int row) {
    for (int column = 0; column < camera_.width; ++column) {
        SurfacePoint& point = points_[number(column, row)];
        point = surfaces_.look(camera_.eye, camera_.direction(column + 0.5, row + 0.5));
        if (point.shape == SurfacePoint::nothing) continue;
        measured_[number(column, row)] = lights_.measure(surfaces_, point, (column & 3) + 4 * (row & 3));
    }
}

/// The mean over pixels of the same piece of surface, `before` to the left and above, `behind` to the right and below.
LightShare FramePainter::smoothed(int column, int row, int before, int behind, int* count) const {
    const SurfacePoint& point = points_[number(column, row)];
    LightShare sum{0.0f, 0.0f};
    *count = 0;
    for (int r = row - before; r <= row + behind; ++r) {
        for (int c = column - before; c <= column + behind; ++c) {
            if (!inside(c, r) || !alike(point, points_[number(c, r)], reach(point))) continue;
            sum.sky += measured_[number(c, r)].sky;
            sum.key += measured_[number(c, r)].key;
            ++*count;
        }
    }
    const float share = 1.0f / static_cast<float>(*count);
    return {sum.sky * share, sum.key * share};
}

/// Any square of four by four pixels holds all parts. Where some lie on other surfaces, and for the wide shadows
/// on the ground, a larger one is taken.
void FramePainter::smooth_row(int row) {
    for (int column = 0; column < camera_.width; ++column) {
        const std::size_t k = number(column, row);
        if (points_[k].shape == SurfacePoint::nothing) continue;
        int count = 0;
        if (points_[k].is_shape()) lit_[k] = smoothed(column, row, 2, 1, &count);
        if (count < Lights::parts) lit_[k] = smoothed(column, row, 4, 3, &count);
        if (count < Lights::parts / 2) lit_[k] = lights_.measure(surfaces_, points_[k], Lights::all_parts);
    }
}

bool FramePainter::is_edge(int column, int row) const {
    const SurfacePoint& point = points_[number(column, row)];
    for (int r = row - 1; r <= row + 1; ++r) {
        for (int c = column - 1; c <= column + 1; ++c) {
            if (!inside(c, r)) continue;
            const SurfacePoint& other = points_[number(c, r)];
            if (point.shape < 0 && other.shape < 0) continue;
            if (!alike(point, other, reach(point))) return true;
        }
    }
    return false;
}

/// The light of the neighbouring pixel whose surface is most like the point's; it is measured where none is alike.
LightShare FramePainter::light_near(const SurfacePoint& point, int column, int row) const {
    float best = -1.0f;
    LightShare share;
    for (int r = row - 1; r <= row + 1; ++r) {
        for (int c = column - 1; c <= column + 1; ++c) {
            if (!inside(c, r)) continue;
            const SurfacePoint& other = points_[number(c, r)];
            const float likeness = point.normal.dot(other.normal);
            if (likeness <= best || !alike(point, other, reach(point))) continue;
            best = likeness;
            share = lit_[number(c, r)];
        }
    }
    return best >= 0.0f ? share : lights_.measure(surfaces_, point, Lights::all_parts);
}

Covered FramePainter::pixel(int column, int row) const {
    const std::size_t k = number(column, row);
    if (!is_edge(column, row)) return colour_of(points_[k], camera_.direction(column + 0.5, row + 0.5), lit_[k]);
    Covered sum;
    for (int ray = 0; ray < edge_rays; ++ray) {
        // A grid of four by four, sheared so that rays share neither rows nor columns.
        const double x = ((ray % 4) + (ray / 4 + 0.5) / 4.0) / 4.0, y = ((ray / 4) + (3 - ray % 4 + 0.5) / 4.0) / 4.0;
        const Vec3 direction = camera_.direction(column + x, row + y);
        const SurfacePoint point = surfaces_.look(camera_.eye, direction);
        if (point.shape == SurfacePoint::nothing) continue;
        const Covered one = colour_of(point, direction, light_near(point, column, row));
        sum.light += one.light / edge_rays;
        sum.cover += one.cover / edge_rays;
    }
    return sum;
}

Covered FramePainter::colour_of(const SurfacePoint& point, const Vec3& direction, const LightShare& share) const {
    if (point.shape == SurfacePoint::nothing) return {};
    if (point.shape == SurfacePoint::on_ground) return {Colour::Zero(), lights_.ground_shadow(share) * ground_strength(point)};
    const Colour light = lights_.shade(surface_colour(point), point, -direction.cast<float>(), share);
    return {(1.0f - wire_cover(point)) * light, 1.0f};
}

Colour FramePainter::surface_colour(const SurfacePoint& point) const {
    const ShownShape& shape = surfaces_.shapes()[static_cast<std::size_t>(point.shape)];
    if (settings_.range && !shape.field.empty()) {
        const Triangle& t = shape.mesh.triangles[static_cast<std::size_t>(point.triangle)];
        const auto value = [&](std::size_t k) { return shape.field[static_cast<std::size_t>(t[k])]; };
        const double mixed = (1.0f - point.u - point.v) * value(0) + point.u * value(1) + point.v * value(2);
        // A vertex without a value, such as one far from all bodies, is grey.
        if (std::isfinite(mixed)) return ramp_colour(settings_.range->share(mixed), settings_.range->diverging());
        return Colour::Constant(0.35f);
    }
    if (!shape.is_cloth || !point.back) return shape.colour;
    // The wrong side of cloth is paler.
    const float grey = shape.colour.mean();
    return 0.55f * shape.colour + Colour::Constant(0.25f * grey + 0.10f);
}

/// With weights w_i and heights h_i of a triangle, its edges are w_i h_i away.
float FramePainter::wire_cover(const SurfacePoint& point) const {
    if (!settings_.wire) return 0.0f;
    const TriangleMesh& mesh = surfaces_.shapes()[static_cast<std::size_t>(point.shape)].mesh;
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(point.triangle)];
    const auto corner = [&](std::size_t k) -> const Vec3& { return mesh.vertices[static_cast<std::size_t>(t[k % 3])]; };
    const double area2 = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    const double weights[] = {1.0 - static_cast<double>(point.u) - static_cast<double>(point.v), point.u, point.v};
    double nearest = 1e30;
    for (std::size_t k = 0; k < 3; ++k)
        nearest = std::min(nearest, weights[k] * area2 / std::max((corner(k + 2) - corner(k + 1)).norm(), 1e-30));
    const auto pixels = static_cast<float>(nearest / camera_.pixel_size(static_cast<double>(point.depth)));
    return wire_darkness * std::clamp(0.5f * wire_width + 0.5f - pixels, 0.0f, 1.0f);
}

float FramePainter::ground_strength(const SurfacePoint& point) const {
    const float off =
        (point.place - settings_.ground->middle.cast<float>()).norm() / static_cast<float>(settings_.ground->radius);
    const float t = std::clamp((1.0f - off) / (1.0f - ground_fade_start), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

void FramePainter::paint_row(int row, Image& image) const {
    const Colour behind = background_colour(settings_.background, (row + 0.5) / camera_.height);
    for (int column = 0; column < camera_.width; ++column) {
        const Covered covered = pixel(column, row);
        std::uint8_t* bytes = image.at(column, row);
        const bool transparent = settings_.background == Background::transparent;
        Colour light = covered.light + (1.0f - covered.cover) * behind;
        if (transparent) light = covered.cover > 0.0f ? Colour(covered.light / covered.cover) : Colour(Colour::Zero());
        const Bytes3 encoded = srgb_bytes(light);
        std::ranges::copy(encoded, bytes);
        bytes[3] = transparent ? static_cast<std::uint8_t>(std::lround(255.0f * std::min(covered.cover, 1.0f))) : 255;
    }
}

}  // namespace

Background background_of(const std::string& word) {
    static const std::vector<std::string> words = {"studio", "white", "transparent"};
    const auto found = std::ranges::find(words, word);
    if (found == words.end()) throw SceneError("no background '" + word + "'" + suggestion(word, words));
    return static_cast<Background>(found - words.begin());
}

Colour background_colour(Background background, double share) {
    if (background != Background::studio) return Colour::Ones();
    const Colour top(0.925f, 0.93f, 0.94f), bottom(0.72f, 0.74f, 0.77f);
    return top + static_cast<float>(share) * (bottom - top);
}

Image paint(const ShownFrame& frame, const Camera& camera, const PaintSettings& settings, Workers* workers) {
    return FramePainter(frame, camera, settings).paint(workers);
}

}  // namespace percale::scenes
