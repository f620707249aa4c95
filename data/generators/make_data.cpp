#include <cstdio>
#include <exception>
#include <filesystem>

#include "generators/shipped_meshes.h"
#include "scenes/common/whole_file.h"
#include "scenes/meshes/obj_file.h"

/// percale_make_data OUTDIR: writes the meshes of data/meshes. Exit code 0, or 2 with one message.
int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "usage: percale_make_data OUTDIR\n");
        return 2;
    }
    try {
        const std::filesystem::path folder = arguments[1];
        std::filesystem::create_directories(folder);
        for (const auto& [file, mesh, bytes] : percale::scenes::make_shipped_meshes()) {
            const std::string path = (folder / file).string();
            if (bytes.empty())
                percale::scenes::write_obj(path, mesh.vertices, mesh.triangles);
            else
                percale::scenes::write_whole_file(path, bytes);

            std::printf("%s: %zu vertices, %zu triangles\n", file.c_str(), mesh.vertices.size(), mesh.triangles.size());
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "percale_make_data: %s\n", error.what());
        return 2;
    }
    return 0;
}
