#pragma once

#include <string>
#include <vector>

#include "percale/mesh.h"

namespace percale::scenes {

/// The objects and groups with faces that a file names, for the message where one that is wanted is not among them.
class PartNames {
public:
    /// Adds each name once and "" not at all; keeps at most a thousand names.
    void add(const std::string& name);
    /// Throws SceneError: the file has no such part.
    [[noreturn]] void fail(const std::string& file, const std::string& part) const;

private:
    std::vector<std::string> names_;
};

/// Leaves out vertices that no triangle has; the others keep their order.
void drop_unused_vertices(TriangleMesh& mesh);

}  // namespace percale::scenes
