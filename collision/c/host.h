#pragma once

#include <memory>
#include <string>

#include "percale.h"
#include "percale/contact.h"
#include "percale/workers.h"

// What a host chooses by word, and the threads that it provides.
namespace percale::c_interface {

/// Makes the detector "fcl", "bullet" or "brute_force"; null for "none". Throws SceneError for another word, CallError where it
/// is not built.
std::unique_ptr<ContactDetector> make_detector(const std::string& word);

/// A host's threads behind its callback; the simulation checks their contract (CheckedWorkers).
class HostWorkers : public Workers {
public:
    /// Throws SceneError without a callback.
    explicit HostWorkers(const percale_workers& host);
    int threads() const override { return host_.threads; }
    void run(int parts, void (*work)(void* data, int part, int slot), void* data) override;

private:
    percale_workers host_;
};

}  // namespace percale::c_interface
