#include "export/run_settings.h"

#include <nlohmann/json.hpp>

#include "percale/options.h"

namespace percale::scenes {

using nlohmann::ordered_json;

namespace {

ordered_json list(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

template <class Owner>
ordered_json option_value(Owner& owner, const Option<Owner>& option) {
    if (option.automatic && *option.automatic(owner)) return "auto";
    if (option.number) return *option.number(owner);
    if (option.integer) return *option.integer(owner);
    if (option.flag) return *option.flag(owner);
    if (option.optional_number) return **option.optional_number(owner);
    if (option.optional_pair) return **option.optional_pair(owner);
    if (option.get_choice) return std::string(option.choices[static_cast<std::size_t>(option.get_choice(owner))]);
    const std::optional<double>& value = *option.number_or_auto(owner);
    return value ? ordered_json(*value) : ordered_json("auto");
}

template <class Owner>
bool is_left_out(Owner& owner, const Option<Owner>& option) {
    return (option.optional_number && !option.optional_number(owner)->has_value()) ||
           (option.optional_pair && !option.optional_pair(owner)->has_value());
}

/// Puts an option under its dotted key: springs.shear becomes an object in an object.
template <class Owner>
ordered_json options_object(Owner owner, std::span<const Option<Owner>> options) {
    ordered_json json = ordered_json::object();
    for (const Option<Owner>& option : options) {
        if (is_left_out(owner, option)) continue;
        std::string key(option.key);
        for (char& letter : key)
            if (letter == '.') letter = '/';
        json[ordered_json::json_pointer("/" + key)] = option_value(owner, option);
    }
    return json;
}

ordered_json list(const Rotation& q) { return {q.w, q.x, q.y, q.z}; }

ordered_json pose_object(const Pose& pose) {
    return {{"translation", list(pose.translation)}, {"rotation", list(pose.rotation)}, {"scale", pose.scale}};
}

ordered_json keyframe_object(const Keyframe& keyframe) {
    ordered_json json = {{"time", keyframe.time}};
    if (keyframe.translation) json["translation"] = list(*keyframe.translation);
    if (keyframe.rotation) json["rotation"] = list(*keyframe.rotation);
    return json;
}

struct SelectionObject {
    ordered_json operator()(const VertexIndices& s) const { return s.vertices; }
    ordered_json operator()(const VertexBox& s) const {
        return {{"box", ordered_json::array({list(s.lowest), list(s.highest)})}};
    }
    ordered_json operator()(const VertexBoundary&) const { return "boundary"; }
};

ordered_json selection_object(const VertexSelection& selection) { return std::visit(SelectionObject{}, selection); }

std::string unit_word(double unit) {
    if (unit == 1.0) return "m";
    return unit == 0.01 ? "cm" : "mm";
}

ordered_json cloth_object(const ClothSpec& cloth) {
    ordered_json json = {{"name", cloth.name}, {"fabric", cloth.fabric}};
    if (cloth.grid)
        json["grid"] = {{"size", cloth.grid->size}, {"vertices", cloth.grid->vertices}};
    else
        json["mesh"] = cloth.mesh;
    json["unit"] = unit_word(cloth.unit);
    json["pose"] = pose_object(cloth.pose);
    json["pin"] = selection_object(cloth.pin);
    return json;
}

struct ShapeObject {
    ordered_json operator()(std::monostate) const { return nullptr; }
    ordered_json operator()(const SphereShape& s) const { return {{"sphere", {{"radius", s.radius}}}}; }
    ordered_json operator()(const BoxShape& s) const { return {{"box", {{"size", list(s.size)}}}}; }
    ordered_json operator()(const CylinderShape& s) const { return {{"cylinder", {{"radius", s.radius}, {"height", s.height}}}}; }
    ordered_json operator()(const CapsuleShape& s) const { return {{"capsule", {{"radius", s.radius}, {"height", s.height}}}}; }
    ordered_json operator()(const PlaneShape& s) const { return {{"plane", {{"half_size", s.half_size}}}}; }
};

ordered_json obstacle_object(const ObstacleSpec& obstacle) {
    ordered_json json = {{"name", obstacle.name}};
    if (obstacle.mesh.empty())
        json["shape"] = std::visit(ShapeObject{}, obstacle.shape);
    else
        json["mesh"] = obstacle.mesh;
    json["unit"] = unit_word(obstacle.unit);
    json["friction"] = obstacle.friction;
    json["pose"] = pose_object(obstacle.pose);
    json["motion"] = ordered_json::array();
    for (const Keyframe& keyframe : obstacle.motion) json["motion"].push_back(keyframe_object(keyframe));
    if (obstacle.spin)
        json["spin"] = {
            {"axis", list(obstacle.spin->axis)}, {"turns_per_s", obstacle.spin->turns_per_s}, {"from", obstacle.spin->from}};
    return json;
}

ordered_json seam_object(const SeamSpec& seam) {
    return {{"cloths", seam.cloths}, {"vertices", seam.vertices}, {"over", seam.over}, {"stiffness", seam.stiffness}};
}

struct EventObject {
    ordered_json operator()(const PinEvent& e) const {
        return {{"pin", {{"cloth", e.cloth}, {"vertices", selection_object(e.vertices)}}}};
    }
    ordered_json operator()(const UnpinEvent& e) const {
        return {{"unpin", {{"cloth", e.cloth}, {"vertices", selection_object(e.vertices)}}}};
    }
    ordered_json operator()(const MoveEvent& e) const {
        return {{"move", {{"cloth", e.cloth}, {"vertices", selection_object(e.vertices)}, {"to", list(e.to)}, {"over", e.over}}}};
    }
    ordered_json operator()(const WindEvent& e) const { return {{"wind", list(e.wind)}}; }
    ordered_json operator()(const GravityEvent& e) const { return {{"gravity", list(e.gravity)}}; }
};

ordered_json event_object(const EventSpec& event) {
    ordered_json json = {{"time", event.time}};
    json.update(std::visit(EventObject{}, event.what));
    return json;
}

ordered_json step_object(const Scene& scene) {
    ordered_json json = options_object(scene.step, step_options());
    json["detector"] = word_of(scene.detector);
    return json;
}

}  // namespace

std::string settings_text(const Scene& scene) {
    ordered_json json;
    json["duration"] = scene.duration;
    json["gravity"] = list(scene.step.gravity);
    json["step"] = step_object(scene);
    json["fabric"] = ordered_json::object();
    for (const auto& [name, fabric] : scene.fabrics) json["fabric"][name] = options_object(fabric, fabric_options());
    json["cloth"] = ordered_json::array();
    for (const ClothSpec& cloth : scene.cloths) json["cloth"].push_back(cloth_object(cloth));
    json["obstacle"] = ordered_json::array();
    for (const ObstacleSpec& obstacle : scene.obstacles) json["obstacle"].push_back(obstacle_object(obstacle));
    json["seam"] = ordered_json::array();
    for (const SeamSpec& seam : scene.seams) json["seam"].push_back(seam_object(seam));
    json["event"] = ordered_json::array();
    for (const EventSpec& event : scene.events) json["event"].push_back(event_object(event));
    json["output"] = {{"frames", scene.output.frames}, {"fps", scene.output.fps}};
    return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace percale::scenes
