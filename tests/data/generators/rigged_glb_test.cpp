#include "data/generators/rigged_glb.h"

#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "data/generators/mannequin.h"
#include "data/generators/mannequin_motion.h"
#include "tests/scenes/message_of.h"
#include "tests/support/catch.h"

namespace percale::scenes::test::rigged_glb_test {
namespace {

using Json = nlohmann::json;

const Rig& rig() {
    static const Rig made = make_mannequin_rig(make_mannequin(0.02));
    return made;
}

const std::string& bytes() {
    static const std::string made = rigged_glb("mannequin", rig(), mannequin_clips());
    return made;
}

std::uint32_t word_at(std::size_t offset) {
    std::uint32_t word = 0;
    for (int byte = 3; byte >= 0; --byte) word = word << 8 | static_cast<unsigned char>(bytes()[offset + byte]);
    return word;
}

std::size_t json_length() { return word_at(12); }
Json json() { return Json::parse(bytes().substr(20, json_length())); }

/// The floats of an accessor of floats, in rows.
std::vector<std::vector<float>> floats(const Json& root, std::size_t accessor) {
    static const std::map<std::string, std::size_t> widths = {{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    const Json& found = root["accessors"][accessor];
    REQUIRE(found["componentType"] == 5126);
    std::size_t offset =
        28 + json_length() + root["bufferViews"][found["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
    std::vector<std::vector<float>> rows(found["count"].get<std::size_t>(), std::vector<float>(widths.at(found["type"])));
    for (std::vector<float>& row : rows)
        for (float& number : row) {
            const std::uint32_t word = word_at(offset);
            std::memcpy(&number, &word, 4);
            offset += 4;
        }
    return rows;
}

void check_bounds(const Json& root, std::size_t accessor) {
    const auto rows = floats(root, accessor);
    std::vector<float> lowest = rows[0], highest = rows[0];
    for (const auto& row : rows)
        for (std::size_t k = 0; k < row.size(); ++k)
            lowest[k] = std::min(lowest[k], row[k]), highest[k] = std::max(highest[k], row[k]);
    CHECK(root["accessors"][accessor]["min"].get<std::vector<double>>() == std::vector<double>(lowest.begin(), lowest.end()));
    CHECK(root["accessors"][accessor]["max"].get<std::vector<double>>() == std::vector<double>(highest.begin(), highest.end()));
}

/// Rotations have length 1, and each is less than half a turn from the one before.
void check_rotations(const std::vector<std::vector<float>>& keys) {
    const auto product = [](const std::vector<float>& a, const std::vector<float>& b) {
        return double(a[0]) * b[0] + double(a[1]) * b[1] + double(a[2]) * b[2] + double(a[3]) * b[3];
    };
    for (std::size_t k = 0; k < keys.size(); ++k) {
        REQUIRE(std::abs(product(keys[k], keys[k]) - 1.0) < 3e-7);
        REQUIRE(product(keys[k], keys[k > 0 ? k - 1 : 0]) > 0.0);
    }
}

const aiScene& imported() {
    static Assimp::Importer importer;
    static const aiScene* scene = importer.ReadFileFromMemory(bytes().data(), bytes().size(), 0, "glb");
    REQUIRE(scene);
    return *scene;
}

using Matrix = Eigen::Matrix4d;

Matrix matrix(const aiMatrix4x4& m) {
    Matrix result;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) result(row, column) = m[row][column];
    return result;
}

/// Where a time (in ticks) lies among keys: the key before it and the fraction of the way to the next.
template <class Key>
std::pair<unsigned, double> place_among(const Key* keys, unsigned count, double time) {
    unsigned k = 0;
    while (k + 2 < count && keys[k + 1].mTime <= time) ++k;
    if (count < 2) return {0, 0.0};
    return {k, std::clamp((time - keys[k].mTime) / (keys[k + 1].mTime - keys[k].mTime), 0.0, 1.0)};
}

Eigen::Quaterniond quaternion(const aiQuaternion& q) { return Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized(); }
Vec3 vector(const aiVector3D& x) { return {x.x, x.y, x.z}; }

/// A node's own transform at a time in ticks, as players take it from the keys.
Matrix at_time(const aiNodeAnim& keys, double time) {
    const auto [p, along] = place_among(keys.mPositionKeys, keys.mNumPositionKeys, time);
    const unsigned next = std::min(p + 1, keys.mNumPositionKeys - 1);
    const Vec3 place = (1.0 - along) * vector(keys.mPositionKeys[p].mValue) + along * vector(keys.mPositionKeys[next].mValue);
    const auto [r, share] = place_among(keys.mRotationKeys, keys.mNumRotationKeys, time);
    const Eigen::Quaterniond from = quaternion(keys.mRotationKeys[r].mValue);
    const Eigen::Quaterniond to = quaternion(keys.mRotationKeys[std::min(r + 1, keys.mNumRotationKeys - 1)].mValue);
    return (Eigen::Translation3d(place) * from.slerp(share, to)).matrix();
}

void collect(const aiNode& node, const Matrix& parent, const std::map<std::string, Matrix>& moved,
             std::map<std::string, Matrix>& all) {
    const std::string name = node.mName.C_Str();
    const auto found = moved.find(name);
    const Matrix here = parent * (found == moved.end() ? matrix(node.mTransformation) : found->second);
    all[name] = here;
    for (unsigned k = 0; k < node.mNumChildren; ++k) collect(*node.mChildren[k], here, moved, all);
}

/// The mesh of the imported scene, skinned by its nodes; `animation` null for the nodes' own transforms; s.
std::vector<Vec3> skinned(const aiScene& scene, const aiAnimation* animation, double time) {
    std::map<std::string, Matrix> moved, nodes;
    for (unsigned c = 0; animation && c < animation->mNumChannels; ++c)
        moved[animation->mChannels[c]->mNodeName.C_Str()] = at_time(*animation->mChannels[c], time * animation->mTicksPerSecond);
    collect(*scene.mRootNode, Matrix::Identity(), moved, nodes);
    const aiMesh& mesh = *scene.mMeshes[0];
    std::vector<Vec3> sum(mesh.mNumVertices, Vec3::Zero());
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        const aiBone& bone = *mesh.mBones[b];
        const Matrix transform = nodes.at(bone.mName.C_Str()) * matrix(bone.mOffsetMatrix);
        for (unsigned w = 0; w < bone.mNumWeights; ++w) {
            const unsigned v = bone.mWeights[w].mVertexId;
            sum[v] += bone.mWeights[w].mWeight * (transform * vector(mesh.mVertices[v]).homogeneous()).head<3>();
        }
    }
    return sum;
}

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    REQUIRE(a.size() == b.size());
    double largest = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v) largest = std::max(largest, (a[v] - b[v]).norm());
    return largest;
}

const aiAnimation& animation(const std::string& name) {
    for (unsigned k = 0; k < imported().mNumAnimations; ++k)
        if (imported().mAnimations[k]->mName.C_Str() == name) return *imported().mAnimations[k];
    FAIL("no animation " << name);
    return *imported().mAnimations[0];
}

/// What our own pose gives between two keys of a clip.
std::vector<Vec3> between_keys(const Clip& clip, double time) {
    std::size_t k = 0;
    while (k + 2 < clip.times.size() && clip.times[k + 1] <= time) ++k;
    const double share = (time - clip.times[k]) / (clip.times[k + 1] - clip.times[k]);
    const MannequinPose &from = clip.poses[k], &to = clip.poses[k + 1];
    MannequinPose pose;
    pose.root_translation = (1.0 - share) * from.root_translation + share * to.root_translation;
    for (int j = 0; j < joint_count; ++j)
        pose.rotations[j] = interpolate(Pose{{}, from.rotations[j], 1.0}, Pose{{}, to.rotations[j], 1.0}, share).rotation;
    return pose_mannequin(rig(), pose);
}

}  // namespace

TEST_CASE("the header and the chunks of a GLB have their lengths, on multiples of 4 bytes") {
    CHECK(bytes().substr(0, 4) == "glTF");
    CHECK(word_at(4) == 2);
    CHECK(word_at(8) == bytes().size());
    CHECK(json_length() % 4 == 0);
    CHECK(bytes().substr(16, 4) == "JSON");
    const std::size_t binary = word_at(20 + json_length());
    CHECK(binary % 4 == 0);
    CHECK(bytes().substr(24 + json_length(), 4) == std::string("BIN\0", 4));
    CHECK(28 + json_length() + binary == bytes().size());
    CHECK(json()["buffers"][0]["byteLength"] == binary);
    CHECK(json()["asset"]["version"] == "2.0");
    CHECK(bytes().size() < 600000);
}

TEST_CASE("views lie one after the other on multiples of 4 bytes, and every accessor fills its own") {
    const Json root = json();
    static const std::map<int, std::size_t> sizes = {{5121, 1}, {5123, 2}, {5126, 4}};
    static const std::map<std::string, std::size_t> widths = {{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    REQUIRE(root["accessors"].size() == root["bufferViews"].size());
    std::size_t end = 0;
    for (std::size_t k = 0; k < root["accessors"].size(); ++k) {
        const Json &accessor = root["accessors"][k], &view = root["bufferViews"][k];
        CHECK(accessor["bufferView"] == k);
        CHECK(view["byteOffset"] == (end + 3) / 4 * 4);
        const std::size_t size = sizes.at(accessor["componentType"]) * widths.at(accessor["type"]);
        CHECK(view["byteLength"] == accessor["count"].get<std::size_t>() * size);
        end = view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>();
    }
    CHECK((end + 3) / 4 * 4 == root["buffers"][0]["byteLength"]);
}

TEST_CASE("bounds of positions and times are those of the numbers in the file, and times ascend from 0") {
    const Json root = json();
    check_bounds(root, root["meshes"][0]["primitives"][0]["attributes"]["POSITION"]);
    REQUIRE(root["animations"].size() == 2);
    for (const Json& clip : root["animations"]) {
        for (const Json& sampler : clip["samplers"]) {
            CHECK(sampler["interpolation"] == "LINEAR");
            const auto times = floats(root, sampler["input"]);
            CHECK(root["accessors"][sampler["output"].get<std::size_t>()]["count"] == times.size());
            CHECK(times[0][0] == 0.0f);
            for (std::size_t k = 1; k < times.size(); ++k) REQUIRE(times[k][0] > times[k - 1][0]);
        }
        check_bounds(root, clip["samplers"][0]["input"]);
        CHECK(clip["channels"].size() == joint_count + 1);
    }
}

TEST_CASE("rotations have length 1 as floats and go the shortest path, and the last key of every channel is its first") {
    const Json root = json();
    for (const Json& clip : root["animations"])
        for (const Json& channel : clip["channels"]) {
            const auto keys = floats(root, clip["samplers"][channel["sampler"].get<std::size_t>()]["output"]);
            CHECK(keys.front() == keys.back());
            if (channel["target"]["path"] == "rotation") check_rotations(keys);
        }
}

TEST_CASE("weights in the file are the rig's, and unused joints are joint 0") {
    const Json root = json(), attributes = root["meshes"][0]["primitives"][0]["attributes"];
    const auto weights = floats(root, attributes["WEIGHTS_0"]);
    const std::size_t view = root["accessors"][attributes["JOINTS_0"].get<std::size_t>()]["bufferView"];
    const std::size_t start = 28 + json_length() + root["bufferViews"][view]["byteOffset"].get<std::size_t>();
    REQUIRE(weights.size() == rig().weights.size());
    for (std::size_t v = 0; v < weights.size(); ++v)
        for (int k = 0; k < 4; ++k) {
            REQUIRE(weights[v][k] == rig().weights[v].weights[k]);
            REQUIRE(static_cast<unsigned char>(bytes()[start + 4 * v + k]) == rig().weights[v].joints[k]);
        }
}

TEST_CASE("the same rig gives the same bytes, and a mesh of too many vertices is refused") {
    CHECK(rigged_glb("mannequin", rig(), mannequin_clips()) == bytes());
    Rig large = rig();
    large.mesh.vertices.resize(65536, Vec3::Zero());
    CHECK(message_of([&] { rigged_glb("large", large, {}); }) == "GLB: 65536 vertices, allowed are 65535");
}

TEST_CASE("assimp reads the mesh in its order, the joints, and two clips of the right durations") {
    const aiScene& scene = imported();
    REQUIRE(scene.mNumMeshes == 1);
    const aiMesh& mesh = *scene.mMeshes[0];
    REQUIRE(mesh.mNumVertices == rig().mesh.vertices.size());
    REQUIRE(mesh.mNumFaces == rig().mesh.triangles.size());
    CHECK(mesh.mNumBones == joint_count);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
        REQUIRE((vector(mesh.mVertices[v]) - rig().mesh.vertices[v]).norm() < 1.1e-7);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
        for (int k = 0; k < 3; ++k) REQUIRE(static_cast<int>(mesh.mFaces[f].mIndices[k]) == rig().mesh.triangles[f][k]);
    REQUIRE(scene.mNumAnimations == 2);
    CHECK(animation("walk").mDuration / animation("walk").mTicksPerSecond == Approx(walk_period).margin(1e-6));
    CHECK(animation("wave").mDuration / animation("wave").mTicksPerSecond == Approx(wave_duration).margin(1e-6));
    CHECK(scene.mRootNode->FindNode("right_wrist") != nullptr);
}

TEST_CASE("skinned by the nodes that assimp reads, the mesh is where it was made") {
    CHECK(largest_difference(skinned(imported(), nullptr, 0.0), rig().mesh.vertices) < 1e-6);
}

TEST_CASE("skinned by the clips that assimp reads, the mesh is where our own poses have it") {
    const std::vector<Clip> clips = mannequin_clips();
    for (const Clip& clip : clips) {
        double largest = 0.0;
        for (const double share : {0.0, 0.083, 0.31, 0.5, 0.555, 0.77, 0.999, 1.0}) {
            const double time = share * clip.times.back();
            largest =
                std::max(largest, largest_difference(skinned(imported(), &animation(clip.name), time), between_keys(clip, time)));
        }
        INFO(clip.name << ": " << largest << " m");
        CHECK(largest < 1e-5);
    }
}

TEST_CASE("between its keys a clip is within millimetres of the motion, and the walking feet near the floor") {
    const std::vector<Clip> clips = mannequin_clips();
    double walk_error = 0.0, wave_error = 0.0, below = 0.0;
    for (int k = 0; k < 200; ++k) {
        const double share = (k + 0.5) / 200.0;
        const std::vector<Vec3> walking = between_keys(clips[0], share * walk_period);
        walk_error = std::max(walk_error, largest_difference(walking, pose_mannequin(rig(), walk_pose(share))));
        const std::vector<Vec3> waving = between_keys(clips[1], share * wave_duration);
        wave_error = std::max(wave_error, largest_difference(waving, pose_mannequin(rig(), wave_pose(share * wave_duration))));
        for (const Vec3& x : walking) below = std::min(below, x[1]);
    }
    INFO("walk " << walk_error << " m, wave " << wave_error << " m, lowest " << below << " m");
    CHECK(walk_error < 3e-3);
    CHECK(wave_error < 3e-3);
    CHECK(below > -1.5e-3);
}

}  // namespace percale::scenes::test::rigged_glb_test
