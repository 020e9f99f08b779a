#include "Common/Image/Convergence.h"

#include <cmath>
#include <vector>

namespace rt::image {
namespace {

std::vector<CurvePoint> logarithms(std::span<const CurvePoint> points) {
    std::vector<CurvePoint> logs;
    for (const CurvePoint& point : points)
        if (point.x > 0 && point.y > 0) logs.push_back({std::log(point.x), std::log(point.y)});
    return logs;
}

} // namespace

std::optional<LogFit> fitLogLog(std::span<const CurvePoint> points) {
    const std::vector<CurvePoint> logs = logarithms(points);
    if (logs.size() < 2) return std::nullopt;
    const auto n = static_cast<double>(logs.size());
    double meanX = 0, meanY = 0, xx = 0, xy = 0;
    for (const auto [x, y] : logs) {
        meanX += x / n;
        meanY += y / n;
    }
    for (const auto [x, y] : logs) {
        xx += (x - meanX) * (x - meanX);
        xy += (x - meanX) * (y - meanY);
    }
    if (!(xx > 0)) return std::nullopt;
    LogFit fit;
    fit.slope = xy / xx;
    fit.intercept = meanY - fit.slope * meanX;
    if (logs.size() > 2) {
        double residuals = 0;
        for (const auto [x, y] : logs) {
            const double residual = y - fit.intercept - fit.slope * x;
            residuals += residual * residual;
        }
        fit.slopeError = std::sqrt(residuals / (n - 2) / xx);
    }
    return fit;
}

std::optional<CurveValue> errorAt(std::span<const CurvePoint> points, double x) {
    const std::vector<CurvePoint> logs = logarithms(points);
    if (logs.empty() || !(x > 0)) return std::nullopt;
    const double at = std::log(x);
    if (at < logs.front().x) return CurveValue{std::exp(logs.front().y + logs.front().x - at), true};
    for (std::size_t i = 1; i < logs.size(); ++i) {
        if (at > logs[i].x) continue;
        const double part = (at - logs[i - 1].x) / (logs[i].x - logs[i - 1].x);
        return CurveValue{std::exp(std::lerp(logs[i - 1].y, logs[i].y, part)), false};
    }
    return CurveValue{std::exp(logs.back().y + logs.back().x - at), at > logs.back().x};
}

std::optional<CurveValue> whenBelow(std::span<const CurvePoint> points, double y) {
    const std::vector<CurvePoint> logs = logarithms(points);
    if (logs.empty() || !(y > 0)) return std::nullopt;
    const double target = std::log(y);
    if (logs.back().y > target) return CurveValue{std::exp(logs.back().x + logs.back().y - target), true};
    for (std::size_t i = logs.size() - 1; i > 0; --i) {
        if (logs[i - 1].y <= target) continue;
        const double part = (logs[i - 1].y - target) / (logs[i - 1].y - logs[i].y);
        return CurveValue{std::exp(std::lerp(logs[i - 1].x, logs[i].x, part)), false};
    }
    return CurveValue{std::exp(logs.front().x + logs.front().y - target), logs.front().y < target};
}

std::optional<double> efficiency(double mse, double seconds) {
    if (!(mse > 0) || !(seconds > 0)) return std::nullopt;
    return 1 / (mse * seconds);
}

} // namespace rt::image
