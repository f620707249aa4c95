#pragma once

// A host program often has folders and headers of such names itself; they must not be confused with Percale's.
namespace host {
struct Mesh {
    int corners = 2;
};
}  // namespace host
