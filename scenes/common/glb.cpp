#include "common/glb.h"

#include "common/bytes.h"
#include "percale/error.h"

namespace percale::scenes {

std::string glb_start(std::string json, std::uint64_t buffer_bytes) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::uint64_t total = 28 + json.size() + buffer_bytes;
    if (total > max_glb_bytes)
        throw SceneError("a GLB file of " + std::to_string(total) + " bytes: it holds at most " + std::to_string(max_glb_bytes));
    std::string bytes;
    // "glTF", version 2, bytes of the file; bytes of the JSON and "JSON"; bytes of the buffer and "BIN".
    for (const std::uint64_t word : {std::uint64_t{0x46546C67}, std::uint64_t{2}, total})
        append_little(bytes, static_cast<std::uint32_t>(word));
    for (const std::uint64_t word : {std::uint64_t{json.size()}, std::uint64_t{glb_json_chunk}})
        append_little(bytes, static_cast<std::uint32_t>(word));
    bytes += json;
    for (const std::uint64_t word : {buffer_bytes, std::uint64_t{glb_binary_chunk}})
        append_little(bytes, static_cast<std::uint32_t>(word));
    return bytes;
}

}  // namespace percale::scenes
