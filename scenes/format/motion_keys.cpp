#include "format/motion_keys.h"

#include "common/scene_file_error.h"
#include "common/text.h"
#include "format/scene.h"

namespace percale::scenes {
namespace {

/// A key of mesh files that bend.
SceneKey frame_key(const std::string& path, const std::string& sentence, const std::string& unit = "") {
    return {.path = path, .sentence = sentence, .unit = unit, .needs = "mesh", .needs_why = "what bends is a mesh file"};
}

/// A length of time, s.
Field<ObstacleSpec> time_field(const std::string& path, const std::string& sentence, double ObstacleSpec::*time) {
    SceneKey key = frame_key(path, sentence, "s");
    key.lowest = 0.0;
    key.highest = 1e6;
    return value_field<ObstacleSpec>(key, time);
}

/// Written where it is not empty.
Field<ObstacleSpec> file_field(const std::string& path, const std::string& sentence, std::string ObstacleSpec::*file) {
    Field<ObstacleSpec> field = value_field<ObstacleSpec>(frame_key(path, sentence), file);
    field.write = [file](const ObstacleSpec& spec) {
        return (spec.*file).empty() ? std::nullopt : std::optional(value_node(spec.*file));
    };
    return field;
}

Field<ObstacleSpec> frames_field() {
    SceneKey key = frame_key("frames",
                             "First and last number of the files that mesh names with %d, or %04d for four digits, all with the "
                             "same triangles: each vertex goes straight from one to the next.");
    key.lowest = 0.0;
    key.highest = 1e6;
    return value_field<ObstacleSpec>(key, &ObstacleSpec::frames);
}

Field<ObstacleSpec> fps_field() {
    SceneKey key = frame_key(
        "fps", "Frames a second, without it 30, of frames and of a PC2 cache; other files have their own times.", "1/s");
    key.lowest = 1e-3;
    key.highest = 1e4;
    return value_field<ObstacleSpec>(key, &ObstacleSpec::fps);
}

const FieldTable<Keyframe>& keyframe_table() {
    static const FieldTable<Keyframe> table = {
        .fields = {
            value_field<Keyframe>(
                {.path = "time", .sentence = "When.", .unit = "s", .lowest = 0.0, .highest = max_time, .required = true},
                &Keyframe::time),
            value_field<Keyframe>({.path = "translation",
                                   .sentence = "Where; without it as in the keyframe before.",
                                   .unit = "m",
                                   .lowest = -max_coordinate,
                                   .highest = max_coordinate},
                                  &Keyframe::translation),
            rotation_field<Keyframe>({.path = "rotation",
                                      .sentence = "Unit quaternion w, x, y, z; without it as in the keyframe before.",
                                      .lowest = -1.001,
                                      .highest = 1.001},
                                     "rotation", &Keyframe::rotation),
        }};
    return table;
}

void read_motion(const TomlNode& list, std::vector<Keyframe>& motion) {
    for (const TomlNode& item : list.items) {
        const Keyframe frame = read_spec(item, keyframe_table());
        if (!motion.empty() && frame.time <= motion.back().time)
            fail_at(item.place, "motion must ascend in time; " + number_text(frame.time) + " s follows " +
                                    number_text(motion.back().time) + " s");
        motion.push_back(frame);
    }
    if (motion.empty()) fail_at(list.place, "motion must have at least one keyframe");
}

void finish_spin(const TomlNode& table, Spin& spin) {
    const double length = spin.axis.norm();
    if (!(length > 0.0)) fail_at(table.find("axis")->place, "spin.axis must not be zero");
    spin.axis /= length;
}

const FieldTable<Spin>& spin_table() {
    static const FieldTable<Spin> table = {
        .fields = {value_field<Spin>({.path = "axis",
                                      .sentence = "Direction of the axis in the world, of any length.",
                                      .lowest = -max_coordinate,
                                      .highest = max_coordinate},
                                     &Spin::axis),
                   value_field<Spin>({.path = "turns_per_s",
                                      .sentence = "Counter-clockwise seen against the axis.",
                                      .unit = "1/s",
                                      .lowest = -1e3,
                                      .highest = 1e3,
                                      .required = true},
                                     &Spin::turns_per_s),
                   value_field<Spin>(
                       {.path = "from", .sentence = "When it begins.", .unit = "s", .lowest = 0.0, .highest = max_time},
                       &Spin::from)},
        .finish = finish_spin};
    return table;
}

}  // namespace

Field<ObstacleSpec> motion_field() {
    Field<ObstacleSpec> field = list_field<ObstacleSpec>(
        {.path = "motion",
         .sentence = "Keyframes, ascending in time: they replace the pose's translation and rotation, linear and the "
                     "shortest way in between, constant outside."},
        &ObstacleSpec::motion, keyframe_table());
    field.read = [](const TomlNode& node, ObstacleSpec& obstacle, FaultList&) { read_motion(node, obstacle.motion); };
    return field;
}

Field<ObstacleSpec> spin_field() {
    return table_field<ObstacleSpec>(
        {.path = "spin", .sentence = "A steady turn about an axis through the mesh's origin, on top of pose and motion."},
        &ObstacleSpec::spin, spin_table());
}

Field<ObstacleSpec> pinch_field() {
    static constexpr std::string_view words[] = {"stop", "yield"};
    return word_field<ObstacleSpec>({.path = "on_pinch",
                                     .sentence = "Where it leaves cloth no room, between it and another surface or its own. "
                                                 "stop: the run ends, and names the obstacles, "
                                                 "when cloth can no longer be kept from crossing. yield: from 1.2 thicknesses of "
                                                 "room on its surface gives way there, and "
                                                 "goes back when there is room; report.json says when and how far. Edges should "
                                                 "be no longer than a few thicknesses."},
                                    &ObstacleSpec::yields, words, std::vector{false, true});
}

std::vector<Field<ObstacleSpec>> bend_fields() {
    return {
        frames_field(),
        file_field(
            "cache",
            "PC2 or MDD file with the vertices of mesh (OBJ, OFF or PLY) at many times, relative to the scene file; straight "
            "from one to the next.",
            &ObstacleSpec::cache),
        value_field<ObstacleSpec>(
            frame_key("clip",
                      "Name, or number from 0 as text (\"1\"), of an animation in the glTF, GLB, FBX or DAE file that mesh "
                      "is: nodes, skin and morph targets are played, linear between keys whatever the file says."),
            &ObstacleSpec::clip),
        fps_field(),
        file_field("start_mesh",
                   "Mesh file with the triangles of mesh (of frames and caches): the body before it plays, whose lead_in then "
                   "takes it to the first shape.",
                   &ObstacleSpec::start_mesh),
        time_field(
            "lead_in",
            "Within this time after play_from each vertex goes straight from where it starts (start_mesh; without, the mesh "
            "of a cache or the rest pose of a clip) to the first shape that is played.",
            &ObstacleSpec::lead_in),
        time_field("play_from", "When it begins to move; until then it keeps its first shape.", &ObstacleSpec::play_from),
        time_field("play_offset", "Where in the frames, the cache or the clip it begins.", &ObstacleSpec::play_offset),
        value_field<ObstacleSpec>(
            frame_key(
                "loop",
                "Whether it is played again and again: after the last shape comes the first (not that of play_offset), one frame "
                "later, or at once where they are the same; else the last stays."),
            &ObstacleSpec::loop),
    };
}

}  // namespace percale::scenes
