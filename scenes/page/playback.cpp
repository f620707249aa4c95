#include "page/playback.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "common/text.h"
#include "frames/cloth_fit.h"
#include "meshes/mesh_import.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

constexpr const char* own_strain = "edge_change";
constexpr const char* own_distance = "distance";

/// The files of one run and how they are read.
struct PlaybackSource {
    const std::string& folder;
    std::span<const FrameRecord> records;
    const PlaybackOptions& options;

    std::string path(const std::string& file) const { return folder + "/" + file; }
};

struct ShownMesh {
    TriangleMesh mesh;
    std::vector<MeshField> fields;
};

ShownMesh read_shown(const std::string& file) {
    const std::string format = extension_of(file);
    if (format != ".obj" && format != ".ply")
        throw SceneError(file + ": a page can show frames in OBJ and PLY only; run the scene with --frames obj or --frames ply");
    ShownMesh shown;
    shown.mesh = import_mesh_with_fields(file, shown.fields);
    return shown;
}

void check_records(const PlaybackSource& source) {
    const FrameRecord& first = source.records.front();
    for (const FrameRecord& record : source.records) {
        if (record.cloths.size() == first.cloths.size() && record.obstacles.size() == first.obstacles.size()) continue;
        throw SceneError(source.folder + "/report.json: frame " + std::to_string(record.index) + " lists " +
                         counted(static_cast<long>(record.cloths.size()), "cloth") + " and " +
                         counted(static_cast<long>(record.obstacles.size()), "obstacle") + ", frame 0 " +
                         std::to_string(first.cloths.size()) + " and " + std::to_string(first.obstacles.size()));
    }
}

/// Checks the files of all frames, also of those that the page leaves out: an incomplete folder is not the run that it claims to
/// be.
void check_files(const PlaybackSource& source) {
    std::error_code error;
    for (const FrameRecord& record : source.records)
        for (const auto* files : {&record.cloths, &record.obstacles})
            for (const std::string& file : *files)
                if (!std::filesystem::exists(source.path(file), error))
                    throw SceneError(source.path(file) + ": is missing; report.json lists it");
}

bool has_field(const std::vector<MeshField>& fields, const std::string& start) {
    return std::ranges::any_of(fields, [&](const MeshField& field) { return field.name.starts_with(start); });
}

/// Adds the fields of cloth that a page has beyond its frames.
void add_own_fields(ShownMesh& cloth, const TriangleMesh& first, std::span<const TriangleMesh> obstacles, bool distances) {
    if (!has_field(cloth.fields, "strain")) cloth.fields.push_back({own_strain, edge_change(first, cloth.mesh.vertices)});
    if (distances && !obstacles.empty() && !has_field(cloth.fields, own_distance))
        cloth.fields.push_back({own_distance, obstacle_distances(cloth.mesh.vertices, obstacles)});
}

std::vector<std::string> own_names(const std::vector<MeshField>& of_files) {
    std::vector<std::string> names;
    if (!has_field(of_files, "strain")) names.push_back(own_strain);
    if (!has_field(of_files, own_distance)) names.push_back(own_distance);
    return names;
}

/// All meshes of a run on their way through its frames.
class PlaybackTracks {
public:
    PlaybackTracks(const PlaybackSource& source, const RunCast& cast);

    /// What all frames take as text besides the mesh of each, and what each takes.
    std::size_t fixed_bytes() const { return fixed_bytes_; }
    std::size_t frame_bytes() const { return frame_bytes_; }
    void add(const FrameRecord& record);
    std::vector<PlaybackMesh> meshes() const;

private:
    void begin(const std::string& name, std::size_t place, bool is_cloth);
    void count(const TriangleMesh& mesh, std::size_t fields, bool moves);

    PlaybackSource source_;
    std::vector<MeshTrack> cloths_, obstacles_;
    std::vector<bool> moves_;                    // of obstacles
    std::vector<TriangleMesh> obstacle_meshes_;  // of the frame
    std::size_t fixed_bytes_ = 0, frame_bytes_ = 0;
};

PlaybackTracks::PlaybackTracks(const PlaybackSource& source, const RunCast& cast) : source_(source) {
    const FrameRecord& first = source.records.front();
    for (std::size_t i = 0; i < first.obstacles.size(); ++i) begin(cast.obstacles.at(i), i, false);
    for (std::size_t i = 0; i < first.cloths.size(); ++i) begin(cast.cloths.at(i), i, true);
}

void PlaybackTracks::begin(const std::string& name, std::size_t place, bool is_cloth) {
    const auto file = [&](const FrameRecord& record) { return (is_cloth ? record.cloths : record.obstacles)[place]; };
    const FrameRecord& first = source_.records.front();
    const bool moves =
        is_cloth || std::ranges::any_of(source_.records, [&](const FrameRecord& record) { return file(record) != file(first); });
    ShownMesh shown = read_shown(source_.path(file(first)));
    const std::vector<std::string> own = is_cloth ? own_names(shown.fields) : std::vector<std::string>{};
    const bool measured = is_cloth && std::ranges::count(own, own_distance) > 0;
    const bool unmeasured = measured && (!source_.options.distances || first.obstacles.empty());
    count(shown.mesh, is_cloth ? shown.fields.size() + own.size() - (unmeasured ? 1 : 0) : 0, moves);
    PlaybackMesh described;
    described.name = name;
    described.is_cloth = is_cloth;
    described.moves = moves;
    if (!is_cloth) {
        moves_.push_back(moves);
        obstacle_meshes_.push_back(shown.mesh);
    }
    (is_cloth ? cloths_ : obstacles_).emplace_back(std::move(described), std::move(shown.mesh), own);
}

void PlaybackTracks::count(const TriangleMesh& mesh, std::size_t fields, bool moves) {
    const std::size_t vertices = mesh.vertices.size();
    fixed_bytes_ += base64_size(12 * mesh.triangles.size());
    (moves ? frame_bytes_ : fixed_bytes_) += base64_size(6 * vertices) + fields * base64_size(2 * vertices);
}

void PlaybackTracks::add(const FrameRecord& record) {
    const bool begins = record.index == source_.records.front().index;
    for (std::size_t i = 0; i < obstacles_.size(); ++i) {
        if (!moves_[i] && !begins) continue;
        const std::string file = source_.path(record.obstacles[i]);
        obstacle_meshes_[i] = read_shown(file).mesh;
        obstacles_[i].add(file, obstacle_meshes_[i], {});
    }
    for (std::size_t i = 0; i < cloths_.size(); ++i) {
        const std::string file = source_.path(record.cloths[i]);
        ShownMesh shown = read_shown(file);
        if (shown.mesh.vertices.size() == cloths_[i].first().vertices.size())
            add_own_fields(shown, cloths_[i].first(), obstacle_meshes_, source_.options.distances);
        cloths_[i].add(file, shown.mesh, shown.fields);
    }
}

std::vector<PlaybackMesh> PlaybackTracks::meshes() const {
    std::vector<PlaybackMesh> meshes;
    for (const MeshTrack& cloth : cloths_) meshes.push_back(cloth.packed_mesh());
    for (const MeshTrack& obstacle : obstacles_) meshes.push_back(obstacle.packed_mesh());
    return meshes;
}

std::string megabytes(std::size_t bytes) { return short_number(1e-6 * static_cast<double>(bytes)) + " MB"; }

}  // namespace

Playback read_playback(const std::string& folder, std::span<const FrameRecord> records, const RunCast& cast,
                       const PlaybackOptions& options) {
    Playback playback;
    if (records.empty() || records.front().cloths.empty()) return playback;
    const PlaybackSource source{folder, records, options};
    check_records(source);
    check_files(source);
    PlaybackTracks tracks(source, cast);
    playback.choice = choose_frames(static_cast<int>(records.size()), options.worst_frame, tracks.fixed_bytes(),
                                    tracks.frame_bytes(), options.max_bytes);
    if (playback.choice.shown.empty())
        throw SceneError(folder + ": the first and the last frame alone take " +
                         megabytes(tracks.fixed_bytes() + 2 * tracks.frame_bytes()) + ", which is more than the " +
                         megabytes(options.max_bytes) + " that are left for frames");
    for (const int shown : playback.choice.shown) tracks.add(records[static_cast<std::size_t>(shown)]);
    playback.meshes = tracks.meshes();
    for (const PlaybackMesh& mesh : playback.meshes)
        for (const PackRange& axis : mesh.axes) playback.rounding = std::max(playback.rounding, 0.5 * axis.step);
    return playback;
}

}  // namespace percale::scenes
