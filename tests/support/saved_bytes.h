#pragma once

#include <cstddef>
#include <vector>

#include "percale/saved_state.h"

// States as bytes, of everything with save(StateWriter&) and restore(StateReader&).
namespace percale::test {

using Saved = std::vector<std::byte>;

template <class Part>
Saved saved_by(const Part& part) {
    StateWriter writer;
    part.save(writer);
    return writer.take();
}

template <class Part>
void restore(Part& part, const Saved& saved) {
    StateReader reader(saved);
    part.restore(reader);
}

}  // namespace percale::test
