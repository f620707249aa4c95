#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "percale/mesh.h"
#include "tests/scenes/test_folder.h"

namespace percale::scenes::test {

/// Appends numbers to the bytes of a file.
template <class Number>
void append_bytes(std::string& bytes, Number number, bool big_endian = false) {
    std::string own(sizeof(Number), '\0');
    std::memcpy(own.data(), &number, sizeof(Number));
    bytes += big_endian ? std::string(own.rbegin(), own.rend()) : own;
}

/// A bar along y from 0 to 2 m, 0.2 m wide, in three rings of four vertices, open at its ends. Ring 0 hangs on a root, ring 2 on
/// a joint at y = 1, ring 1 half on each.
struct BendingBar {
    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;

    BendingBar() {
        for (int ring = 0; ring < 3; ++ring)
            for (int k = 0; k < 4; ++k) vertices.emplace_back(k < 2 ? -0.1 : 0.1, ring, k == 0 || k == 3 ? -0.1 : 0.1);
        for (int ring = 0; ring < 2; ++ring) {
            for (int k = 0; k < 4; ++k) {
                const int a = 4 * ring + k, b = 4 * ring + (k + 1) % 4;
                triangles.push_back({a, b, a + 4});
                triangles.push_back({b, b + 4, a + 4});
            }
        }
    }

    /// With the joint turned by an angle about z and the morph target, ring 2 moved by 0.5 m along z, mixed in by `bulge`:
    /// x' = sum w (x in the joint's axes, turned).
    std::vector<Vec3> shape(double angle, double bulge) const {
        std::vector<Vec3> shape;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const int ring = static_cast<int>(i) / 4;
            const Vec3 x = vertices[i] + (ring == 2 ? bulge * Vec3(0, 0, 0.5) : Vec3(0, 0, 0));
            const double c = std::cos(angle), s = std::sin(angle);
            const Vec3 turned(c * x.x() - s * (x.y() - 1.0), 1.0 + s * x.x() + c * (x.y() - 1.0), x.z());
            shape.push_back(x + 0.5 * ring * (turned - x));
        }
        return shape;
    }

    /// As glTF: clip "bend" turns the joint by a quarter within 1 s and back until 2 s; a clip without a name mixes the morph
    /// target in within 0.5 s. Returns the file's path.
    std::string write_gltf(const TestFolder& folder) const {
        std::string bin;
        std::string views, accessors;
        const auto add = [&](const std::string& bytes, const std::string& rest) {
            views += std::string(views.empty() ? "" : ",") + "{\"buffer\":0,\"byteOffset\":" + std::to_string(bin.size()) +
                     ",\"byteLength\":" + std::to_string(bytes.size()) + "}";
            accessors +=
                std::string(accessors.empty() ? "" : ",") + "{\"bufferView\":" + std::to_string(views_++) + "," + rest + "}";
            bin += bytes;
            while (bin.size() % 4 != 0) bin += '\0';
        };
        views_ = 0;
        std::string positions, joints, weights, indices, moves;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const int ring = static_cast<int>(i) / 4;
            for (const double x : vertices[i]) append_bytes(positions, static_cast<float>(x));
            for (const unsigned char j : {0, 1, 0, 0}) append_bytes(joints, j);
            for (const float w : {1.0f - 0.5f * static_cast<float>(ring), 0.5f * static_cast<float>(ring), 0.0f, 0.0f})
                append_bytes(weights, w);
            for (const float d : {0.0f, 0.0f, ring == 2 ? 0.5f : 0.0f}) append_bytes(moves, d);
        }
        for (const Triangle& t : triangles)
            for (const int v : t) append_bytes(indices, static_cast<std::uint16_t>(v));
        std::string inverse;
        for (const float down : {0.0f, -1.0f})
            for (int k = 0; k < 16; ++k) append_bytes(inverse, k % 5 == 0 ? 1.0f : k == 13 ? down : 0.0f);
        std::string times, turns, bulge_times, bulges;
        for (const float t : {0.0f, 1.0f, 2.0f}) append_bytes(times, t);
        for (const float s : {0.0f, std::sqrt(0.5f), 0.0f})
            for (const float q : {0.0f, 0.0f, s, std::sqrt(1.0f - s * s)}) append_bytes(turns, q);
        for (const float t : {0.0f, 0.5f}) append_bytes(bulge_times, t);
        for (const float w : {0.0f, 1.0f}) append_bytes(bulges, w);
        const std::string real = "\"componentType\":5126,\"count\":";
        add(positions, real + "12,\"type\":\"VEC3\",\"min\":[-0.1,0,-0.1],\"max\":[0.1,2,0.1]");
        add(joints, "\"componentType\":5121,\"count\":12,\"type\":\"VEC4\"");
        add(weights, real + "12,\"type\":\"VEC4\"");
        add(indices, "\"componentType\":5123,\"count\":48,\"type\":\"SCALAR\"");
        add(moves, real + "12,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[0,0,0.5]");
        add(inverse, real + "2,\"type\":\"MAT4\"");
        add(times, real + "3,\"type\":\"SCALAR\",\"min\":[0],\"max\":[2]");
        add(turns, real + "3,\"type\":\"VEC4\"");
        add(bulge_times, real + "2,\"type\":\"SCALAR\",\"min\":[0],\"max\":[0.5]");
        add(bulges, real + "2,\"type\":\"SCALAR\"");
        folder.write("bar.bin", bin);
        return folder.write("bar.gltf",
                            R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"name":"bar","mesh":0,"skin":0},{"name":"root","children":[2]},{"name":"joint","translation":[0,1,0]}],
"meshes":[{"name":"bar","weights":[0],"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2},"indices":3,
"targets":[{"POSITION":4}]}]}],
"skins":[{"joints":[1,2],"inverseBindMatrices":5}],
"animations":[{"name":"bend","samplers":[{"input":6,"output":7}],"channels":[{"sampler":0,"target":{"node":2,"path":"rotation"}}]},
{"samplers":[{"input":8,"output":9}],"channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}]}],
"buffers":[{"uri":"bar.bin","byteLength":)" +
                                std::to_string(bin.size()) + "}],\"bufferViews\":[" + views + "],\"accessors\":[" + accessors +
                                "]}");
    }

private:
    mutable int views_ = 0;
};

inline double farthest_apart(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double apart = a.size() == b.size() ? 0.0 : 1e300;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) apart = std::max(apart, (a[i] - b[i]).norm());
    return apart;
}

}  // namespace percale::scenes::test
