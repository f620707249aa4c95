#pragma once

#include <nlohmann/json.hpp>

#include "common/finding.h"
#include "percale/plan.h"

namespace percale {

inline void to_json(nlohmann::ordered_json& json, const Skip& skip) { json = {{"what", skip.what}, {"why", skip.why}}; }

}  // namespace percale

// How nlohmann's library writes findings and what a plan leaves out, single ones and lists.
namespace percale::scenes {

inline void to_json(nlohmann::ordered_json& json, const Finding& finding) {
    json = {{"severity", severity_word(finding.severity)},
            {"kind", finding.kind},
            {"place", finding.place},
            {"what", finding.what},
            {"fix", finding.fix}};
}

}  // namespace percale::scenes
