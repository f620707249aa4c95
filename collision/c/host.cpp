#include "c/host.h"

#include "c/call.h"
#include "percale/detectors.h"

namespace percale::c_interface {
namespace {

constexpr int most_host_threads = 64;  // as of StepSettings::threads

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

/// One call of HostWorkers::run.
struct WatchedBatch {
    void (*work)(void* data, int part, int slot);
    void* data;
    int parts, threads;
    std::atomic<int> done = 0;
};

void do_watched_part(void* data, int part, int slot) {
    WatchedBatch& batch = *static_cast<WatchedBatch*>(data);
    if (part < 0 || part >= batch.parts || slot < 0 || slot >= batch.threads) return;
    batch.work(batch.data, part, slot);
    batch.done.fetch_add(1, std::memory_order_relaxed);
}

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
    if (host.threads < 1 || host.threads > most_host_threads) {
        throw SceneError("workers", "threads = " + std::to_string(host.threads) + " is outside the allowed range 1 ... " +
                                        std::to_string(most_host_threads));
    }
}

void HostWorkers::run(int parts, void (*work)(void* data, int part, int slot), void* data) {
    WatchedBatch batch{.work = work, .data = data, .parts = parts, .threads = host_.threads};
    host_.run(host_.host, parts, do_watched_part, &batch);
    if (batch.done.load(std::memory_order_relaxed) != parts) broken_ = true;
}

void HostWorkers::check() const {
    if (!broken_) return;
    throw CallError(
        PERCALE_INTERNAL_ERROR,
        "workers.run has not done each part once, in slots of 0 ... threads - 1: the state cannot be trusted, destroy "
        "this simulation");
}

}  // namespace percale::c_interface
