#include "study/run_variants.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace percale::scenes {

bool run_variants(std::size_t count, const VariantWork& work, const std::function<void(std::size_t)>& run) {
    std::mutex mutex;
    std::size_t next = 0;
    bool stopped = false;
    std::exception_ptr fault;
    const auto take = [&] {
        const std::lock_guard lock(mutex);
        stopped = stopped || fault || (next < count && work.stop_asked && work.stop_asked());
        return stopped ? count : next++;
    };
    const auto act = [&] {
        for (std::size_t variant = take(); variant < count; variant = take()) {
            try {
                run(variant);
                const std::lock_guard lock(mutex);
                if (work.ended) work.ended(variant);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!fault) fault = std::current_exception();
            }
        }
    };
    {
        std::vector<std::jthread> threads;
        try {
            for (std::size_t job = 1; job < std::min(static_cast<std::size_t>(work.jobs), count); ++job)
                threads.emplace_back(act);
        } catch (const std::system_error&) {  // the system gives no more: those that there are do all
        }
        act();
    }
    if (fault) std::rethrow_exception(fault);
    return next >= count;
}

}  // namespace percale::scenes
