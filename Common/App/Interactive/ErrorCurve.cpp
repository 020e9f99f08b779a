#include "Common/App/Interactive/ErrorCurve.h"

#include <cmath>
#include <cstddef>

namespace rt::app {
namespace {

// The y of x on the straight line through both points on logarithmic axes.
double betweenLogs(double x, double x0, double y0, double x1, double y1) {
    if (!(x1 != x0) || !(y0 > 0) || !(y1 > 0)) return y1;
    const double share = std::log(x / x0) / std::log(x1 / x0);
    return y0 * std::pow(y1 / y0, share);
}

} // namespace

std::optional<double> errorAt(const std::vector<ErrorPoint>& curve, double seconds) {
    if (curve.empty() || seconds < curve.front().seconds || seconds > curve.back().seconds) return std::nullopt;
    std::size_t after = 0;
    while (curve[after].seconds < seconds) ++after;
    if (after == 0 || curve[after].seconds == seconds) return curve[after].relmse;
    const ErrorPoint &a = curve[after - 1], &b = curve[after];
    return betweenLogs(seconds, a.seconds, a.relmse, b.seconds, b.relmse);
}

std::optional<double> secondsTo(const std::vector<ErrorPoint>& curve, double relmse) {
    if (curve.empty() || curve.back().relmse > relmse) return std::nullopt;
    std::size_t first = curve.size() - 1; // from here on the error stays that small
    while (first > 0 && curve[first - 1].relmse <= relmse) --first;
    if (first == 0) return std::nullopt;
    const ErrorPoint &a = curve[first - 1], &b = curve[first];
    return betweenLogs(relmse, a.relmse, a.seconds, b.relmse, b.seconds);
}

} // namespace rt::app
