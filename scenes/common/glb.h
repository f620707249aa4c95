#pragma once

#include <cstdint>
#include <string>

namespace percale::scenes {

// Numbers that glTF 2.0 gives to types of components and targets of views.
enum class GlbComponent : int { unsigned_byte = 5121, unsigned_short = 5123, unsigned_int = 5125, float_number = 5126 };
enum class GlbTarget : int { none = 0, vertices = 34962, indices = 34963 };

/// Types of chunks: "JSON" and "BIN".
inline constexpr std::uint32_t glb_json_chunk = 0x4E4F534A, glb_binary_chunk = 0x004E4942;

/// The largest file size that a header can state, bytes.
inline constexpr std::uint64_t max_glb_bytes = 0xffffffffu;

/// What stands before the bytes of a GLB file's buffer: header, the JSON chunk padded with spaces, the buffer chunk's header. The
/// number of its bytes is a multiple of 4. Throws SceneError for more than a header can state.
std::string glb_start(std::string json, std::uint64_t buffer_bytes);

}  // namespace percale::scenes
