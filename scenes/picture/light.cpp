#include "picture/light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace percale::scenes {

namespace {

// Directions to the lamp and to the sky in each part.
constexpr int lamp_rays = 8, sky_rays = 6;
// Radius of the lamp seen from the picture, as a tangent. Larger: softer shadows.
constexpr double lamp_radius = 0.11;
// Brightness: lamp, sky straight above and below, from the viewer, sheen of what is seen at a grazing angle.
constexpr float lamp_light = 0.88f, sky_above = 0.34f, sky_below = 0.20f, eye_light = 0.07f, sheen_light = 0.05f;
// The fraction of the sky's light that reaches the deepest fold.
constexpr float hidden_light = 0.10f;
// Above this value brightness is compressed so that it never exceeds 1.
constexpr float bright_shoulder = 0.8f;
// The fraction of the light that a shadow on the ground takes away.
constexpr float ground_darkness = 0.75f;

/// The digits of k to base 2 behind the point, in reverse (van der Corput).
double mirrored_digits(std::uint32_t k) {
    double value = 0.0, digit = 0.5;
    for (; k != 0; k >>= 1, digit *= 0.5) value += (k & 1u) != 0 ? digit : 0.0;
    return value;
}

/// Even over the disc of radius 1: Hammersley's points on a square, by Shirley and Chiu's map of equal areas.
std::vector<Eigen::Vector2d> disc_points(int count) {
    std::vector<Eigen::Vector2d> points;
    for (int k = 0; k < count; ++k) {
        const double a = 2.0 * (k + 0.5) / count - 1.0;
        const double b = 2.0 * mirrored_digits(static_cast<std::uint32_t>(k)) + 1.0 / count - 1.0;
        const bool steep = std::abs(b) > std::abs(a);
        const double radius = steep ? b : a;
        const double angle = std::numbers::pi / 4.0 * (steep ? 2.0 - a / b : (a == 0.0 ? 0.0 : b / a));
        points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return points;
}

/// Two directions perpendicular to a third one and to each other; they turn evenly with it except where it points along -z.
std::array<Vec3, 2> across(const Vec3& n) {
    const double sign = n.z() < 0.0 ? -1.0 : 1.0, a = -1.0 / (sign + n.z()), b = n.x() * n.y() * a;
    return {Vec3(1.0 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()), Vec3(b, sign + n.y() * n.y() * a, -n.y())};
}

float bent(float light) {
    if (light <= bright_shoulder) return light;
    const float room = 1.0f - bright_shoulder;
    return 1.0f - room * room / (room + light - bright_shoulder);
}

}  // namespace

Lights::Lights(const Camera& camera, double sky_reach) : sky_reach_(sky_reach) {
    const Vec3 lamp = (0.45 * camera.back - 0.72 * camera.right + 0.80 * Vec3::UnitY()).normalized();
    lamp_ = lamp.cast<float>();
    const auto [s, t] = across(lamp);
    for (const Eigen::Vector2d& p : disc_points(lamp_rays * parts))
        lamp_directions_.push_back((lamp + lamp_radius * (p.x() * s + p.y() * t)).normalized());
    // Even over the disc below the half sphere: weighted by the cosine on it (Malley).
    for (const Eigen::Vector2d& p : disc_points(sky_rays * parts))
        sky_directions_.emplace_back(p.x(), p.y(), std::sqrt(std::max(0.0, 1.0 - p.squaredNorm())));
}

LightShare Lights::measure(const Surfaces& surfaces, const SurfacePoint& point, int part) const {
    const std::size_t first = part == all_parts ? 0 : static_cast<std::size_t>(part), step = part == all_parts ? 1 : parts;
    const Vec3 start = surfaces.lifted(point), normal = point.normal.cast<double>(), facet = point.facet.cast<double>();
    const double far = 8.0 * surfaces.radius();
    int rays = 0, lit = 0;
    const bool faces_lamp = normal.dot(lamp_.cast<double>()) > -lamp_radius;
    for (std::size_t k = first; k < lamp_directions_.size(); k += step, ++rays)
        lit += faces_lamp && !surfaces.tree().blocked(start, lamp_directions_[k], far) ? 1 : 0;
    const auto [s, t] = across(normal);
    int sky_lit = 0, sky_counted = 0;
    for (std::size_t k = first; k < sky_directions_.size(); k += step) {
        const Vec3& d = sky_directions_[k];
        const Vec3 direction = d.x() * s + d.y() * t + d.z() * normal;
        if (direction.dot(facet) <= 0.0) continue;  // below the triangle that the smooth normal stands on
        ++sky_counted;
        sky_lit += surfaces.tree().blocked(start, direction, sky_reach_) ? 0 : 1;
    }
    return {sky_counted > 0 ? static_cast<float>(sky_lit) / static_cast<float>(sky_counted) : 0.0f,
            static_cast<float>(lit) / static_cast<float>(rays)};
}

Colour Lights::shade(const Colour& colour, const SurfacePoint& point, const Eigen::Vector3f& to_eye,
                     const LightShare& share) const {
    const float up = 0.5f + 0.5f * point.normal.y(), facing = std::max(0.0f, point.normal.dot(to_eye));
    // Some light comes everywhere.
    const float shown_sky = hidden_light + (1.0f - hidden_light) * share.sky;
    const float lamp = lamp_light * share.key * std::max(0.0f, point.normal.dot(lamp_));
    const float sky = sky_below + (sky_above - sky_below) * up;
    const float grazing = (1.0f - facing) * (1.0f - facing) * (1.0f - facing);
    Colour light;
    for (int k = 0; k < 3; ++k) {
        // Where the sky is hidden there are surfaces of the same colour, which show some sky again: s + (1 - s) c s + ...
        const float sky_seen = shown_sky / (1.0f - colour[k] * (1.0f - shown_sky));
        light[k] = bent(colour[k] * (sky * sky_seen + lamp + eye_light * facing * (0.4f + 0.6f * share.sky)) +
                        sheen_light * grazing * share.sky);
    }
    return light;
}

float Lights::ground_shadow(const LightShare& share) const {
    const float lamp = lamp_light * std::max(0.0f, lamp_.y());
    return ground_darkness * (1.0f - (sky_above * share.sky + lamp * share.key) / (sky_above + lamp));
}

}  // namespace percale::scenes
