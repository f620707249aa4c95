#include "frames/point_cache_frames.h"

#include <fstream>

#include "common/bytes.h"
#include "common/whole_file.h"
#include "frames/frame_folder.h"
#include "frames/obj_frames.h"
#include "percale/error.h"

namespace percale::scenes {

namespace {

constexpr const char* cache_mesh_ending = ".mesh.obj";

/// What both formats have in common: which shapes have a cache, and the meshes beside it.
class CacheFrames : public FrameEncoder {
public:
    CacheFrames(const FrameCast& cast, std::string ending) : cast_(cast), ending_(std::move(ending)) {}

    FrameFiles write(const FrameShapes& frame, FrameFolder& folder) override {
        FrameFiles files;
        for (std::size_t i = 0; i < frame.cloths.size(); ++i)
            files.cloths.push_back(write_shape("frames/" + cast_.cloths[i], obj_file(cast_.cloth_files, i), frame,
                                               frame.cloths[i], folder, files.others));
        for (std::size_t i = 0; i < frame.obstacles.size(); ++i) {
            const std::string name = "obstacles/" + cast_.obstacles[i];
            if (cast_.obstacle_moves[i]) {
                files.obstacles.push_back(
                    write_shape(name, obj_file(cast_.obstacle_files, i), frame, frame.obstacles[i], folder, files.others));
                continue;
            }
            files.obstacles.push_back(name + cache_mesh_ending);
            if (frame.index == 0) write_mesh(name, obj_file(cast_.obstacle_files, i), frame.obstacles[i], folder);
        }
        return files;
    }

    int first_frame_of(const std::string& name) const override {
        for (std::size_t i = 0; i < cast_.cloths.size(); ++i)
            if (is_of(name, "frames/" + cast_.cloths[i], true)) return 0;
        for (std::size_t i = 0; i < cast_.obstacles.size(); ++i)
            if (is_of(name, "obstacles/" + cast_.obstacles[i], cast_.obstacle_moves[i])) return 0;
        return -1;
    }

protected:
    /// Begins the cache of one shape; `start`: NAME.pc2 without its ending.
    virtual void begin(const std::string& start, int vertices, FrameFolder& folder) = 0;
    virtual void append(const std::string& start, const std::string& floats, FrameFolder& folder) = 0;
    virtual void append_number(std::string& bytes, double number) const = 0;
    virtual std::vector<std::string> endings() const = 0;

    /// All shapes with a cache, by the start of their file's name.
    std::vector<std::string> cached() const {
        std::vector<std::string> starts;
        for (const std::string& cloth : cast_.cloths) starts.push_back("frames/" + cloth);
        for (std::size_t i = 0; i < cast_.obstacles.size(); ++i)
            if (cast_.obstacle_moves[i]) starts.push_back("obstacles/" + cast_.obstacles[i]);
        return starts;
    }
    double fps() const { return cast_.fps; }
    const std::string& ending() const { return ending_; }

private:
    static std::string obj_file(const std::vector<std::string>& files, std::size_t i) { return files.empty() ? "" : files[i]; }

    bool is_of(const std::string& name, const std::string& start, bool moves) const {
        if (name == start + cache_mesh_ending) return true;
        for (const std::string& ending : endings())
            if (moves && name == start + ending) return true;
        return false;
    }

    void write_mesh(const std::string& start, const std::string& source, const TriangleMesh& mesh, FrameFolder& folder) {
        folder.write(start + cache_mesh_ending, [&](const std::string& path) { meshes_.write(path, mesh, source); });
    }

    std::string write_shape(const std::string& start, const std::string& source, const FrameShapes& frame,
                            const TriangleMesh& mesh, FrameFolder& folder, std::vector<std::string>& others) {
        if (frame.index == 0) {
            write_mesh(start, source, mesh, folder);
            begin(start, static_cast<int>(mesh.vertices.size()), folder);
        }
        std::string floats;
        floats.reserve(12 * mesh.vertices.size());
        for (const Vec3& x : mesh.vertices)
            for (const double coordinate : x) append_number(floats, coordinate);
        append(start, floats, folder);
        others.push_back(start + cache_mesh_ending);
        return start + ending_;
    }

    FrameCast cast_;
    std::string ending_;
    ObjMeshes meshes_;
};

/// Little-endian; the number of samples is put in at the end.
class Pc2Frames final : public CacheFrames {
public:
    explicit Pc2Frames(const FrameCast& cast) : CacheFrames(cast, ".pc2") {}

    void finish(std::span<const double> times, FrameFolder& folder) override {
        constexpr int samples_at = 28;
        std::string count;
        append_little(count, static_cast<std::uint32_t>(times.size()));
        for (const std::string& start : cached()) folder.grown(start + ending()).seekp(samples_at) << count;
    }

protected:
    void begin(const std::string& start, int vertices, FrameFolder& folder) override {
        std::string header("POINTCACHE2\0", 12);
        append_little(header, std::uint32_t{1});
        append_little(header, static_cast<std::uint32_t>(vertices));
        append_float(header, 0.0);  // the frame of the first sample
        append_float(header, 1.0);  // frames a sample
        append_little(header, std::uint32_t{0});
        folder.grown(start + ending()) << header;
    }
    void append(const std::string& start, const std::string& floats, FrameFolder& folder) override {
        folder.grown(start + ending()) << floats;
    }
    void append_number(std::string& bytes, double number) const override { append_float(bytes, number); }
    std::vector<std::string> endings() const override { return {".pc2"}; }
};

/// Big-endian. The times of all samples come first, so that the samples grow elsewhere until the run ends.
class MddFrames final : public CacheFrames {
public:
    explicit MddFrames(const FrameCast& cast) : CacheFrames(cast, ".mdd") {}

    void finish(std::span<const double> times, FrameFolder& folder) override {
        for (const std::string& start : cached()) {
            const std::string samples = folder.scratch(start + scratch_ending);
            folder.write(start + ending(), [&](const std::string& path) { write_whole(path, samples, times); });
        }
    }
    bool is_made_at_end(const std::string& name) const override { return name.ends_with(ending()); }

protected:
    void begin(const std::string& start, int vertices, FrameFolder& folder) override {
        std::string count;
        append_big(count, static_cast<std::uint32_t>(vertices));
        folder.grown(start + scratch_ending) << count;
    }
    void append(const std::string& start, const std::string& floats, FrameFolder& folder) override {
        folder.grown(start + scratch_ending) << floats;
    }
    void append_number(std::string& bytes, double number) const override { append_big_float(bytes, number); }
    std::vector<std::string> endings() const override { return {".mdd", scratch_ending}; }

private:
    static constexpr const char* scratch_ending = ".mdd.samples";

    static void write_whole(const std::string& path, const std::string& samples, std::span<const double> times) {
        std::ifstream in(samples, std::ios::binary);
        char vertices[4] = {};
        in.read(vertices, sizeof vertices);
        std::string header;
        append_big(header, static_cast<std::uint32_t>(times.size()));
        header.append(vertices, sizeof vertices);
        for (const double time : times) append_big_float(header, time);
        WholeFile file(path);
        file.out() << header;
        if (!times.empty()) file.out() << in.rdbuf();
        if (!in) throw SceneError(samples + ": cannot be read");
        file.check();
        file.commit();
    }
};

FrameBytes cache_bytes(const MeshCounts& mesh) { return {60.0 * mesh.vertices + 20.0 * mesh.triangles, 12.0 * mesh.vertices}; }

}  // namespace

FrameFormat pc2_frames() {
    return {.word = "pc2",
            .sentence = "a point cache for every mesh, single precision, and the mesh to play it on (Blender, Maya, 3ds Max)",
            .endings = {".pc2", ".obj"},
            .bytes = cache_bytes,
            .make = [](const FrameCast& cast) { return std::make_unique<Pc2Frames>(cast); }};
}

FrameFormat mdd_frames() {
    return {.word = "mdd",
            .sentence = "the same in LightWave's form, with the times of frames",
            .endings = {".mdd", ".samples", ".obj"},
            .bytes = cache_bytes,
            .make = [](const FrameCast& cast) { return std::make_unique<MddFrames>(cast); }};
}

}  // namespace percale::scenes
