#pragma once

#include <chrono>
#include <cstdio>
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

/// Where progress is shown, and the minimum time between two lines that stay, s.
struct ProgressOutput {
    std::FILE* file = stderr;
    double min_seconds = 5.0;
};

/// A bar on the last line of a terminal; elsewhere, as in a log, a line that stays for a tenth of the whole.
class ProgressBar {
public:
    /// `wanted` false: shows nothing. `total`: where the end is, in units.
    ProgressBar(bool wanted, double total, ProgressUnit unit = {}, ProgressOutput output = {});
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(double done);
    void clear();

private:
    void show_line(double done, std::chrono::steady_clock::time_point now);

    bool wanted_, terminal_, drawn_ = false;
    double total_;
    int tenths_ = 0;  // that lines have reported
    ProgressUnit unit_;
    ProgressOutput output_;
    std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace percale::program
