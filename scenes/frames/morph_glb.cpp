#include "frames/morph_glb.h"

#include <array>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/bytes.h"
#include "common/glb.h"
#include "common/whole_file.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

using GlbJson = nlohmann::ordered_json;
using Floats = std::vector<float>;

void append_vertices(std::string& bytes, const TriangleMesh& mesh) {
    const std::vector<Vec3> normals = morph_normals(mesh);
    for (const auto* vectors : {&mesh.vertices, &normals})
        for (const Vec3& x : *vectors)
            for (const double coordinate : x) append_float(bytes, coordinate);
}

/// A file of samples, read where it is needed.
class MorphSamples {
public:
    struct Shape {
        std::size_t vertices = 0, triangles = 0;
        bool moves = false;
        std::uint64_t triangles_at = 0;  // byte in the file
        std::uint64_t vertices_at = 0;   // of a resting one in the file, of another in a frame
    };

    explicit MorphSamples(const std::string& file) : file_(file), in_(file, std::ios::binary) {
        const std::size_t count = word();
        std::uint64_t at = 4;
        for (std::size_t i = 0; i < count; ++i) {
            Shape shape{.vertices = word(), .triangles = word(), .moves = word() != 0};
            shape.triangles_at = at + 12;
            at = shape.triangles_at + 12 * shape.triangles;
            shape.vertices_at = shape.moves ? frame_bytes_ : at;
            (shape.moves ? frame_bytes_ : at) += vertex_bytes(shape);
            shapes_.push_back(shape);
            in_.seekg(static_cast<std::streamoff>(at));
        }
        frames_at_ = at;
    }

    const std::vector<Shape>& shapes() const { return shapes_; }

    /// All coordinates of a shape's positions, then of its normals.
    Floats vertices(const Shape& shape, std::size_t frame) {
        const std::uint64_t at = shape.moves ? frames_at_ + frame * frame_bytes_ + shape.vertices_at : shape.vertices_at;
        const std::string bytes = read(at, vertex_bytes(shape));
        Floats floats(6 * shape.vertices);
        for (std::size_t k = 0; k < floats.size(); ++k) floats[k] = float_at(bytes.data() + 4 * k);
        return floats;
    }
    std::string triangles(const Shape& shape) { return read(shape.triangles_at, 12 * shape.triangles); }

private:
    static std::uint64_t vertex_bytes(const Shape& shape) { return 24 * std::uint64_t{shape.vertices}; }

    std::uint32_t word() {
        char bytes[4] = {};
        in_.read(bytes, sizeof bytes);
        if (!in_) throw SceneError(file_ + ": cannot be read");
        return little_at<std::uint32_t>(bytes);
    }
    std::string read(std::uint64_t at, std::uint64_t count) {
        std::string bytes(count, '\0');
        in_.seekg(static_cast<std::streamoff>(at));
        in_.read(bytes.data(), static_cast<std::streamsize>(count));
        if (!in_) throw SceneError(file_ + ": cannot be read");
        return bytes;
    }

    std::string file_;
    std::ifstream in_;
    std::vector<Shape> shapes_;
    std::uint64_t frames_at_ = 0, frame_bytes_ = 0;
};

/// What a target adds to the mesh: the differences of single precision numbers, rounded to such.
Floats differences(const Floats& frame, const Floats& first) {
    Floats all(frame.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<float>(double{frame[k]} - double{first[k]});
    return all;
}

/// The smallest and largest x, y and z among the first half of the numbers, the positions.
std::array<GlbJson, 2> bounds(const Floats& floats) {
    constexpr float far = std::numeric_limits<float>::max();
    std::array<float, 3> lowest = {far, far, far}, highest = {-far, -far, -far};
    for (std::size_t k = 0; k < floats.size() / 2; ++k) {
        lowest[k % 3] = std::min(lowest[k % 3], floats[k]);
        highest[k % 3] = std::max(highest[k % 3], floats[k]);
    }
    return {GlbJson(lowest), GlbJson(highest)};
}

/// The JSON of the file. Views and accessors come in the order of the buffer's bytes.
class MorphDocument {
public:
    MorphDocument() {
        root_["asset"] = {{"version", "2.0"}, {"generator", "percale"}};
        root_["scene"] = 0;
        for (const char* list : {"scenes", "nodes", "meshes", "materials", "accessors", "bufferViews", "buffers"})
            root_[list] = GlbJson::array();
        root_["materials"].push_back(material("cloth", {0.25, 0.45, 0.75, 1.0}));
        root_["materials"].push_back(material("obstacle", {0.72, 0.70, 0.67, 1.0}));
    }

    void view(std::uint64_t bytes, GlbTarget target, int stride = 0) {
        GlbJson view = {{"buffer", 0}, {"byteOffset", buffer_bytes_}, {"byteLength", bytes}};
        if (stride > 0) view["byteStride"] = stride;
        if (target != GlbTarget::none) view["target"] = static_cast<int>(target);
        root_["bufferViews"].push_back(view);
        buffer_bytes_ += bytes;
    }

    /// Adds an accessor in the last view; returns its number.
    std::size_t accessor(const char* type, GlbComponent component, std::uint64_t count, std::uint64_t offset = 0) {
        root_["accessors"].push_back({{"bufferView", root_["bufferViews"].size() - 1},
                                      {"byteOffset", offset},
                                      {"componentType", static_cast<int>(component)},
                                      {"count", count},
                                      {"type", type}});
        return root_["accessors"].size() - 1;
    }

    /// Adds accessors of positions and normals that lie behind one another in the last view.
    GlbJson places_and_normals(const Floats& floats, std::uint64_t offset) {
        const std::size_t vertices = floats.size() / 6;
        const std::size_t places = accessor("VEC3", GlbComponent::float_number, vertices, offset);
        const auto [lowest, highest] = bounds(floats);
        root_["accessors"][places]["min"] = lowest;
        root_["accessors"][places]["max"] = highest;
        const std::size_t normals = accessor("VEC3", GlbComponent::float_number, vertices, offset + 12 * vertices);
        return {{"POSITION", places}, {"NORMAL", normals}};
    }

    void add_node(const MorphName& name, const GlbJson& primitive, std::size_t targets) {
        GlbJson mesh = {{"name", name.name}, {"primitives", GlbJson::array({primitive})}};
        if (targets > 0) mesh["weights"] = std::vector<int>(targets, 0);
        root_["nodes"].push_back({{"name", name.name}, {"mesh", root_["meshes"].size()}});
        root_["meshes"].push_back(mesh);
    }

    void add_animation(std::span<const double> times, const std::vector<std::size_t>& nodes) {
        const std::size_t frames = times.size(), targets = frames - 1;
        view(4 * frames, GlbTarget::none);
        const std::size_t input = accessor("SCALAR", GlbComponent::float_number, frames);
        root_["accessors"][input]["min"] = {static_cast<float>(times.front())};
        root_["accessors"][input]["max"] = {static_cast<float>(times.back())};
        view(4 * frames * targets, GlbTarget::none);
        const std::size_t output = accessor("SCALAR", GlbComponent::float_number, frames * targets);
        GlbJson samplers = GlbJson::array(), channels = GlbJson::array();
        samplers.push_back({{"input", input}, {"interpolation", "LINEAR"}, {"output", output}});
        for (const std::size_t node : nodes)
            channels.push_back({{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}});
        root_["animations"] = GlbJson::array({{{"name", "run"}, {"channels", channels}, {"samplers", samplers}}});
    }

    /// What stands before the bytes of the buffer.
    std::string start() {
        std::vector<std::size_t> nodes(root_["nodes"].size());
        for (std::size_t node = 0; node < nodes.size(); ++node) nodes[node] = node;
        root_["scenes"].push_back({{"nodes", nodes}});
        root_["buffers"].push_back({{"byteLength", buffer_bytes_}});
        return glb_start(root_.dump(-1, ' ', false, GlbJson::error_handler_t::replace), buffer_bytes_);
    }

private:
    static GlbJson material(const char* name, const std::array<double, 4>& color) {
        return {{"name", name},
                {"doubleSided", true},
                {"pbrMetallicRoughness", {{"baseColorFactor", color}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.9}}}};
    }

    GlbJson root_;
    std::uint64_t buffer_bytes_ = 0;
};

/// The JSON's part of one shape, in the order in which write_shape writes its bytes.
void describe_shape(MorphDocument& document, MorphSamples& samples, const MorphSamples::Shape& shape, const MorphName& name,
                    std::size_t frames) {
    document.view(12 * shape.triangles, GlbTarget::indices);
    const std::size_t indices = document.accessor("SCALAR", GlbComponent::unsigned_int, 3 * shape.triangles);
    const std::uint64_t bytes = 24 * std::uint64_t{shape.vertices};
    const Floats first = samples.vertices(shape, 0);
    document.view(bytes, GlbTarget::vertices, 12);
    GlbJson primitive = {
        {"attributes", document.places_and_normals(first, 0)}, {"indices", indices}, {"material", name.is_cloth ? 0 : 1}};
    const std::size_t targets = shape.moves ? frames - 1 : 0;
    if (targets > 0) document.view(targets * bytes, GlbTarget::vertices, 12);
    for (std::size_t k = 1; k <= targets; ++k)
        primitive["targets"].push_back(
            document.places_and_normals(differences(samples.vertices(shape, k), first), (k - 1) * bytes));
    document.add_node(name, primitive, targets);
}

void write_floats(std::ostream& out, const Floats& floats) {
    std::string bytes;
    bytes.reserve(4 * floats.size());
    for (const float number : floats) append_float(bytes, number);
    out << bytes;
}

void write_shape(std::ostream& out, MorphSamples& samples, const MorphSamples::Shape& shape, std::size_t frames) {
    out << samples.triangles(shape);
    const Floats first = samples.vertices(shape, 0);
    write_floats(out, first);
    for (std::size_t k = 1; shape.moves && k < frames; ++k) write_floats(out, differences(samples.vertices(shape, k), first));
}

/// Times, and the weights of all targets at each: at frame k that of target k - 1 is 1.
void write_animation(std::ostream& out, std::span<const double> times) {
    write_floats(out, Floats(times.begin(), times.end()));
    for (std::size_t k = 0; k < times.size(); ++k) {
        Floats weights(times.size() - 1, 0.0f);
        if (k > 0) weights[k - 1] = 1.0f;
        write_floats(out, weights);
    }
}

}  // namespace

std::vector<Vec3> morph_normals(const TriangleMesh& mesh) {
    std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3& x = mesh.vertices[a];
        const Vec3 normal = (mesh.vertices[b] - x).cross(mesh.vertices[c] - x);
        for (const int corner : {a, b, c}) normals[corner] += normal;
    }
    for (Vec3& normal : normals) normal = normal.stableNormalized();
    return normals;
}

std::string morph_header(std::span<const MorphShape> shapes) {
    std::string bytes;
    append_little(bytes, static_cast<std::uint32_t>(shapes.size()));
    for (const MorphShape& shape : shapes) {
        append_little(bytes, static_cast<std::uint32_t>(shape.mesh->vertices.size()));
        append_little(bytes, static_cast<std::uint32_t>(shape.mesh->triangles.size()));
        append_little(bytes, std::uint32_t{shape.moves});
        for (const Triangle& triangle : shape.mesh->triangles)
            for (const int corner : triangle) append_little(bytes, static_cast<std::uint32_t>(corner));
        if (!shape.moves) append_vertices(bytes, *shape.mesh);
    }
    return bytes;
}

std::string morph_frame(std::span<const MorphShape> shapes) {
    std::string bytes;
    for (const MorphShape& shape : shapes)
        if (shape.moves) append_vertices(bytes, *shape.mesh);
    return bytes;
}

void write_morph_glb(const std::string& file, const std::string& samples_file, std::span<const MorphName> names,
                     std::span<const double> times) {
    MorphSamples samples(samples_file);
    MorphDocument document;
    std::vector<std::size_t> moving;
    for (std::size_t i = 0; i < samples.shapes().size(); ++i) {
        const MorphSamples::Shape& shape = samples.shapes()[i];
        describe_shape(document, samples, shape, names[i], times.size());
        if (shape.moves) moving.push_back(i);
    }
    const bool plays = times.size() > 1 && !moving.empty();
    if (plays) document.add_animation(times, moving);
    WholeFile out(file);
    out.out() << document.start();
    for (const MorphSamples::Shape& shape : samples.shapes()) write_shape(out.out(), samples, shape, times.size());
    if (plays) write_animation(out.out(), times);
    out.check();
    out.commit();
}

}  // namespace percale::scenes
