#pragma once

#include <span>
#include <string>
#include <vector>

#include "format/expectations.h"

namespace percale::scenes {

/// How the check of one scene file came out.
struct CheckedScene {
    std::string file;
    std::string error;   // wrong input or an internal error: the scene was not run
    std::string status;  // RunVerdict::word; "" with an error
    std::string reason;  // what was not well with the run; "" if all was
    double wall_s = 0.0;
    std::vector<ExpectationResult> expectations;

    bool finished() const { return error.empty() && reason.empty(); }
    int passed() const;
    int failed() const;  // an error and a run that was not well count as one each
};

/// A JUnit XML document: a suite a scene, a case an expectation and one for the run itself.
std::string junit_text(std::span<const CheckedScene> scenes);

}  // namespace percale::scenes
