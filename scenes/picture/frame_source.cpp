#include "picture/frame_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/nearest_name.h"
#include "common/text.h"
#include "export/run_report.h"
#include "meshes/mesh_facts.h"
#include "meshes/mesh_import.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

/// "frames/NAME_00012.obj" to NAME.
std::string shape_name(const std::string& file) {
    const std::string stem = std::filesystem::path(file).stem().string();
    return stem.substr(0, stem.rfind('_'));
}

void check_drawable(const std::string& folder, const std::string& file) {
    const std::string ending = extension_of(file);
    if (ending == ".obj" || ending == ".ply") return;
    throw SceneError(folder + "/" + file +
                     ": of frames in this format no picture can be made; write obj or ply too, as by --frames obj," +
                     (ending.empty() ? "ply" : ending.substr(1)));
}

/// The PLY file that goes with a frame's mesh: itself, or one of the same name beside it; "" if there is none.
std::string ply_beside(const FrameRecord& record, const std::string& file) {
    const std::string ply = std::filesystem::path(file).replace_extension(".ply").string();
    const bool there = ply == file || std::ranges::find(record.others, ply) != record.others.end();
    return there ? ply : std::string();
}

bool is_closed(const TriangleMesh& mesh) { return mesh_facts(mesh).watertight(); }

}  // namespace

FrameSource FrameSource::of_run(const std::string& folder, const ShownChoice& choice) {
    const std::filesystem::path path = std::filesystem::path(folder).lexically_normal();
    FrameSource source((path.has_filename() ? path : path.parent_path()).filename().string(), true, choice);
    for (const FrameRecord& record : read_frame_records(folder)) {
        if (record.cloths.empty()) throw SceneError(folder + ": the run wrote no frames (--frames none), so none can be drawn");
        Frame frame{record.index, record.time, {}};
        for (const bool is_cloth : {true, false}) {
            for (const std::string& file : is_cloth ? record.cloths : record.obstacles) {
                check_drawable(folder, file);
                const std::string ply = is_cloth ? ply_beside(record, file) : std::string();
                frame.shapes.push_back({folder + "/" + file, ply.empty() ? ply : folder + "/" + ply, shape_name(file), is_cloth});
            }
        }
        source.frames_.push_back(std::move(frame));
    }
    if (source.frames_.empty()) throw SceneError(folder + ": the report lists no frames");
    source.check_names();
    return source;
}

FrameSource FrameSource::of_meshes(const std::vector<std::string>& files, const ShownChoice& choice) {
    FrameSource source(std::filesystem::path(files.at(0)).stem().string(), false, choice);
    Frame frame;
    bool all_closed = true;
    for (const std::string& file : files) {
        const TriangleMesh& mesh = source.bodies_.emplace(file, import_mesh(file, 1.0, &source.warnings_)).first->second;
        const bool closed = is_closed(mesh);
        all_closed = all_closed && closed;
        const std::string ply = extension_of(file) == ".ply" ? file : std::string();
        frame.shapes.push_back({file, ply, std::filesystem::path(file).stem().string(), !closed});
    }
    if (all_closed && files.size() > 1)
        for (Shape& shape : frame.shapes) shape.is_cloth = true;
    source.frames_.push_back(std::move(frame));
    source.check_names();
    return source;
}

void FrameSource::check_names() const {
    std::vector<std::string> names;
    for (const Shape& shape : frames_.front().shapes) names.push_back(shape.name);
    const auto check = [&](const std::string& name, const char* option) {
        if (std::ranges::find(names, name) == names.end())
            throw SceneError(std::string(option) + " " + name + ": no cloth or body of '" + name_ + "' has that name" +
                             suggestion(name, names));
    };
    for (const std::string& name : choice_.hidden) check(name, "--hide");
    for (const auto& [name, colour] : choice_.colours) check(name, "--colour");
}

int FrameSource::nearest_frame(double time) const {
    const auto off = [&](const Frame& frame) { return std::abs(frame.time - time); };
    return static_cast<int>(std::ranges::min_element(frames_, {}, off) - frames_.begin());
}

const TriangleMesh& FrameSource::body(const std::string& file, std::map<std::string, TriangleMesh>& used) {
    if (const auto found = bodies_.find(file); found != bodies_.end())
        return used.insert(bodies_.extract(found)).position->second;
    const auto found = used.find(file);
    return found != used.end() ? found->second : used.emplace(file, import_mesh(file)).first->second;
}

std::vector<double> FrameSource::field_of(const Shape& shape, const TriangleMesh& cloth, const ShownFrame& frame) const {
    const PictureField& field = *choice_.field;
    if (!shape.ply_file.empty()) {
        MeshFields fields;
        import_mesh_with_fields(shape.ply_file, fields.vertex);
        std::vector<double> values = values_of_file(field, fields);
        if (!values.empty()) return values;
    }
    if (field.word == "distance") return distances_to_bodies(field, cloth, frame.shapes);
    throw SceneError(shape.file + ": has no " + field.word +
                     (is_run_ ? "; run the scene with output.fields = [\"" + field.output_word +
                                    "\"] and frames in PLY, as by --set 'output.fields=[\"" + field.output_word +
                                    "\"]' --frames obj,ply"
                              : "; the PLY frames of a run with output.fields have it"));
}

void FrameSource::colour(ShownFrame& frame) const {
    std::size_t cloths = 0, bodies = 0;
    for (ShownShape& shape : frame.shapes) {
        shape.colour = shape.is_cloth ? cloth_colour(cloths++) : body_colour(bodies++);
        if (const auto found = choice_.colours.find(shape.name); found != choice_.colours.end()) shape.colour = found->second;
    }
}

ShownFrame FrameSource::load(int number) {
    const Frame& frame = frames_.at(static_cast<std::size_t>(number));
    ShownFrame shown{frame.index, frame.time, {}};
    std::map<std::string, TriangleMesh> used;
    for (const Shape& shape : frame.shapes) {
        const bool kept = !shape.is_cloth || !is_run_;
        shown.shapes.push_back({shape.name, shape.is_cloth, kept ? body(shape.file, used) : import_mesh(shape.file)});
    }
    bodies_ = std::move(used);
    colour(shown);
    for (std::size_t k = 0; choice_.field != nullptr && k < frame.shapes.size(); ++k) {
        ShownShape& shape = shown.shapes[k];
        if (shape.is_cloth) shape.field = field_of(frame.shapes[k], shape.mesh, shown);
        if (!shape.field.empty() && shape.field.size() != shape.mesh.vertices.size())
            throw SceneError(frame.shapes[k].ply_file + ": is of another mesh than " + frame.shapes[k].file);
    }
    std::erase_if(shown.shapes,
                  [&](const ShownShape& shape) { return std::ranges::find(choice_.hidden, shape.name) != choice_.hidden.end(); });
    if (shown.shapes.empty()) throw SceneError("nothing is shown: all shapes of '" + name_ + "' are hidden");
    return shown;
}

}  // namespace percale::scenes
