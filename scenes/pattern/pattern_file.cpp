#include "pattern/pattern_file.h"

#include "meshes/mesh_import.h"
#include "pattern/pattern_check.h"
#include "pattern/pattern_json.h"
#include "pattern/pattern_toml.h"
#include "percale/error.h"

namespace percale::scenes {

Pattern read_pattern(const std::string& file) {
    const std::string extension = extension_of(file);
    if (extension != ".toml" && extension != ".json") {
        throw SceneError(file, "is no sewing pattern by its name: .toml (Percale's own) or .json (GarmentCode's)");
    }
    Pattern pattern = extension == ".toml" ? read_pattern_toml(file) : read_pattern_json(file);
    check_pattern(pattern);
    return pattern;
}

}  // namespace percale::scenes
