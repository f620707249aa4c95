#pragma once

#include "span.h"

namespace percale {

/// Where pins are at a fraction of the step, on the straight line from its start, m.
void set_targets(const Span& span, double fraction, Vectors& targets);

/// Motion of each obstacle over the step, seen from a fraction of it; none where no obstacle moves.
void set_flows(const StepScene& scene, double fraction, std::vector<ObstacleFlow>& flows);

/// Rest lengths of springs at a place of the span, 0 ... 1: those of the start, or of the seams that are closing then. `list` is
/// memory for them.
std::span<const double> rest_lengths_at(const Span& span, double place, const StepState& start, std::vector<double>& list);

/// end.rest_length: at the end of the span. `list` is memory.
void set_rest_length(const Span& span, const StepState& start, std::vector<double>& list, ClothState& end);

/// Work of closing seams in a span from one state to another, J: each stage's weight times what the change of length to its own
/// stores at the start, and what the change from there stores at the end.
double seam_work(const Span& span, const StepState& start, const ClothState& end);

}  // namespace percale
