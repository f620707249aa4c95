#pragma once

#include <vector>

#include "contact_law.h"
#include "percale/contact_load.h"

namespace percale {

/// What obstacles do to vertices by the rows and forces of one evaluation, sorted by vertex and obstacle; vertices that no active
/// row presses are left out, and so are rows between cloths. Where the vertices are (cloth_point) is left to the caller.
/// `only`: of one obstacle; -1: of all.
std::vector<ContactLoad> contact_loads(const ContactRows& rows, const ContactTerms& terms,
                                       const std::vector<RowForce>& row_forces, int only = -1);

}  // namespace percale
