#include "program/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace percale::program {

namespace {

std::string eta_text(double done, double total, double elapsed) {
    if (done <= 0.0) return "ETA -";
    const long seconds = std::lround(std::max(0.0, elapsed * (total - done) / done));
    char text[48];
    if (seconds >= 3600)
        std::snprintf(text, sizeof text, "ETA %ld:%02ld:%02ld", seconds / 3600, seconds / 60 % 60, seconds % 60);
    else
        std::snprintf(text, sizeof text, "ETA %ld:%02ld", seconds / 60, seconds % 60);
    return text;
}

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

}  // namespace

std::string progress_text(double done, double total, double elapsed, ProgressUnit unit) {
    constexpr int width = 30;
    // A part that is whole up to rounding (0.1 * 30 = 2.9999...) counts as whole.
    const double part = total > 0.0 ? std::clamp(done / total + 1e-9, 0.0, 1.0) : 1.0;
    const int filled = static_cast<int>(part * width);
    char text[96];
    std::snprintf(text, sizeof text, "] %3d %%  %.*f of %.*f %s  ", static_cast<int>(100.0 * part), unit.decimals, done,
                  unit.decimals, total, unit.name);
    return "[" + std::string(static_cast<std::size_t>(filled), '#') + std::string(static_cast<std::size_t>(width - filled), '.') +
           text + eta_text(done, total, elapsed);
}

ProgressBar::ProgressBar(bool wanted, double total, ProgressUnit unit, ProgressOutput output)
    : wanted_(wanted),
      terminal_(isatty(fileno(output.file)) == 1),
      total_(total),
      unit_(unit),
      output_(output),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::show(double done) {
    if (!wanted_) return;
    const auto now = std::chrono::steady_clock::now();
    if (!terminal_) return show_line(done, now);
    if (drawn_ && seconds_between(last_, now) < 0.1) return;
    last_ = now;
    drawn_ = true;
    std::fprintf(output_.file, "\r%s\033[K", progress_text(done, total_, seconds_between(start_, now), unit_).c_str());
    std::fflush(output_.file);
}

void ProgressBar::show_line(double done, std::chrono::steady_clock::time_point now) {
    const int tenths = total_ > 0.0 ? static_cast<int>(10.0 * done / total_) : 0;
    if (tenths <= tenths_ || tenths > 9 || seconds_between(last_, now) < output_.min_seconds) return;
    last_ = now;
    tenths_ = tenths;
    std::fprintf(output_.file, "%s\n", progress_text(done, total_, seconds_between(start_, now), unit_).c_str());
}

void ProgressBar::clear() {
    if (!drawn_) return;
    drawn_ = false;
    std::fputs("\r\033[K", output_.file);
    std::fflush(output_.file);
}

}  // namespace percale::program
