#include "bodies/point_cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "bodies/mesh_sequence.h"
#include "common/text.h"
#include "garment/cloth_shape.h"
#include "meshes/mesh_import.h"
#include "models/joined_model.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

/// Samples of a cache. More: its header is of another kind of file.
constexpr long max_samples = 1000000;

constexpr std::string_view pc2_word = "POINTCACHE2";

/// Four bytes of a file as a number of the machine.
template <class Number>
Number number_of(const unsigned char* bytes, bool big_endian) {
    std::array<unsigned char, 4> own;
    std::copy(bytes, bytes + 4, own.begin());
    if (big_endian != (std::endian::native == std::endian::big)) std::reverse(own.begin(), own.end());
    return std::bit_cast<Number>(own);
}

template <class Number>
std::vector<Number> read_numbers(std::istream& in, std::size_t count, bool big_endian, const std::string& file) {
    std::vector<unsigned char> bytes(4 * count);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!in) throw SceneError(file, "ends too early");
    std::vector<Number> numbers;
    for (std::size_t k = 0; k < count; ++k) numbers.push_back(number_of<Number>(&bytes[4 * k], big_endian));
    return numbers;
}

}  // namespace

PointCache::PointCache(const Scene& scene, const ObstacleSpec& obstacle, std::vector<Finding>* warnings)
    : file_(path_beside(scene, obstacle.cache)), unit_(obstacle.unit) {
    check_keeps_vertices(obstacle.mesh, "caches");
    const std::string kind = extension_of(file_);
    if (kind != ".pc2" && kind != ".mdd") throw SceneError(file_, "is no cache that is read: .pc2, .mdd");
    mesh_ = import_mesh(path_beside(scene, obstacle.mesh), unit_, warnings, obstacle.part);
    std::error_code status;
    if (!std::filesystem::is_regular_file(file_, status)) throw SceneError(file_, "no such file");
    std::ifstream in(file_, std::ios::binary);
    if (!in) throw SceneError(file_, std::string("cannot be read: ") + std::strerror(errno));
    if (kind == ".mdd" && obstacle.fps) throw SceneError(file_, "has its own times; fps is for frames and PC2 caches");
    if (kind == ".pc2")
        read_pc2(in, obstacle.fps.value_or(ObstacleSpec::usual_fps));
    else
        read_mdd(in);
}

void PointCache::read_pc2(std::istream& in, double fps) {
    std::array<char, 12> word{};
    in.read(word.data(), word.size());
    if (!in || std::string_view(word.data(), pc2_word.size()) != pc2_word)
        throw SceneError(file_, "does not begin with " + std::string(pc2_word));
    const auto whole = read_numbers<std::int32_t>(in, 2, false, file_);  // version, points
    const auto rates = read_numbers<float>(in, 2, false, file_);         // start, frames a sample
    const std::int32_t samples = read_numbers<std::int32_t>(in, 1, false, file_)[0];
    if (whole[0] != 1) throw SceneError(file_, "is of version " + std::to_string(whole[0]) + ", only 1 is read");
    if (!(rates[1] > 0.0f && std::isfinite(rates[1])))
        throw SceneError(file_, "has " + number_text(rates[1]) + " frames a sample, must be above 0");
    header_ = 32;
    check_counts(whole[1], samples);
    set_equal_times(samples, fps / static_cast<double>(rates[1]));
}

void PointCache::read_mdd(std::istream& in) {
    big_endian_ = true;
    const auto counts = read_numbers<std::int32_t>(in, 2, true, file_);
    header_ = 8 + 4 * static_cast<std::int64_t>(counts[0]);
    check_counts(counts[1], counts[0]);
    const auto stated = read_numbers<float>(in, static_cast<std::size_t>(counts[0]), true, file_);
    std::vector<double> times;
    for (const float time : stated) {
        const double from_first = static_cast<double>(time) - static_cast<double>(stated[0]);
        if (!std::isfinite(time) || (!times.empty() && from_first <= times.back()))
            throw SceneError(file_,
                             "sample " + std::to_string(times.size()) + " is at " + number_text(time) + " s; times must ascend");
        times.push_back(from_first);
    }
    set_times(std::move(times));
}

void PointCache::check_counts(std::int64_t points, std::int64_t samples) const {
    if (points != static_cast<std::int64_t>(mesh_.vertices.size()))
        throw SceneError(file_, "has " + std::to_string(points) + " points, the mesh has " +
                                    std::to_string(mesh_.vertices.size()) + " vertices");
    if (samples < 2 || samples > max_samples)
        throw SceneError(file_, "has " + counted(samples, "sample") + ", must be 2 ... " + std::to_string(max_samples));
    const auto size = static_cast<std::int64_t>(std::filesystem::file_size(file_));
    const std::int64_t claimed = header_ + samples * points * 12;
    if (size < claimed)
        throw SceneError(file_, "has " + std::to_string(size) + " bytes, its header claims " + std::to_string(claimed));
}

std::vector<Vec3> PointCache::load(int sample) const {
    std::ifstream in(file_, std::ios::binary);
    in.seekg(header_ + 12 * static_cast<std::int64_t>(mesh_.vertices.size()) * sample);
    const auto numbers = read_numbers<float>(in, 3 * mesh_.vertices.size(), big_endian_, file_);
    std::vector<Vec3> vertices;
    for (std::size_t k = 0; k < mesh_.vertices.size(); ++k) {
        vertices.push_back(unit_ * Vec3(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]));
        if (!vertices.back().allFinite()) check_finite(vertices.back(), k, file_ + ": sample " + std::to_string(sample));
    }
    return vertices;
}

}  // namespace percale::scenes
