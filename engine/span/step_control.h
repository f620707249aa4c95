#pragma once

namespace percale {

struct StepScene;
struct Vectors;

/// Chooses the lengths of adaptive steps. Errors are to add up to `tolerance` m a second: a length of dt may cost tolerance dt,
/// and what was not used of that so far, up to some hundredths of a second's worth. A step in contact may cost some thousandths
/// of a second's worth however short it is: the error of an impact is its jump of velocity times dt, so that no length keeps to a
/// rate.
struct StepControl {
    double length = 0.0;         // s, of the next step; 0: not known yet
    double left = 0.0;           // m, allowance that was not used
    double share_before = 0.0;   // error over allowance of the last accepted step; 0: none
    bool just_rejected = false;  // the next accepted step must not be followed by a longer one
    bool missed = false;         // the last step was accepted because it was as short as it gets, not because it was exact enough
};

/// What one attempt was.
struct StepAttempt {
    double length = 0.0;  // s
    double error = 0.0;   // m, estimated
    int order = 1;        // of the scheme: the error goes with length^(order + 1)
    bool contact = false;
};

/// The length to try next: the remaining time divided evenly into steps no longer than the control's, s.
double next_length(const StepControl& control, double remaining);

/// Whether an attempt is exact enough, or as short as it gets; sets the next length, by a PI controller (Soderlind 2002) after
/// accepted ones.
bool accept_attempt(const StepAttempt& attempt, double tolerance, StepControl& control);

/// The largest of any cloth's root of the mean by mass of |e|^2 over its free vertices.
double mean_size(const StepScene& scene, const Vectors& error);

}  // namespace percale
