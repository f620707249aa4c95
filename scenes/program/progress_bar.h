#pragma once

#include <chrono>
#include <string>

namespace percale::program {

/// "[#####.....]  50 %  1.00 of 2.00 s  ETA 0:07". `done` and `total` in simulated s, `elapsed` in s of wall time; without a
/// measured speed (done = 0) the ETA is left open.
std::string progress_text(double done, double total, double elapsed);

/// A bar on the last line of the terminal that stderr is; nothing elsewhere.
class ProgressBar {
public:
    /// `wanted` false: draws nothing on a terminal either. `total`: simulated s at the end.
    ProgressBar(bool wanted, double total);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(double done);
    void clear();

private:
    bool active_, drawn_ = false;
    double total_;
    std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace percale::program
