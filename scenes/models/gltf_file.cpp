#include "models/gltf_file.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>

#include "common/input_file.h"
#include "models/gltf_document.h"
#include "percale/error.h"
#include "tolerances.h"

namespace percale::scenes {

namespace {

using GltfJson = nlohmann::json;

/// The numbers of a list; `without` where the object has no such list.
template <std::size_t count>
std::array<double, count> numbers_at(const GltfDocument& document, const GltfJson& object, const char* key,
                                     const std::array<double, count>& without) {
    const auto found = object.find(key);
    if (found == object.end()) return without;
    if (!found->is_array() || found->size() != count)
        document.refuse(std::string(key) + " is no list of " + std::to_string(count) + " numbers");
    return found->get<std::array<double, count>>();
}

Eigen::Matrix4d column_major(std::span<const double> numbers) { return Eigen::Map<const Eigen::Matrix4d>(numbers.data()); }

/// Translation, rotation and scale, x -> T + R S x; or a matrix.
Eigen::Matrix4d transform_of(const GltfDocument& document, const GltfJson& node) {
    if (node.contains("matrix")) return column_major(numbers_at<16>(document, node, "matrix", {}));
    const auto t = numbers_at<3>(document, node, "translation", {0, 0, 0});
    const auto r = numbers_at<4>(document, node, "rotation", {0, 0, 0, 1});
    const auto s = numbers_at<3>(document, node, "scale", {1, 1, 1});
    const Eigen::Quaterniond turn(r[3], r[0], r[1], r[2]);
    if (!(turn.norm() > 0.0)) document.refuse("a node's rotation is 0");
    return (Eigen::Translation3d(t[0], t[1], t[2]) * turn.normalized() * Eigen::Scaling(s[0], s[1], s[2])).matrix();
}

std::vector<Vec3> vectors(const std::vector<double>& numbers) {
    std::vector<Vec3> result;
    for (std::size_t k = 0; k + 2 < numbers.size(); k += 3) result.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
    return result;
}

/// The corners of triangles of a mode of the specification: 4 triangles, 5 a strip, 6 a fan; none of points and lines. Triangles
/// with a vertex twice, which join strips and fans, are left out.
std::vector<int> triangle_corners(std::size_t mode, const std::vector<int>& indices) {
    std::vector<int> corners;
    const std::size_t count = indices.size();
    if (mode == 4) corners.assign(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(count / 3 * 3));
    for (std::size_t k = 2; mode > 4 && k < count; ++k) {
        const bool strip = mode == 5, odd = k % 2 == 1;
        const int a = indices[strip ? k - 2 : 0], b = indices[k - 1], c = indices[k];
        if (a == b || b == c || c == a) continue;
        corners.insert(corners.end(), {strip && odd ? b : a, strip && odd ? a : b, c});
    }
    return corners;
}

/// Leaves out vertices that no corner has; the others keep their order.
void drop_unused(ModelMesh& mesh) {
    std::vector<int> kept(mesh.vertices.size(), -1);
    for (const int corner : mesh.corners) kept[static_cast<std::size_t>(corner)] = 0;
    int count = 0;
    for (int& number : kept)
        if (number == 0) number = count++;
    const auto take = [&](std::vector<Vec3>& vertices) {
        for (std::size_t k = 0; k < vertices.size(); ++k)
            if (kept[k] >= 0) vertices[static_cast<std::size_t>(kept[k])] = vertices[k];
        if (!vertices.empty()) vertices.resize(static_cast<std::size_t>(count));
        vertices.shrink_to_fit();  // of parts that share their vertices each keeps its own alone
    };
    take(mesh.vertices);
    for (MorphTarget& target : mesh.targets) take(target.vertices);
    for (int& corner : mesh.corners) corner = kept[static_cast<std::size_t>(corner)];
    std::erase_if(mesh.shares, [&](const BoneShare& share) { return kept[static_cast<std::size_t>(share.vertex)] < 0; });
    for (BoneShare& share : mesh.shares) share.vertex = kept[static_cast<std::size_t>(share.vertex)];
}

class GltfReader {
public:
    explicit GltfReader(const std::string& file) : document_(file) {}

    Model read() {
        for (std::size_t k = 0; k < document_.list("meshes").size(); ++k) add_mesh(document_.at("meshes", k));
        add_nodes();
        for (std::size_t k = 0; k < document_.list("skins").size(); ++k) add_skin(document_.at("skins", k));
        for (std::size_t k = 0; k < document_.list("animations").size(); ++k) add_clip(document_.at("animations", k));
        return std::move(model_);
    }

private:
    void add_mesh(const GltfJson& from) {
        const GltfJson primitives = from.value("primitives", GltfJson::array());
        std::vector<int> numbers;
        const std::string name = from.value("name", "");
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            const std::size_t mode = document_.number(primitives[k], "mode", 7).value_or(4);
            if (mode < 4) continue;
            numbers.push_back(static_cast<int>(model_.meshes.size()));
            model_.meshes.push_back(primitive(primitives[k], mode, from));
            model_.meshes.back().name = primitives.size() > 1 ? name + "-" + std::to_string(k) : name;
        }
        primitives_.push_back(std::move(numbers));
    }

    ModelMesh primitive(const GltfJson& from, std::size_t mode, const GltfJson& mesh_json) {
        ModelMesh mesh;
        const GltfJson& attributes = from.at("attributes");
        mesh.vertices = vectors(document_.numbers(document_.required(attributes, "POSITION", GltfDocument::any), 3));
        mesh.corners = triangle_corners(mode, indices_of(from, mesh.vertices.size()));
        mesh.face_sizes.assign(mesh.corners.size() / 3, 3);
        add_shares(attributes, mesh);
        add_targets(from, mesh_json, mesh);
        drop_unused(mesh);
        return mesh;
    }

    std::vector<int> indices_of(const GltfJson& primitive, std::size_t vertices) const {
        std::vector<int> indices;
        const auto accessor = document_.number(primitive, "indices", GltfDocument::any);
        if (!accessor) {
            for (std::size_t k = 0; k < vertices; ++k) indices.push_back(static_cast<int>(k));
            return indices;
        }
        for (const double index : document_.numbers(*accessor, 1)) {
            if (!(index >= 0.0 && index < static_cast<double>(vertices) && index == std::floor(index)))
                document_.refuse("vertex index " + std::to_string(index) + " is out of range 0 ... " +
                                 std::to_string(static_cast<long>(vertices) - 1));
            indices.push_back(static_cast<int>(index));
        }
        return indices;
    }

    /// Adds the bone weights of all sets of four.
    void add_shares(const GltfJson& attributes, ModelMesh& mesh) const {
        for (int set = 0;; ++set) {
            const std::string joints = "JOINTS_" + std::to_string(set), weights = "WEIGHTS_" + std::to_string(set);
            if (!attributes.contains(joints) || !attributes.contains(weights)) return;
            const std::vector<double> numbers =
                document_.numbers(document_.required(attributes, joints.c_str(), GltfDocument::any), 4);
            const std::vector<double> shares =
                document_.numbers(document_.required(attributes, weights.c_str(), GltfDocument::any), 4);
            if (numbers.size() != 4 * mesh.vertices.size() || shares.size() != numbers.size())
                document_.refuse(joints + " and " + weights + " are not of as many vertices as POSITION");
            for (std::size_t k = 0; k < numbers.size(); ++k) {
                if (!(shares[k] > 0.0)) continue;
                if (!(numbers[k] >= 0.0 && numbers[k] <= 65535.0 && numbers[k] == std::floor(numbers[k])))
                    document_.refuse(joints + " holds " + std::to_string(numbers[k]) + ", no number of a joint");
                mesh.shares.push_back({static_cast<int>(k / 4), static_cast<int>(numbers[k]), shares[k]});
            }
        }
    }

    /// Adds morph targets, which are displacements in the file and positions in a model.
    void add_targets(const GltfJson& primitive, const GltfJson& mesh_json, ModelMesh& mesh) const {
        const GltfJson targets = primitive.value("targets", GltfJson::array());
        const GltfJson weights = mesh_json.value("weights", GltfJson::array());
        if (targets.size() > max_morph_targets) document_.refuse(std::to_string(targets.size()) + " morph targets are too many");
        for (std::size_t k = 0; k < targets.size(); ++k) {
            MorphTarget target{.vertices = {}, .weight = k < weights.size() ? weights[k].get<double>() : 0.0};
            if (const auto accessor = document_.number(targets[k], "POSITION", GltfDocument::any)) {
                target.vertices = vectors(document_.numbers(*accessor, 3));
                if (target.vertices.size() != mesh.vertices.size())
                    document_.refuse("a morph target is not of as many vertices as POSITION");
                for (std::size_t i = 0; i < mesh.vertices.size(); ++i) target.vertices[i] += mesh.vertices[i];
            }
            mesh.targets.push_back(std::move(target));
        }
    }

    /// Adds each node once, parents first.
    void add_nodes() {
        const std::size_t count = document_.list("nodes").size();
        std::vector<int> parents(count, -1);
        for (std::size_t k = 0; k < count; ++k) {
            for (const GltfJson& child : document_.at("nodes", k).value("children", GltfJson::array())) {
                const std::size_t number = document_.required({{"child", child}}, "child", count);
                if (parents[number] != -1 || number == k)
                    document_.refuse("node " + std::to_string(number) + " hangs on two nodes, or on itself");
                parents[number] = static_cast<int>(k);
            }
        }
        const std::vector<char> shown = shown_roots(count);
        numbers_.assign(count, -1);
        for (std::size_t k = 0; k < count; ++k)
            if (parents[k] == -1) add_tree(k, shown[k] != 0);
        if (std::ranges::find(numbers_, -1) != numbers_.end()) document_.refuse("nodes hang on each other in a ring");
    }

    /// Which of the nodes that hang on none are in the scene; without scenes all.
    std::vector<char> shown_roots(std::size_t count) const {
        const std::size_t scenes = document_.list("scenes").size();
        std::vector<char> shown(count, scenes == 0);
        if (scenes == 0) return shown;
        const std::size_t number = document_.number(document_.root(), "scene", scenes).value_or(0);
        for (const GltfJson& root : document_.at("scenes", number).value("nodes", GltfJson::array()))
            shown[document_.required({{"root", root}}, "root", count)] = 1;
        return shown;
    }

    /// A node and all that hang on it; the meshes of those that are not shown are left out.
    void add_tree(std::size_t root, bool shown) {
        std::vector<std::pair<std::size_t, int>> waiting = {{root, -1}};
        while (!waiting.empty()) {
            const auto [number, parent] = waiting.back();
            waiting.pop_back();
            const GltfJson& from = document_.at("nodes", number);
            ModelNode node{.name = from.value("name", ""),
                           .parent = parent,
                           .transform = transform_of(document_, from),
                           .parts = {},
                           .weights = from.value("weights", std::vector<double>())};
            const auto skin_number = document_.number(from, "skin", document_.list("skins").size());
            const int skin = skin_number ? static_cast<int>(*skin_number) : -1;
            if (const auto mesh = document_.number(from, "mesh", primitives_.size()); mesh && shown)
                for (const int part : primitives_[*mesh]) node.parts.push_back({part, skin});
            numbers_[number] = static_cast<int>(model_.nodes.size());
            model_.nodes.push_back(std::move(node));
            const GltfJson children = from.value("children", GltfJson::array());
            for (auto child = children.rbegin(); child != children.rend(); ++child)
                waiting.emplace_back(child->get<std::size_t>(), numbers_[number]);
        }
    }

    void add_skin(const GltfJson& from) {
        ModelSkin skin;
        for (const GltfJson& joint : from.at("joints"))
            skin.joints.push_back(numbers_[document_.required({{"joint", joint}}, "joint", numbers_.size())]);
        skin.offsets.assign(skin.joints.size(), Eigen::Matrix4d::Identity());
        if (const auto accessor = document_.number(from, "inverseBindMatrices", GltfDocument::any)) {
            const std::vector<double> numbers = document_.numbers(*accessor, 16);
            if (numbers.size() < 16 * skin.joints.size())
                document_.refuse("a skin has " + std::to_string(numbers.size() / 16) + " inverse bind matrices for " +
                                 std::to_string(skin.joints.size()) + " joints");
            for (std::size_t k = 0; k < skin.joints.size(); ++k)
                skin.offsets[k] = column_major(std::span(numbers).subspan(16 * k, 16));
        }
        model_.skins.push_back(std::move(skin));
    }

    Interpolation interpolation_of(const GltfJson& sampler) const {
        const std::string word = sampler.value("interpolation", "LINEAR");
        if (word == "LINEAR") return Interpolation::linear;
        if (word == "STEP") return Interpolation::step;
        if (word == "CUBICSPLINE") return Interpolation::cubic;
        document_.refuse("an animation's interpolation is '" + word + "' (LINEAR, STEP, CUBICSPLINE)");
    }

    std::vector<double> times_of(const GltfJson& sampler) const {
        std::vector<double> times = document_.numbers(document_.required(sampler, "input", GltfDocument::any), 1);
        const bool ascending =
            std::ranges::all_of(times, [](double t) { return std::isfinite(t); }) && std::ranges::is_sorted(times);
        if (!ascending) document_.refuse("an animation's times do not ascend");
        return times;
    }

    ModelTrack track_of(const GltfJson& sampler, std::size_t components) const {
        ModelTrack track{.interpolation = interpolation_of(sampler), .times = times_of(sampler), .values = {}};
        const std::vector<double> numbers =
            document_.numbers(document_.required(sampler, "output", GltfDocument::any), components);
        for (std::size_t k = 0; k < numbers.size(); k += components) {
            std::array<double, 4> value{};
            std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(k), components, value.begin());
            track.values.push_back(value);
        }
        return track;
    }

    /// The weights of a number of targets on a node.
    ModelMorphs morphs_of(const GltfJson& sampler, std::size_t node, std::size_t targets) const {
        ModelMorphs morphs{
            .nodes = {numbers_[node]}, .interpolation = interpolation_of(sampler), .times = times_of(sampler), .weights = {}};
        const std::vector<double> numbers = document_.numbers(document_.required(sampler, "output", GltfDocument::any), 1);
        for (std::size_t k = 0; targets > 0 && k + targets <= numbers.size(); k += targets)
            morphs.weights.emplace_back(numbers.begin() + static_cast<std::ptrdiff_t>(k),
                                        numbers.begin() + static_cast<std::ptrdiff_t>(k + targets));
        return morphs;
    }

    std::size_t targets_of(std::size_t node) const {
        const auto mesh = document_.number(document_.at("nodes", node), "mesh", primitives_.size());
        if (!mesh || primitives_[*mesh].empty()) return 0;
        return model_.meshes[static_cast<std::size_t>(primitives_[*mesh].front())].targets.size();
    }

    void add_clip(const GltfJson& from) {
        ModelClip clip{.name = from.value("name", ""), .ticks_per_s = 1.0, .channels = {}, .morphs = {}};
        const GltfJson &samplers = from.at("samplers"), &channels = from.at("channels");
        for (const GltfJson& channel : channels) {
            const GltfJson& target = channel.at("target");
            const auto node = document_.number(target, "node", numbers_.size());
            if (!node) continue;  // of an extension
            const GltfJson& sampler = samplers.at(document_.required(channel, "sampler", samplers.size()));
            const std::string path = target.at("path").get<std::string>();
            if (path == "weights") {
                if (const std::size_t targets = targets_of(*node); targets > 0)
                    clip.morphs.push_back(morphs_of(sampler, *node, targets));
                continue;
            }
            ModelChannel& moved = channel_of(clip, *node);
            if (path == "translation") moved.translation = track_of(sampler, 3);
            if (path == "rotation") moved.rotation = track_of(sampler, 4);
            if (path == "scale") moved.scale = track_of(sampler, 3);
        }
        model_.clips.push_back(std::move(clip));
    }

    /// The channel of a node, which at first holds the node's own transform.
    ModelChannel& channel_of(ModelClip& clip, std::size_t node) const {
        const auto found = std::ranges::find(clip.channels, numbers_[node], &ModelChannel::node);
        if (found != clip.channels.end()) return *found;
        const GltfJson& from = document_.at("nodes", node);
        const auto still = [](std::array<double, 4> value) {
            return ModelTrack{.interpolation = Interpolation::step, .times = {0.0}, .values = {value}};
        };
        const auto t = numbers_at<3>(document_, from, "translation", {0, 0, 0}),
                   s = numbers_at<3>(document_, from, "scale", {1, 1, 1});
        clip.channels.push_back({.node = numbers_[node],
                                 .translation = still({t[0], t[1], t[2], 0}),
                                 .rotation = still(numbers_at<4>(document_, from, "rotation", {0, 0, 0, 1})),
                                 .scale = still({s[0], s[1], s[2], 0})});
        return clip.channels.back();
    }

    GltfDocument document_;
    Model model_;
    std::vector<std::vector<int>> primitives_;  // of each mesh of the file: meshes of the model
    std::vector<int> numbers_;                  // of each node of the file: in the model
};

}  // namespace

bool is_gltf_2(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::array<char, 8> start{};
    in.read(start.data(), start.size());
    if (std::memcmp(start.data(), "glTF", 4) == 0) return start[4] == 2;
    const std::size_t mark = encoding_mark({start.data(), start.size()}, file);
    const auto first = std::ranges::find_if(start.begin() + mark, start.end(),
                                            [](char letter) { return !std::isspace(static_cast<unsigned char>(letter)); });
    if (first == start.end() || *first != '{') return false;
    in.clear();
    in.seekg(0);
    // The document's own `asset` alone; a text that is no JSON is refused by whoever reads it.
    const GltfJson document = GltfJson::parse(
        in,
        [](int depth, GltfJson::parse_event_t event, GltfJson& parsed) {
            return depth != 1 || event != GltfJson::parse_event_t::key || parsed == "asset";
        },
        false);
    if (!document.is_object()) return true;
    const auto asset = document.find("asset");
    if (asset == document.end() || !asset->is_object() || !asset->contains("version")) return false;
    const GltfJson& version = asset->at("version");  // files of version 1 give a number, too
    return version.is_string() && version.get<std::string>().starts_with("2");
}

Model read_gltf(const std::string& file) {
    try {
        return GltfReader(file).read();
    } catch (const GltfJson::exception& error) {
        throw SceneError(file, std::string("is no proper glTF: ") + error.what());
    }
}

}  // namespace percale::scenes
