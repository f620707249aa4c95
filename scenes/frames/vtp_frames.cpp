#include "frames/vtp_frames.h"

#include "common/bytes.h"
#include "common/text.h"
#include "common/whole_file.h"
#include "frames/frame_folder.h"
#include "frames/numbered_frames.h"
#include "report/svg_text.h"

namespace percale::scenes {

namespace {

constexpr const char* collection_file = "frames/scene.pvd";

/// Arrays of a VTP file: what their elements say, and their bytes behind one another, each after its length.
class AppendedArrays {
public:
    /// An element `<DataArray ...>` for bytes that `put` appends.
    template <class Put>
    std::string add(const std::string& type, const std::string& name, int components, Put put) {
        const std::size_t offset = bytes_.size();
        append_little(bytes_, std::uint64_t{0});
        put(bytes_);
        std::string length;
        append_little(length, std::uint64_t{bytes_.size() - offset - sizeof(std::uint64_t)});
        bytes_.replace(offset, length.size(), length);
        return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" + std::to_string(components) +
               "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
    }

    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

std::string field_elements(AppendedArrays& arrays, const std::vector<MeshField>& fields) {
    std::string elements;
    for (const MeshField& field : fields)
        elements += arrays.add("Float64", field.name, 1, [&](std::string& bytes) {
            for (const double value : field.values) append_double(bytes, value);
        });
    return elements;
}

/// VTK's file format, "XML file formats": appended data, raw, lengths of 64 bits.
std::string vtp_text(const TriangleMesh& mesh, const MeshFields& fields) {
    AppendedArrays arrays;
    const std::string points = arrays.add("Float64", "Points", 3, [&](std::string& bytes) {
        for (const Vec3& x : mesh.vertices)
            for (const double coordinate : x) append_double(bytes, coordinate);
    });
    const std::string corners = arrays.add("Int32", "connectivity", 1, [&](std::string& bytes) {
        for (const Triangle& triangle : mesh.triangles)
            for (const int corner : triangle) append_little(bytes, static_cast<std::uint32_t>(corner));
    });
    const std::string ends = arrays.add("Int32", "offsets", 1, [&](std::string& bytes) {
        for (std::size_t t = 1; t <= mesh.triangles.size(); ++t) append_little(bytes, static_cast<std::uint32_t>(3 * t));
    });
    const std::string of_points = field_elements(arrays, fields.vertex), of_cells = field_elements(arrays, fields.triangle);
    return "<?xml version=\"1.0\"?>\n"
           "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
           "<Piece NumberOfPoints=\"" +
           std::to_string(mesh.vertices.size()) +
           "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
           std::to_string(mesh.triangles.size()) + "\">\n<PointData>\n" + of_points + "</PointData>\n<CellData>\n" + of_cells +
           "</CellData>\n<Points>\n" + points + "</Points>\n<Polys>\n" + corners + ends +
           "</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" + arrays.bytes() +
           "\n</AppendedData>\n</VTKFile>\n";
}

/// Numbered files, and at the end the collection.
class VtpFrames final : public FrameEncoder {
public:
    explicit VtpFrames(const FrameCast& cast) : cast_(cast), numbered_(numbered_frames(cast, ".vtp", write_vtp)) {}

    FrameFiles write(const FrameShapes& frame, FrameFolder& folder) override {
        FrameFiles files = numbered_->write(frame, folder);
        files.others.push_back(collection_file);
        return files;
    }

    void finish(std::span<const double> times, FrameFolder& folder) override {
        std::string text =
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
        for (std::size_t k = 0; k < times.size(); ++k) {
            int part = 0;
            const int frame = static_cast<int>(k);
            for (const std::string& cloth : cast_.cloths)
                text += entry(times[k], part++, cloth, numbered_name(cloth, frame, ".vtp"));
            for (std::size_t i = 0; i < cast_.obstacles.size(); ++i)
                text += entry(times[k], part++, cast_.obstacles[i],
                              "../obstacles/" + numbered_name(cast_.obstacles[i], cast_.obstacle_moves[i] ? frame : 0, ".vtp"));
        }
        text += "</Collection>\n</VTKFile>\n";
        folder.write(collection_file, [&](const std::string& path) { write_whole_file(path, text); });
    }

    int first_frame_of(const std::string& name) const override {
        return name == collection_file ? 0 : numbered_->first_frame_of(name);
    }
    bool is_made_at_end(const std::string& name) const override { return name == collection_file; }

private:
    static void write_vtp(const std::string& path, const NumberedMesh& shape) {
        write_whole_file(path, vtp_text(shape.mesh, shape.fields));
    }

    static std::string entry(double time, int part, const std::string& name, const std::string& file) {
        return "<DataSet timestep=\"" + number_text(time) + "\" part=\"" + std::to_string(part) + "\" name=\"" +
               svg_escaped(name) + "\" file=\"" + svg_escaped(file) + "\"/>\n";
    }

    FrameCast cast_;
    std::unique_ptr<FrameEncoder> numbered_;
};

}  // namespace

FrameFormat vtp_frames() {
    return {
        .word = "vtp",
        .sentence = "a VTK file for every mesh and frame, with output.fields, and frames/scene.pvd with their times (ParaView)",
        .endings = {".vtp", ".pvd"},
        .holds_fields = true,
        .bytes =
            [](const MeshCounts& mesh) {
                return FrameBytes{0.0, (24.0 + 8.0 * mesh.vertex_fields) * mesh.vertices +
                                           (16.0 + 8.0 * mesh.triangle_fields) * mesh.triangles};
            },
        .make = [](const FrameCast& cast) { return std::make_unique<VtpFrames>(cast); }};
}

}  // namespace percale::scenes
