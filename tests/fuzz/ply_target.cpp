#include "mesh_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    percale::fuzz::try_mesh(data, size, ".ply");
    return 0;
}
