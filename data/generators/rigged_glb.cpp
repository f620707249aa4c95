#include "generators/rigged_glb.h"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "generators/mannequin_motion.h"
#include "percale/error.h"
#include "scenes/common/bytes.h"
#include "scenes/common/glb.h"

namespace percale::scenes {

namespace {

using Json = nlohmann::ordered_json;
using Vec4 = std::array<double, 4>;

constexpr std::size_t max_vertices = 65535;  // index 65535 is not allowed among 16 bits

/// The root of the JSON chunk and the binary chunk, both as far as they are written.
class GlbContent {
public:
    Json root;

    /// An accessor of numbers written by `put`, in a view of its own; returns its index.
    template <class Put>
    int add(const char* type, GlbComponent component, std::size_t count, GlbTarget target, Put put) {
        const std::size_t start = binary_.size();
        put();
        const std::size_t length = binary_.size() - start;
        binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
        Json view = {{"buffer", 0}, {"byteOffset", start}, {"byteLength", length}};
        if (target != GlbTarget::none) view["target"] = static_cast<int>(target);
        root["bufferViews"].push_back(view);
        const int index = static_cast<int>(root["accessors"].size());
        root["accessors"].push_back(
            {{"bufferView", index}, {"componentType", static_cast<int>(component)}, {"count", count}, {"type", type}});
        return index;
    }

    /// Little-endian, as glTF wants it on every machine.
    template <class Unsigned>
    void put(Unsigned value) {
        append_little(binary_, value);
    }
    void put_float(double value) { append_float(binary_, value); }

    std::string file() {
        root["buffers"].push_back({{"byteLength", binary_.size()}});
        return glb_start(root.dump(), binary_.size()) + binary_;
    }

private:
    std::string binary_;
};

double as_float(double value) { return static_cast<float>(value); }

Json numbers(const Vec3& x) { return {as_float(x[0]), as_float(x[1]), as_float(x[2])}; }

int add_vectors(GlbContent& content, std::span<const Vec3> vectors, GlbTarget target) {
    return content.add("VEC3", GlbComponent::float_number, vectors.size(), target, [&] {
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
    const int positions = add_vectors(content, rig.mesh.vertices, GlbTarget::vertices);
    add_bounds(content, positions, rig.mesh.vertices);
    const int joints = content.add("VEC4", GlbComponent::unsigned_byte, rig.weights.size(), GlbTarget::vertices, [&] {
        for (const VertexWeights& vertex : rig.weights)
            for (const int index : vertex.joints) content.put(static_cast<std::uint8_t>(index));
    });
    const int weights = content.add("VEC4", GlbComponent::float_number, rig.weights.size(), GlbTarget::vertices, [&] {
        for (const VertexWeights& vertex : rig.weights)
            for (const double weight : vertex.weights) content.put_float(weight);
    });
    const int indices =
        content.add("SCALAR", GlbComponent::unsigned_short, 3 * rig.mesh.triangles.size(), GlbTarget::indices, [&] {
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
    const int matrices = content.add("MAT4", GlbComponent::float_number, joints.size(), GlbTarget::none, [&] {
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

/// The rotations of one joint at all times. Each quaternion has the sign that is nearer to the key before, as players
/// interpolate.
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
    const int times = content.add("SCALAR", GlbComponent::float_number, clip.times.size(), GlbTarget::none, [&] {
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
    add_channel(0, "translation", add_vectors(content, places, GlbTarget::none));
    for (std::size_t j = 0; j < rig.joints.size(); ++j)
        add_channel(j, "rotation", content.add("VEC4", GlbComponent::float_number, clip.poses.size(), GlbTarget::none, [&] {
            for (const Vec4& key : rotation_keys(clip, j))
                for (const double number : key) content.put_float(number);
        }));
    content.root["animations"].push_back({{"name", clip.name}, {"channels", channels}, {"samplers", samplers}});
}

}  // namespace

std::string rigged_glb(const std::string& name, const Rig& rig, std::span<const Clip> clips) {
    if (rig.mesh.vertices.size() > max_vertices)
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
