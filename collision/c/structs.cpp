#include "c/structs.h"

#include <limits>

#include "percale/settings.h"
#include "percale/simulation.h"

namespace percale::c_interface {
namespace {

/// All zero but for its size.
template <class Struct>
Struct sized_struct() {
    Struct made{};
    made.struct_size = sizeof(Struct);
    return made;
}

}  // namespace

template <>
percale_setup default_struct() {
    auto made = sized_struct<percale_setup>();
    made.detector = "none";
    write_vector(StepSettings{}.gravity, made.gravity);
    return made;
}

template <>
percale_workers default_struct() {
    auto made = sized_struct<percale_workers>();
    made.threads = 1;
    return made;
}

template <>
percale_cloth_settings default_struct() {
    auto made = sized_struct<percale_cloth_settings>();
    made.name = "cloth";
    made.pose = c_pose({});
    return made;
}

template <>
percale_obstacle_settings default_struct() {
    auto made = sized_struct<percale_obstacle_settings>();
    const ObstacleSettings defaults;
    made.deforming = defaults.deforming;
    made.yields = defaults.yields;
    made.friction = defaults.friction;
    made.restitution = defaults.restitution;
    made.name = "obstacle";
    made.pose = c_pose({});
    return made;
}

template <>
percale_seam_settings default_struct() {
    auto made = sized_struct<percale_seam_settings>();
    const SeamSettings defaults;
    made.contact_while_closing = defaults.contact_while_closing;
    made.weld = defaults.weld;
    made.after = defaults.after;
    made.over = defaults.over;
    made.stiffness = defaults.stiffness;
    made.name = "seam";
    return made;
}

template <>
percale_scripted_changes default_struct() {
    return sized_struct<percale_scripted_changes>();
}

template <>
percale_energy default_struct() {
    return sized_struct<percale_energy>();
}

template <>
percale_start_fault default_struct() {
    auto made = sized_struct<percale_start_fault>();
    made.obstacle = made.inside_vertex = made.cloth_triangle = made.obstacle_triangle = made.other_cloth_triangle = -1;
    return made;
}

template <>
percale_certificate default_struct() {
    auto made = sized_struct<percale_certificate>();
    made.first_cloth_triangle = made.first_obstacle_triangle = made.deepest_vertex = -1;
    return made;
}

template <>
percale_option default_struct() {
    return sized_struct<percale_option>();
}

int counted_items(std::size_t count, const char* name) {
    const std::size_t max = std::numeric_limits<int>::max();
    if (count > max) {
        throw SceneError(name, std::to_string(count) + " items are more than the " + std::to_string(max) + " that there may be");
    }
    return static_cast<int>(count);
}

std::vector<Vec3> vectors_of(const double* numbers, std::size_t count, const char* name) {
    if (count > 0) static_cast<void>(demanded(numbers, name));
    std::vector<Vec3> vectors;
    vectors.reserve(static_cast<std::size_t>(counted_items(count, name)));
    for (std::size_t i = 0; i < count; ++i) vectors.emplace_back(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
    return vectors;
}

Pose pose_of(const percale_pose& pose) {
    const double* turn = pose.rotation;
    return {.translation = vector_of(pose.translation, "translation"),
            .rotation = {turn[0], turn[1], turn[2], turn[3]},
            .scale = pose.scale};
}

percale_pose c_pose(const Pose& pose) {
    percale_pose made{};
    write_vector(pose.translation, made.translation);
    const double turn[] = {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z};
    std::ranges::copy(turn, made.rotation);
    made.scale = pose.scale;
    return made;
}

void give_vectors(std::span<const Vec3> vectors, const Buffer<double>& buffer) {
    buffer.fill(vectors.size(), [&](double* to) {
        for (const Vec3& vector : vectors) to = std::copy_n(vector.data(), 3, to);
    });
}

void give_text(const std::string& text, const Buffer<char>& buffer) {
    buffer.fill(text.size() + 1, [&](char* to) { std::copy_n(text.c_str(), text.size() + 1, to); });
}

}  // namespace percale::c_interface

using percale::c_interface::init_struct;

percale_status percale_init_setup(percale_setup* setup, size_t struct_size) { return init_struct(__func__, setup, struct_size); }

percale_status percale_init_workers(percale_workers* workers, size_t struct_size) {
    return init_struct(__func__, workers, struct_size);
}

percale_status percale_init_cloth_settings(percale_cloth_settings* settings, size_t struct_size) {
    return init_struct(__func__, settings, struct_size);
}

percale_status percale_init_obstacle_settings(percale_obstacle_settings* settings, size_t struct_size) {
    return init_struct(__func__, settings, struct_size);
}

percale_status percale_init_seam_settings(percale_seam_settings* settings, size_t struct_size) {
    return init_struct(__func__, settings, struct_size);
}

percale_status percale_init_scripted_changes(percale_scripted_changes* changes, size_t struct_size) {
    return init_struct(__func__, changes, struct_size);
}

percale_status percale_init_energy(percale_energy* energy, size_t struct_size) {
    return init_struct(__func__, energy, struct_size);
}

percale_status percale_init_step_report(percale_step_report* report, size_t struct_size) {
    return init_struct(__func__, report, struct_size);
}

percale_status percale_init_start_fault(percale_start_fault* fault, size_t struct_size) {
    return init_struct(__func__, fault, struct_size);
}

percale_status percale_init_certificate(percale_certificate* certificate, size_t struct_size) {
    return init_struct(__func__, certificate, struct_size);
}

percale_status percale_init_option(percale_option* option, size_t struct_size) {
    return init_struct(__func__, option, struct_size);
}

percale_pose percale_identity_pose(void) { return percale::c_interface::c_pose({}); }
