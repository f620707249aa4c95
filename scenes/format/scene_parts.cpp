#include "format/scene_parts.h"

#include <cctype>
#include <limits>

#include "common/text.h"
#include "format/toml_values.h"

namespace percale::scenes {
namespace {

// Names become file names and parts of dotted keys.
bool fits_name(unsigned char letter) { return std::isalnum(letter) || letter == '_' || letter == '-' || letter >= 0x80; }

void read_name(const TomlNode& table, const std::string& list, std::string& name) {
    read_value(table, "name", name);
    const unsigned char first = name.empty() ? '\0' : static_cast<unsigned char>(name.front());
    bool good = std::isalpha(first) || first >= 0x80;
    for (const char letter : name) good = good && fits_name(static_cast<unsigned char>(letter));
    if (!good)
        fail_at(table.find("name")->place,
                list + ".name = \"" + name + "\" must begin with a letter and hold only letters, digits, _ and -");
}

void read_unit(const TomlNode& table, double& unit) {
    std::string word = "m";
    read_value(table, "unit", word);
    unit = word == "mm" ? 0.001 : word == "cm" ? 0.01 : 1.0;
    if (table.find("unit") != nullptr && table.find("mesh") == nullptr)
        fail_at(table.find("unit")->place, "unit is that of a mesh file; without mesh it means nothing");
}

void read_pose(const TomlNode& table, Pose& pose) {
    read_value(table, "pose.translation", pose.translation);
    read_value(table, "pose.rotation", pose.rotation);
    read_value(table, "pose.scale", pose.scale);
}

VertexSelection selection_of(const TomlNode& node) {
    if (node.kind == TomlKind::text) return VertexBoundary{};
    if (node.kind == TomlKind::table) {
        const TomlNode& box = *node.find("box");
        return VertexBox{vector_of(box.items[0]), vector_of(box.items[1])};
    }
    VertexIndices indices;
    for (const TomlNode& item : node.items) indices.vertices.push_back(static_cast<int>(item.integer));
    return indices;
}

Shape shape_of(const TomlNode& table) {
    const std::string word = only_key(table, {"sphere", "box", "capsule", "cylinder", "plane"}, "shape");
    const TomlNode& node = *table.find(word);
    double radius = 0.0, height = 0.0;
    read_value(node, "radius", radius);
    read_value(node, "height", height);
    if (word == "sphere") return SphereShape{radius};
    if (word == "capsule") return CapsuleShape{radius, height};
    if (word == "cylinder") return CylinderShape{radius, height};
    if (word == "box") return BoxShape{vector_of(*node.find("size"))};
    PlaneShape plane;
    read_value(node, "half_size", plane.half_size);
    return plane;
}

void read_motion(const TomlNode& list, std::vector<Keyframe>& motion) {
    for (const TomlNode& item : list.items) {
        Keyframe frame;
        read_value(item, "time", frame.time);
        read_value(item, "translation", frame.translation);
        read_value(item, "rotation", frame.rotation);
        if (!motion.empty() && frame.time <= motion.back().time)
            fail_at(item.place, "motion must ascend in time; " + number_text(frame.time) + " s follows " +
                                    number_text(motion.back().time) + " s");
        motion.push_back(frame);
    }
    if (motion.empty()) fail_at(list.place, "motion must have at least one keyframe");
}

Spin spin_of(const TomlNode& table) {
    Spin spin;
    read_value(table, "axis", spin.axis);
    read_value(table, "turns_per_s", spin.turns_per_s);
    read_value(table, "from", spin.from);
    const double length = spin.axis.norm();
    if (!(length > 0.0)) fail_at(table.find("axis")->place, "spin.axis must not be zero");
    spin.axis /= length;
    return spin;
}

Expectation expectation_of(const TomlNode& node) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Expectation limit{.measure = node.key, .lowest = -infinity, .highest = infinity, .file = {}, .place = node.key_place};
    if (node.is_number()) {
        limit.lowest = limit.highest = node.number;
    } else if (const TomlNode* below = node.find("below")) {
        limit.highest = below->number;
        limit.highest_included = false;
    } else if (const TomlNode* above = node.find("above")) {
        limit.lowest = above->number;
        limit.lowest_included = false;
    } else if (const TomlNode* between = node.find("between")) {
        limit.lowest = between->items[0].number;
        limit.highest = between->items[1].number;
    } else {
        limit.file = node.find("file")->text;
        limit.highest = node.find("within")->number;
    }
    return limit;
}

template <class Event>
Event vertex_event(const TomlNode& table) {
    Event event;
    event.cloth = table.find("cloth")->text;
    event.vertices = selection_of(*table.find("vertices"));
    return event;
}

}  // namespace

ClothSpec read_cloth(const TomlNode& table) {
    ClothSpec cloth;
    cloth.place = table.place;
    read_name(table, "cloth", cloth.name);
    read_value(table, "fabric", cloth.fabric);
    if (only_key(table, {"grid", "mesh"}, "cloth '" + cloth.name + "'") == "grid") {
        const std::vector<TomlNode>& size = find_value(table, "grid.size")->items;
        const std::vector<TomlNode>& vertices = find_value(table, "grid.vertices")->items;
        cloth.grid = GridSpec{{size[0].number, size[1].number},
                              {static_cast<int>(vertices[0].integer), static_cast<int>(vertices[1].integer)}};
    }
    read_value(table, "mesh", cloth.mesh);
    read_unit(table, cloth.unit);
    read_pose(table, cloth.pose);
    cloth.pin_place = cloth.place;
    if (const TomlNode* pin = table.find("pin")) {
        const TomlNode* box = pin->find("box");
        cloth.pin = selection_of(*pin);
        cloth.pin_place = box != nullptr ? box->place : pin->place;
    }
    return cloth;
}

ObstacleSpec read_obstacle(const TomlNode& table) {
    ObstacleSpec obstacle;
    obstacle.place = table.place;
    read_name(table, "obstacle", obstacle.name);
    if (only_key(table, {"mesh", "shape"}, "obstacle '" + obstacle.name + "'") == "shape")
        obstacle.shape = shape_of(*table.find("shape"));
    read_value(table, "mesh", obstacle.mesh);
    read_unit(table, obstacle.unit);
    read_value(table, "friction", obstacle.friction);
    read_pose(table, obstacle.pose);
    if (const TomlNode* motion = table.find("motion")) read_motion(*motion, obstacle.motion);
    if (const TomlNode* spin = table.find("spin")) obstacle.spin = spin_of(*spin);
    return obstacle;
}

SeamSpec read_seam(const TomlNode& table) {
    SeamSpec seam;
    seam.place = table.place;
    const TomlNode& cloths = *table.find("cloths");
    seam.cloths = {cloths.items[0].text, cloths.items[1].text};
    for (const TomlNode& pair : table.find("vertices")->items)
        seam.vertices.push_back({static_cast<int>(pair.items[0].integer), static_cast<int>(pair.items[1].integer)});
    read_value(table, "over", seam.over);
    read_value(table, "stiffness", seam.stiffness);
    return seam;
}

EventSpec read_event(const TomlNode& table) {
    EventSpec event;
    event.place = table.place;
    read_value(table, "time", event.time);
    const std::string word = only_key(table, {"pin", "unpin", "move", "gravity", "wind"}, "event");
    const TomlNode& what = *table.find(word);
    if (word == "pin") {
        event.what = vertex_event<PinEvent>(what);
    } else if (word == "unpin") {
        event.what = vertex_event<UnpinEvent>(what);
    } else if (word == "move") {
        MoveEvent move = vertex_event<MoveEvent>(what);
        read_value(what, "to", move.to);
        read_value(what, "over", move.over);
        event.what = move;
    } else if (word == "gravity") {
        event.what = GravityEvent{vector_of(what)};
    } else {
        event.what = WindEvent{vector_of(what)};
    }
    return event;
}

std::vector<Expectation> read_expectations(const TomlNode& table) {
    std::vector<Expectation> expectations;
    for (const TomlNode& node : table.entries) expectations.push_back(expectation_of(node));
    return expectations;
}

}  // namespace percale::scenes
