#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "percale/mesh.h"
#include "scenes/common/bytes.h"

namespace percale::scenes::test {

/// As much of a GLB file as our animations need, read by what glTF 2.0 says.
class GlbReader {
public:
    explicit GlbReader(const std::string& bytes) {
        const std::size_t length = little_at<std::uint32_t>(bytes.data() + 12);
        json = nlohmann::json::parse(bytes.substr(20, length));
        buffer_ = bytes.substr(28 + length);
        if (little_at<std::uint32_t>(bytes.data() + 8) != bytes.size() || buffer_.size() != json["buffers"][0]["byteLength"])
            throw std::runtime_error("the lengths in the file are not its own");
    }

    std::vector<float> floats(std::size_t accessor) const {
        const nlohmann::json& a = json["accessors"][accessor];
        const std::size_t numbers = a["count"].get<std::size_t>() * (a["type"] == "VEC3" ? 3 : 1);
        const char* start = place(a, 4 * numbers);
        std::vector<float> all(numbers);
        for (std::size_t k = 0; k < numbers; ++k) all[k] = float_at(start + 4 * k);
        return all;
    }

    std::vector<int> indices(std::size_t accessor) const {
        const nlohmann::json& a = json["accessors"][accessor];
        const std::size_t count = a["count"];
        const char* start = place(a, 4 * count);
        std::vector<int> all(count);
        for (std::size_t k = 0; k < count; ++k) all[k] = static_cast<int>(little_at<std::uint32_t>(start + 4 * k));
        return all;
    }

    const nlohmann::json& primitive(std::size_t node) const {
        return json["meshes"][json["nodes"][node]["mesh"].get<std::size_t>()]["primitives"][0];
    }

    /// Places, or normals, of a node at a key of the animation: x + sum of w_k d_k in single precision.
    std::vector<float> morphed(std::size_t node, std::size_t key, const char* attribute = "POSITION") const {
        const nlohmann::json& mesh = primitive(node);
        std::vector<float> x = floats(mesh["attributes"][attribute]);
        if (!mesh.contains("targets")) return x;
        const std::vector<float> weights = floats(json["animations"][0]["samplers"][0]["output"]);
        const std::size_t targets = mesh["targets"].size();
        for (std::size_t target = 0; target < targets; ++target) {
            const std::vector<float> d = floats(mesh["targets"][target][attribute]);
            const float weight = weights.at(key * targets + target);
            for (std::size_t k = 0; k < x.size(); ++k) x[k] += weight * d[k];
        }
        return x;
    }

    nlohmann::json json;

private:
    const char* place(const nlohmann::json& accessor, std::size_t bytes) const {
        const nlohmann::json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        const std::size_t offset = accessor.value("byteOffset", 0);
        if (offset + bytes > view["byteLength"]) throw std::runtime_error("an accessor reaches beyond its view");
        return buffer_.data() + view["byteOffset"].get<std::size_t>() + offset;
    }

    std::string buffer_;
};

}  // namespace percale::scenes::test
