#include "meshes/ply_output.h"

#include <cstdint>

#include "common/bytes.h"
#include "common/whole_file.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

void append_values(std::string& bytes, const std::vector<MeshField>& fields, std::size_t item) {
    for (const MeshField& field : fields) append_float(bytes, field.values[item]);
}

/// The header's lines of fields; checks their number of values.
std::string field_lines(const std::string& file, const std::vector<MeshField>& fields, std::size_t count) {
    std::string lines;
    for (const MeshField& field : fields) {
        if (field.values.size() != count)
            throw SceneError(file, "field " + field.name + " has " + std::to_string(field.values.size()) + " values for " +
                                       std::to_string(count) + " places");
        lines += "property float " + field.name + "\n";
    }
    return lines;
}

}  // namespace

void write_ply(const std::string& file, const TriangleMesh& mesh, const MeshFields& fields) {
    const std::size_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
                        "\nproperty double x\nproperty double y\nproperty double z\n" +
                        field_lines(file, fields.vertex, vertices) + "element face " + std::to_string(triangles) +
                        "\nproperty list uchar int vertex_indices\n" + field_lines(file, fields.triangle, triangles) +
                        "end_header\n";
    bytes.reserve(bytes.size() + vertices * (24 + 4 * fields.vertex.size()) + triangles * (13 + 4 * fields.triangle.size()));
    for (std::size_t v = 0; v < vertices; ++v) {
        for (int k = 0; k < 3; ++k) append_double(bytes, mesh.vertices[v][k]);
        append_values(bytes, fields.vertex, v);
    }
    for (std::size_t t = 0; t < triangles; ++t) {
        bytes += static_cast<char>(3);
        for (const int corner : mesh.triangles[t]) append_little(bytes, static_cast<std::uint32_t>(corner));
        append_values(bytes, fields.triangle, t);
    }
    write_whole_file(file, bytes);
}

}  // namespace percale::scenes
