#include "c/host.h"

#include "c/call.h"
#include "percale/detectors.h"

namespace percale::c_interface {
namespace {

struct DetectorWord {
    const char* word;
    std::unique_ptr<ContactDetector> (*make)();  // null: not in this build
};

constexpr DetectorWord detector_words[] = {
#ifdef PERCALE_C_HAS_FCL
    {"fcl", make_fcl_detector},
#else
    {"fcl", nullptr},
#endif
#ifdef PERCALE_C_HAS_BULLET
    {"bullet", make_bullet_detector},
#else
    {"bullet", nullptr},
#endif
    {"brute_force", make_brute_force_detector},
};

}  // namespace

std::unique_ptr<ContactDetector> make_detector(const std::string& word) {
    if (word == "none") return nullptr;
    for (const DetectorWord& known : detector_words) {
        if (word != known.word) continue;
        if (known.make == nullptr) throw CallError(PERCALE_NOT_BUILT, "detector \"" + word + "\" is not in this build");
        return known.make();
    }
    throw SceneError("detector", "\"" + word + "\" is none of fcl, bullet, brute_force, none");
}

HostWorkers::HostWorkers(const percale_workers& host) : host_(host) {
    if (host.run == nullptr) throw SceneError("workers.run", "is NULL");
}

void HostWorkers::run(int parts, void (*work)(void* data, int part, int slot), void* data) {
    host_.run(host_.host, parts, work, data);
}

}  // namespace percale::c_interface
