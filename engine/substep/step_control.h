#pragma once

namespace percale {

struct StepScene;
struct Vec3Arrays;

/// Chooses the lengths of adaptive steps. The total error is to be `tolerance` m a second: a length of dt may cost tolerance dt,
/// and the unused allowance so far, up to some hundredths of a second's worth. A step in contact may cost some thousandths of a
/// second's worth however short it is: the error of an impact is its jump of velocity times dt, so that no length keeps to a
/// rate.
struct StepControl {
    double length = 0.0;              // s, of the next step; 0: not known yet
    double left = 0.0;                // m, unused allowance
    double error_ratio_before = 0.0;  // error over allowance of the last accepted step; 0: none
    bool just_rejected = false;       // the next accepted step must not be followed by a longer one
    bool missed = false;              // the last step was accepted for its shortest length, not for its accuracy
};

/// Length and error of one attempt.
struct StepAttempt {
    double length = 0.0;  // s
    double error = 0.0;   // m, estimated
    int order = 1;        // of the scheme: the error goes with length^(order + 1)
    bool contact = false;
};

/// The length to try next: the remaining time divided evenly into steps no longer than the control's, s.
double next_length(const StepControl& control, double remaining);

/// Whether an attempt is exact enough, or of the shortest length; sets the next length, by a PI controller (Soderlind 2002)
/// after accepted ones.
bool accept_attempt(const StepAttempt& attempt, double tolerance, StepControl& control);

/// The root of the mean by mass of |e|^2 over the free vertices of a cloth, the largest of all cloths.
double mean_size(const StepScene& scene, const Vec3Arrays& error);

}  // namespace percale
