#include "Common/Probe/Estimate.h"

namespace rt::probe {
namespace {

// So that they are not the samples that are looked at.
constexpr std::uint32_t kOtherNumbers = 0x5bd1e995;

std::uint32_t samplesOfValue(const Strategy& strategy) {
    return strategy.kind == StrategyKind::Mis ? 2 : 1;
}

} // namespace

DirectEstimate::DirectEstimate(const Probe& probe, const Strategy& strategy, std::uint32_t seed)
    : probe_(&probe), strategy_(strategy), numbers_{app::SamplerKind::Independent, 1, seed ^ kOtherNumbers} {}

double DirectEstimate::valueOf(std::uint32_t sample) const {
    const Drawn drawn = probe_->draw(strategy_, numbers_, sample);
    if (!drawn.direction) return 0;
    const shared::vec3& wi = *drawn.direction;
    const bool isMis = strategy_.kind == StrategyKind::Mis;
    const Strategy own = !isMis ? strategy_ : Strategy{drawn.isByBsdf ? StrategyKind::Bsdf : StrategyKind::Lights};
    const double weight = isMis ? probe_->weight(own, wi) : 1.0, density = probe_->density(own, wi);
    if (!(density > 0) || !(weight > 0)) return 0;
    return probe_->contribution(wi) * weight / density;
}

void DirectEstimate::advance(std::uint32_t samples) {
    const std::uint32_t step = samplesOfValue(strategy_);
    for (const std::uint32_t end = samples_ + samples; samples_ + step <= end; samples_ += step) {
        double value = 0;
        for (std::uint32_t i = 0; i < step; ++i) value += valueOf(samples_ + i);
        const double before = value - mean_;
        const std::uint32_t earlier = samples_ / step;
        mean_ += before / (earlier + 1);
        squares_ += before * (value - mean_);
    }
}

double DirectEstimate::variance() const {
    const std::uint32_t step = samplesOfValue(strategy_), values = samples_ / step;
    return values > 1 ? squares_ / (values - 1) * step : 0;
}

} // namespace rt::probe
