// Error that falls with samples or seconds, as straight lines between points on logarithmic axes.
#pragma once
#include <optional>
#include <span>

namespace rt::image {

struct CurvePoint {
    double x = 0; // samples or seconds, > 0, ascending along a curve
    double y = 0; // mse, relmse; points where it is not > 0 are skipped
};

// log y = intercept + slope log x by least squares: mse falls with slope -1 for independent samples.
struct LogFit {
    double slope = 0;
    double intercept = 0;             // natural logarithm
    std::optional<double> slopeError; // standard error; from three points on
};
std::optional<LogFit> fitLogLog(std::span<const CurvePoint> points); // nothing below two points

// Within the curve by interpolation, beyond its ends along a line of slope -1 from the end.
struct CurveValue {
    double value = 0;
    bool extrapolated = false;
};
std::optional<CurveValue> errorAt(std::span<const CurvePoint> points, double x);
// Where the curve falls to y: the last such place, so that luck on the way does not count.
std::optional<CurveValue> whenBelow(std::span<const CurvePoint> points, double y);

// What a second buys: 1 / (mse s). Nothing unless both are positive.
std::optional<double> efficiency(double mse, double seconds);

} // namespace rt::image
