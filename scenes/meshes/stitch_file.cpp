#include "meshes/stitch_file.h"

#include <limits>
#include <optional>

#include "common/input_file.h"
#include "meshes/text_scan.h"
#include "percale/error.h"

namespace percale::scenes {
namespace {

int to_vertex(std::string_view word, const TextPlace& place) {
    const long long vertex = to_integer(word, place, "vertex");
    if (vertex >= 0 && vertex <= std::numeric_limits<int>::max()) return static_cast<int>(vertex);
    fail_at_line(place, "vertex " + std::string(word) + ": vertices are counted from 0");
}

/// What stands on a line behind its keyword.
Stitch read_stitch(std::string_view line, const TextPlace& place) {
    Stitch stitch;
    stitch.vertex = to_vertex(next_word(line), place);
    stitch.from = stitch.to = to_vertex(next_word(line), place);
    const std::string_view third = next_word(line);
    if (!third.empty()) {
        stitch.to = to_vertex(third, place);
        stitch.share = to_double(next_word(line), place, "share t");
    }
    if (!(stitch.share >= 0.0 && stitch.share <= 1.0)) {
        fail_at_line(place, "share t = " + std::to_string(stitch.share) + " is outside the allowed range 0 ... 1");
    }
    const std::string_view more = next_word(line);
    if (!more.empty()) fail_at_line(place, "a stitch is two vertices i j, or i j k t, without " + shown(more));
    return stitch;
}

/// `read` says what a line holds, if it is a stitch.
template <class Read>
std::vector<Stitch> read_lines(const std::string& file, Read read) {
    const std::string content = read_text(file);
    std::vector<Stitch> stitches;
    std::size_t number = 0;
    for (std::string_view text = content; !text.empty();) {
        std::string_view line = take_line(text);
        const TextPlace place{file, ++number};
        const std::optional<Stitch> stitch = read(line.substr(0, line.find('#')), place);
        if (stitch) stitches.push_back(*stitch);
    }
    return stitches;
}

std::vector<Stitch> some(const std::string& file, std::vector<Stitch> stitches) {
    if (stitches.empty()) throw SceneError(file, "no stitches");
    return stitches;
}

}  // namespace

std::vector<Stitch> read_stitch_file(const std::string& file) {
    return some(file, read_lines(file, [](std::string_view line, const TextPlace& place) -> std::optional<Stitch> {
                    std::string_view rest = line;
                    if (next_word(rest).empty()) return std::nullopt;
                    return read_stitch(line, place);
                }));
}

std::vector<Stitch> read_obj_stitches(const std::string& file) { return some(file, find_obj_stitches(file)); }

std::vector<Stitch> find_obj_stitches(const std::string& file) {
    return read_lines(file, [](std::string_view line, const TextPlace& place) -> std::optional<Stitch> {
        if (next_word(line) != "stitch") return std::nullopt;
        return read_stitch(line, place);
    });
}

}  // namespace percale::scenes
