#include "picture/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "common/nearest_name.h"
#include "common/text.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

// Fraction of the picture that stays free at each edge.
constexpr double free_margin = 0.06;

const std::vector<std::pair<std::string, CameraAim>>& named_aims() {
    static const std::vector<std::pair<std::string, CameraAim>> aims = {{"three_quarter", {28.0, 12.0}},
                                                                        {"front", {0.0, 0.0}},
                                                                        {"side", {90.0, 0.0}},
                                                                        {"back", {180.0, 0.0}},
                                                                        {"top", {0.0, 90.0}}};
    return aims;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

void check_aim(const CameraAim& aim) {
    if (!std::isfinite(aim.azimuth)) throw SceneError("azimuth is " + number_text(aim.azimuth) + ", must be finite");
    if (!(std::abs(aim.elevation) <= 90.0))
        throw SceneError("elevation is " + number_text(aim.elevation) + " degrees, must be in -90 ... 90");
    if (!(aim.zoom > 0.0 && std::isfinite(aim.zoom))) throw SceneError("zoom is " + number_text(aim.zoom) + ", must be above 0");
    if (aim.target && !aim.target->allFinite()) throw SceneError("target is not finite");
}

}  // namespace

CameraAim aim_of_view(const std::string& view) {
    std::vector<std::string> names;
    for (const auto& [name, aim] : named_aims()) {
        if (name == view) return aim;
        names.push_back(name);
    }
    throw SceneError("no view '" + view + "'" + suggestion(view, names));
}

Vec3 Camera::direction(double x, double y) const {
    return ((x - middle) * right - (y - 0.5 * height) * up - focal * height * back).normalized();
}

Vec3 Camera::project(const Vec3& point) const {
    const Vec3 offset = point - eye;
    const double depth = -offset.dot(back), scale = focal * height / depth;
    return {middle + scale * offset.dot(right), 0.5 * height - scale * offset.dot(up), depth};
}

ViewFit::ViewFit(const CameraAim& aim, int width, int height) : aim_(aim) {
    check_aim(aim);
    const double a = radians(aim.azimuth), e = radians(aim.elevation);
    frame_.right = Vec3(std::cos(a), 0.0, -std::sin(a));
    frame_.back = Vec3(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e));
    frame_.up = frame_.back.cross(frame_.right);
    frame_.width = width;
    frame_.height = height;
    frame_.middle = 0.5 * width;
    upwards_.tangent = (0.5 - free_margin) / frame_.focal;
    across_.tangent = (0.5 - free_margin) / frame_.focal * width / height;
}

void ViewFit::add(std::span<const Vec3> points) {
    for (const Vec3& point : points) {
        const Vec3 x = aim_.target ? Vec3(point - *aim_.target) : point;
        const double towards = x.dot(frame_.back);
        nearest_ = std::max(nearest_, towards);
        for (const auto& [edges, along] : {std::pair(&across_, x.dot(frame_.right)), std::pair(&upwards_, x.dot(frame_.up))}) {
            edges->high = std::max(edges->high, along + edges->tangent * towards);
            edges->low = std::min(edges->low, along - edges->tangent * towards);
        }
    }
}

Camera ViewFit::camera() const {
    Camera camera = frame_;
    if (!std::isfinite(nearest_)) throw SceneError("nothing is shown: there is no vertex to look at");
    if (aim_.target) {
        double distance = nearest_;
        for (const Edges* edges : {&across_, &upwards_})
            distance = std::max({distance, edges->high / edges->tangent, -edges->low / edges->tangent});
        camera.eye = *aim_.target + distance * camera.back;
    } else {
        const double distance = std::max({across_.distance(), upwards_.distance(), nearest_});
        camera.eye = across_.place() * camera.right + upwards_.place() * camera.up + distance * camera.back;
    }
    // Points that lie in one place, or all in the line of sight, still are before the eye.
    const double back_off = std::max(1e-6, 1e-3 * (camera.eye.dot(camera.back) - nearest_));
    camera.eye += back_off * camera.back;
    camera.focal *= aim_.zoom;
    return camera;
}

Camera ViewFit::camera_of_wider(int width) const {
    Camera wider = camera();
    wider.width = width;
    return wider;
}

}  // namespace percale::scenes
