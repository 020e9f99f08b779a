// The error of a picture over the time that was spent on it.
#pragma once
#include <optional>
#include <vector>

namespace rt::app {

struct ErrorPoint {
    double seconds = 0; // of sampling, and of filtering where the picture is denoised
    double spp = 0;
    double relmse = 0; // against the reference
};

// Between two points by interpolation on logarithmic axes, as error falls with a power of time. None before the first
// point and after the last one.
std::optional<double> errorAt(const std::vector<ErrorPoint>& curve, double seconds);
// When the error has last come down to this one; none where it has not, or had before the first point.
std::optional<double> secondsTo(const std::vector<ErrorPoint>& curve, double relmse);

} // namespace rt::app
