#include "shapes/rigged_glb.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "percale/error.h"
#include "shapes/mannequin_motion.h"

namespace percale::scenes {

namespace {

using Json = nlohmann::ordered_json;
using Vec4 = std::array<double, 4>;

// Numbers that glTF 2.0 gives to types and targets.
enum ComponentType { unsigned_byte = 5121, unsigned_short = 5123, float_number = 5126 };
enum Target { no_target = 0, vertex_buffer = 34962, index_buffer = 34963 };

constexpr std::size_t most_vertices = 65535;  // index 65535 is not allowed among 16 bits

/// The root of the JSON chunk and the binary chunk, both as far as they are written.
class GlbContent {
public:
    Json root;

    /// An accessor of numbers written by `put`, in a view of its own; returns its index.
    template <class Put>
    int add(const char* type, ComponentType component, std::size_t count, Target target, Put put) {
        const std::size_t start = binary_.size();
        put();
        const std::size_t length = binary_.size() - start;
        binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
        Json view = {{"buffer", 0}, {"byteOffset", start}, {"byteLength", length}};
        if (target != no_target) view["target"] = target;
        root["bufferViews"].push_back(view);
        const int index = static_cast<int>(root["accessors"].size());
        root["accessors"].push_back({{"bufferView", index}, {"componentType", component}, {"count", count}, {"type", type}});
        return index;
    }

    /// Little-endian, as glTF wants it on every machine.
    template <class Unsigned>
    void put(Unsigned value) {
        for (std::size_t byte = 0; byte < sizeof value; ++byte) binary_ += static_cast<char>(value >> (8 * byte) & 0xff);
    }
    void put_float(double value) { put(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }

    /// Header, JSON padded with spaces, bytes padded with zeros.
    std::string file() {
        root["buffers"].push_back({{"byteLength", binary_.size()}});
        std::string json = root.dump();
        json.resize((json.size() + 3) / 4 * 4, ' ');
        GlbContent out;
        for (const std::uint32_t word : {0x46546C67u, 2u, static_cast<std::uint32_t>(28 + json.size() + binary_.size())})
            out.put(word);
        for (const std::uint32_t word : {static_cast<std::uint32_t>(json.size()), 0x4E4F534Au}) out.put(word);
        out.binary_ += json;
        for (const std::uint32_t word : {static_cast<std::uint32_t>(binary_.size()), 0x004E4942u}) out.put(word);
        return out.binary_ + binary_;
    }

private:
    std::string binary_;
};

double as_float(double value) { return static_cast<float>(value); }

Json numbers(const Vec3& x) { return {as_float(x[0]), as_float(x[1]), as_float(x[2])}; }

int add_vectors(GlbContent& content, std::span<const Vec3> vectors, Target target) {
    return content.add("VEC3", float_number, vectors.size(), target, [&] {
        for (const Vec3& x : vectors)
            for (const double coordinate : x) content.put_float(coordinate + 0.0);
    });
}

/// Bounds are of the floats that are in the file.
void add_bounds(GlbContent& content, int accessor, std::span<const Vec3> vectors) {
    Vec3 lowest = vectors[0], highest = vectors[0];
    for (const Vec3& x : vectors) lowest = lowest.cwiseMin(x), highest = highest.cwiseMax(x);
    content.root["accessors"][accessor]["min"] = numbers(lowest);
    content.root["accessors"][accessor]["max"] = numbers(highest);
}

void add_mesh(GlbContent& content, const std::string& name, const Rig& rig) {
    const int positions = add_vectors(content, rig.mesh.vertices, vertex_buffer);
    add_bounds(content, positions, rig.mesh.vertices);
    const int joints = content.add("VEC4", unsigned_byte, rig.weights.size(), vertex_buffer, [&] {
        for (const VertexWeights& vertex : rig.weights)
            for (const int index : vertex.joints) content.put(static_cast<std::uint8_t>(index));
    });
    const int weights = content.add("VEC4", float_number, rig.weights.size(), vertex_buffer, [&] {
        for (const VertexWeights& vertex : rig.weights)
            for (const double weight : vertex.weights) content.put_float(weight);
    });
    const int indices = content.add("SCALAR", unsigned_short, 3 * rig.mesh.triangles.size(), index_buffer, [&] {
        for (const Triangle& triangle : rig.mesh.triangles)
            for (const int vertex : triangle) content.put(static_cast<std::uint16_t>(vertex));
    });
    const Json attributes = {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}};
    Json primitives;
    primitives.push_back({{"attributes", attributes}, {"indices", indices}});
    content.root["meshes"].push_back({{"name", name}, {"primitives", primitives}});
}

Vec3 offset_of(const std::vector<Joint>& joints, std::size_t index) {
    const Joint& own = joints[index];
    return own.parent < 0 ? own.position : own.position - joints[own.parent].position;
}

/// Node 0 shows the mesh; joint j is node j + 1. Inverse bind matrices, by columns: a translation by minus the joint's position.
void add_skeleton(GlbContent& content, const std::string& name, const std::vector<Joint>& joints) {
    Json& nodes = content.root["nodes"];
    Json skin_joints;
    nodes.push_back({{"name", name}, {"mesh", 0}, {"skin", 0}});
    for (std::size_t j = 0; j < joints.size(); ++j) {
        nodes.push_back({{"name", joints[j].name}, {"translation", numbers(offset_of(joints, j))}});
        if (joints[j].parent >= 0) nodes[joints[j].parent + 1]["children"].push_back(j + 1);
        skin_joints.push_back(j + 1);
    }
    const int matrices = content.add("MAT4", float_number, joints.size(), no_target, [&] {
        for (const Joint& joint : joints)
            for (int column = 0; column < 4; ++column)
                for (int row = 0; row < 4; ++row)
                    content.put_float(column == 3 && row < 3 ? 0.0 - joint.position[row] : (row == column ? 1.0 : 0.0));
    });
    content.root["skins"].push_back({{"inverseBindMatrices", matrices}, {"skeleton", 1}, {"joints", skin_joints}});
}

/// x y z w, rounded and of length 1 to within a float; w >= 0.
Vec4 rounded_rotation(const Rotation& rotation) {
    Vec4 q = {rotation.x, rotation.y, rotation.z, rotation.w};
    double square = 0.0;
    for (double& number : q) {
        number = std::round((rotation.w < 0.0 ? -number : number) * 1e6) / 1e6 + 0.0;
        square += number * number;
    }
    for (double& number : q) number /= std::sqrt(square);
    return q;
}

/// Of one joint at all times. Of the two signs of a quaternion the one nearer to the key before, as players go.
std::vector<Vec4> rotation_keys(const Clip& clip, std::size_t index) {
    std::vector<Vec4> keys;
    for (const MannequinPose& pose : clip.poses) {
        Vec4 q = rounded_rotation(pose.rotations[index]);
        double product = 0.0;
        for (int k = 0; k < 4 && !keys.empty(); ++k) product += q[k] * keys.back()[k];
        if (product < 0.0)
            for (double& number : q) number = 0.0 - number;
        keys.push_back(q);
    }
    return keys;
}

void add_animation(GlbContent& content, const Rig& rig, const Clip& clip) {
    const int times = content.add("SCALAR", float_number, clip.times.size(), no_target, [&] {
        for (const double time : clip.times) content.put_float(time);
    });
    content.root["accessors"][times]["min"].push_back(as_float(clip.times.front()));
    content.root["accessors"][times]["max"].push_back(as_float(clip.times.back()));
    Json samplers, channels;
    const auto add_channel = [&](std::size_t index, const char* path, int output) {
        channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", index + 1}, {"path", path}}}});
        samplers.push_back({{"input", times}, {"interpolation", "LINEAR"}, {"output", output}});
    };
    std::vector<Vec3> places;
    for (const MannequinPose& pose : clip.poses) {
        const Vec3 place = rig.joints[0].position + pose.root_translation;
        places.push_back((place * 1e6).array().round() / 1e6);
    }
    add_channel(0, "translation", add_vectors(content, places, no_target));
    for (std::size_t j = 0; j < rig.joints.size(); ++j)
        add_channel(j, "rotation", content.add("VEC4", float_number, clip.poses.size(), no_target, [&] {
            for (const Vec4& key : rotation_keys(clip, j))
                for (const double number : key) content.put_float(number);
        }));
    content.root["animations"].push_back({{"name", clip.name}, {"channels", channels}, {"samplers", samplers}});
}

}  // namespace

std::string rigged_glb(const std::string& name, const Rig& rig, std::span<const Clip> clips) {
    if (rig.mesh.vertices.size() > most_vertices)
        throw SceneError("GLB: " + std::to_string(rig.mesh.vertices.size()) + " vertices, allowed are 65535");
    GlbContent content;
    content.root["asset"] = {{"version", "2.0"}, {"generator", "percale_make_data"}};
    content.root["scene"] = 0;
    content.root["scenes"].push_back({{"nodes", {0, 1}}});
    add_mesh(content, name, rig);
    add_skeleton(content, name, rig.joints);
    for (const Clip& clip : clips) add_animation(content, rig, clip);
    return content.file();
}

std::vector<Clip> mannequin_clips() {
    return {sampled_clip("walk", walk_period, 45, [](double time) { return walk_pose(time / walk_period); }),
            sampled_clip("wave", wave_duration, 101, wave_pose)};
}

}  // namespace percale::scenes
