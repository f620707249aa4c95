#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "percale.h"
#include "percale/contact.h"
#include "percale/workers.h"

// What a host chooses by word, and what it brings along.
namespace percale::c_interface {

/// Of "fcl", "bullet", "brute_force"; null for "none". Throws SceneError for another word, CallError where it is not built.
std::unique_ptr<ContactDetector> make_detector(const std::string& word);

/// A host's threads, and a watch on what its callback promises.
class HostWorkers : public Workers {
public:
    /// Throws SceneError for a number of threads out of range and without a callback.
    explicit HostWorkers(const percale_workers& host);
    int threads() const override { return host_.threads; }
    void run(int parts, void (*work)(void* data, int part, int slot), void* data) override;
    /// Throws CallError, from then on, where the callback has ever done another number of parts than it was asked for, or one in
    /// a slot out of range: work was left out.
    void check() const;

private:
    percale_workers host_;
    std::atomic<bool> broken_ = false;
};

}  // namespace percale::c_interface
