#pragma once

#include <cstddef>

#include "support/aligned.h"
#include "symmetric_block.h"

namespace percale {

/// The block diagonal of a step matrix: six arrays xx xy xz yy yz zz, kg.
struct DiagonalBlocks {
    AlignedVector<double> data;
    std::size_t padded = 0;

    void resize(std::size_t padded_size) {
        padded = padded_size;
        data.assign(6 * padded, 0.0);
    }
    const double* operator[](int entry) const { return data.data() + entry * padded; }
    SymmetricBlock block(int i) const {
        SymmetricBlock k;
        for (std::size_t entry = 0; entry < 6; ++entry) k[entry] = data[entry * padded + i];
        return k;
    }
};

}  // namespace percale
