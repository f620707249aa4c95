#include "python/poses.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/nearest_name.h"
#include "common/text.h"
#include "percale/error.h"
#include "python/arrays.h"
#include "python/module.h"
#include "python/values.h"

namespace percale::python {
namespace {

constexpr double unit_slack = 1e-3;  // how far the length of a quaternion may be from 1, as in scene files

Rotation unit_rotation(const Rotation& q) {
    const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (!(std::abs(length - 1.0) <= unit_slack))
        throw SceneError("rotation", "must be a unit quaternion (w, x, y, z); its length is " + scenes::number_text(length) +
                                         ", allowed: 0.999 ... 1.001");
    return {q.w / length, q.x / length, q.y / length, q.z / length};
}

Pose make_pose(py::handle translation, py::handle rotation, double scale) {
    Pose pose;
    if (!translation.is_none()) pose.translation = vector_of(translation, "translation");
    if (!rotation.is_none()) pose.rotation = unit_rotation(rotation_of(rotation, "rotation"));
    pose.scale = scale;
    if (!pose.translation.allFinite()) throw SceneError("translation", "is not finite");
    if (!(scale > 0.0) || !std::isfinite(scale))
        throw SceneError("scale", "is " + scenes::number_text(scale) + ", it must be above 0");
    return pose;
}

Pose pose_of_keys(const py::dict& keys, const char* what) {
    const std::vector<std::string> valid{"translation", "rotation", "scale"};
    for (const auto& [key, value] : keys) {
        const std::string name = py::str(key).cast<std::string>();
        if (std::ranges::find(valid, name) == valid.end())
            throw SceneError(what, "unknown key '" + name + "'" + scenes::suggestion(name, valid));
    }
    const auto given = [&](const char* key) -> py::object { return keys.contains(key) ? py::object(keys[key]) : py::none(); };
    const py::object scale = given("scale");
    return make_pose(given("translation"), given("rotation"),
                     scale.is_none() ? 1.0 : number_from(scale, std::string(what) + ": scale"));
}

py::tuple rotation_tuple(const Rotation& q) { return py::make_tuple(q.w, q.x, q.y, q.z); }

/// The quaternion of a turn by `angle` about an axis: cos(a/2), sin(a/2) n.
py::tuple rotation_about(py::handle axis, double angle) {
    const Vec3 direction = vector_of(axis, "axis");
    const double length = direction.norm();
    if (!(length > 0.0) || !std::isfinite(length)) throw SceneError("axis", "must have a length above 0 that is finite");
    if (!std::isfinite(angle)) throw SceneError("angle", "is not finite");
    const Vec3 part = std::sin(0.5 * angle) / length * direction;
    return py::make_tuple(std::cos(0.5 * angle), part.x(), part.y(), part.z());
}

std::string pose_repr(const Pose& pose) {
    const auto number = [](double value) { return scenes::number_text(value); };
    const Vec3& t = pose.translation;
    const Rotation& q = pose.rotation;
    return "Pose(translation=(" + number(t.x()) + ", " + number(t.y()) + ", " + number(t.z()) + "), rotation=(" + number(q.w) +
           ", " + number(q.x) + ", " + number(q.y) + ", " + number(q.z) + "), scale=" + number(pose.scale) + ")";
}

}  // namespace

Pose pose_of(py::handle value, const char* what) {
    if (value.is_none()) return {};
    if (py::isinstance<Pose>(value)) return value.cast<Pose>();
    if (py::isinstance<py::dict>(value)) return pose_of_keys(py::reinterpret_borrow<py::dict>(value), what);
    throw SceneError(what, "must be a percale.Pose, a dict of translation, rotation and scale, or None, not " + described(value));
}

void bind_poses(py::module_& module) {
    py::class_<Pose>(module, "Pose",
                     "x -> translation + rotation (scale x). translation: 3 numbers, m; rotation: unit quaternion (w, x, y, z),\n"
                     "its length 1 to within 0.001, made 1; scale > 0. Throws SceneError.")
        .def(py::init(&make_pose), py::arg("translation") = py::none(), py::arg("rotation") = py::none(), py::arg("scale") = 1.0)
        .def_property_readonly(
            "translation", [](const Pose& pose) { return array_of(pose.translation); }, "m, shape (3,).")
        .def_property_readonly(
            "rotation", [](const Pose& pose) { return rotation_tuple(pose.rotation); }, "(w, x, y, z), of length 1.")
        .def_property_readonly(
            "scale", [](const Pose& pose) { return pose.scale; }, "Factor on lengths.")
        .def(
            "transform",
            [](const Pose& pose, py::handle points) { return array_of(transform(pose, points_of(points, "points"))); },
            py::arg("points"), "The images of points, (n, 3), m.")
        .def("__repr__", &pose_repr)
        .def("__eq__", [](const Pose& a, const Pose& b) { return a == b; });
    module.attr("Pose").attr("__hash__") = py::none();
    module.def("rotation_about", &rotation_about, py::arg("axis"), py::arg("angle"),
               "The quaternion (w, x, y, z) of a turn by an angle, rad, about an axis of any length above 0.");
}

}  // namespace percale::python
