#pragma once

#include <chrono>
#include <string>

namespace percale::program {

/// What a bar counts: simulated seconds, or whole things.
struct ProgressUnit {
    const char* name = "s";
    int decimals = 2;
};

/// "[#####.....]  50 %  1.00 of 2.00 s  ETA 0:07". `elapsed` in s of wall time; without a measured speed (done = 0) the ETA is
/// left open.
std::string progress_text(double done, double total, double elapsed, ProgressUnit unit = {});

/// A bar on the last line of the terminal that stderr is; nothing elsewhere.
class ProgressBar {
public:
    /// `wanted` false: draws nothing on a terminal either. `total`: where the end is, in units.
    ProgressBar(bool wanted, double total, ProgressUnit unit = {});
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(double done);
    void clear();

private:
    bool active_, drawn_ = false;
    double total_;
    ProgressUnit unit_;
    std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace percale::program
