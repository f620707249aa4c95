#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace percale::scenes {

/// What a child process may use.
struct ChildLimits {
    std::uint64_t memory = 0;  // bytes, beyond what this process has mapped
    double cpu_s = 0.0;        // > 0; s, rounded up; and ten times that of wall time
};

/// What `work` returns, run in a forked process that has this one's memory and ends with the call: what it breaks is broken
/// there. It sees no signal handler, writes nothing to standard output and error, and must not wait for other threads, which it
/// has not got. Throws SceneError: with its text where work throws one; "crashed (Segmentation fault)", "took more than 10 s of
/// CPU time", "took more than 512 MB of memory" and the like where it did not come to its end. May be called by several threads
/// at once.
std::vector<std::byte> run_in_child(const ChildLimits& limits, const std::function<std::vector<std::byte>()>& work);

}  // namespace percale::scenes
