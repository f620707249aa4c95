#pragma once

#include <span>
#include <string>

#include "doctor/doctor.h"

namespace percale::scenes {

/// Every finding in two lines, "PLACE: SEVERITY: WHAT" and its fix, then how many there were of each kind.
std::string diagnosis_text(const Diagnosis& diagnosis);

/// One line: how many findings of each kind there were, and the first, which is the worst.
std::string diagnosis_line(const Diagnosis& diagnosis);

/// All diagnoses as a JSON object.
std::string diagnoses_json(std::span<const Diagnosis> diagnoses);

}  // namespace percale::scenes
