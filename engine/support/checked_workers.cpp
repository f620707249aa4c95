#include "support/checked_workers.h"

#include <string>

#include "tolerances.h"

namespace percale {

CheckedWorkers::CheckedWorkers(std::shared_ptr<Workers> host) : host_(std::move(host)), threads_(host_->threads()) {
    if (threads_ < 1 || threads_ > max_threads)
        throw SceneError("workers", "threads() = " + std::to_string(threads_) + " is outside the allowed range 1 ... " +
                                        std::to_string(max_threads));
}

void CheckedWorkers::do_part(void* workers, int part, int slot) {
    CheckedWorkers& self = *static_cast<CheckedWorkers*>(workers);
    Batch& of = self.batch_;
    const bool in_range = part >= 0 && part < of.parts && slot >= 0 && slot < self.threads_;
    if (!in_range || self.begun_[static_cast<std::size_t>(part)].exchange(true, std::memory_order_relaxed)) {
        of.wrong.store(true, std::memory_order_relaxed);
        return;
    }
    of.work(of.data, part, slot);
    of.done.fetch_add(1, std::memory_order_relaxed);
}

void CheckedWorkers::run(int parts, void (*work)(void* data, int part, int slot), void* data) {
    check();
    if (begun_.size() < static_cast<std::size_t>(parts)) begun_ = std::vector<std::atomic<bool>>(static_cast<std::size_t>(parts));
    for (int part = 0; part < parts; ++part) begun_[static_cast<std::size_t>(part)].store(false, std::memory_order_relaxed);
    batch_.work = work;
    batch_.data = data;
    batch_.done = 0;
    batch_.wrong = false;
    batch_.parts = parts;
    broken_ = true;  // stays true if the host throws
    host_->run(parts, do_part, this);
    batch_.parts = 0;  // later calls are not part of it
    broken_ = batch_.wrong || batch_.done != parts;
    check();
}

void CheckedWorkers::check() const {
    if (broken_)
        throw WorkersError(
            "workers.run has not done each part once, in slots of 0 ... threads - 1, or has thrown: the state cannot be trusted, "
            "destroy this simulation");
}

}  // namespace percale
