#include "Common/Probe/PathsRun.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "Common/Shared/Base/Sampling.h"

namespace rt::probe {
namespace {

double lightOf(const shared::vec3& radiance) {
    return static_cast<double>(shared::luminance(radiance));
}

bool isBrighter(const ListedPath& a, const ListedPath& b) {
    return lightOf(a.found.radiance) > lightOf(b.found.radiance);
}

void sortByShare(std::vector<NoiseShare>& shares) {
    std::ranges::stable_sort(shares, [](const NoiseShare& a, const NoiseShare& b) { return a.share > b.share; });
}

Technique dominantOf(const TracedSample& traced) {
    std::map<Technique, double> sums;
    for (const FoundLight& found : traced.found) sums[found.technique] += lightOf(found.radiance);
    const auto most = std::ranges::max_element(sums, {}, [](const auto& sum) { return sum.second; });
    return most == sums.end() ? Technique::Seen : most->first;
}

// Sums what `key` makes equal.
template <class Key>
std::vector<NoiseShare> summed(const PathsResult& result, const Key& key) {
    std::vector<NoiseShare> sums;
    for (const NoiseShare& part : result.shares) {
        auto sum = std::ranges::find_if(sums, [&](const NoiseShare& s) { return key(s) == key(part); });
        if (sum == sums.end()) {
            sums.push_back(part);
        } else {
            sum->mean += part.mean;
            sum->share += part.share;
        }
    }
    return sums;
}

} // namespace

double PathsResult::standardError() const {
    const double count = static_cast<double>(samples.size()) - dropped;
    return count > 1 ? std::sqrt(variance / count) : 0;
}

std::pair<std::uint32_t, double> PathsResult::worst() const {
    std::pair<std::uint32_t, double> most{0, 0};
    double sum = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double square = (samples[i] - mean) * (samples[i] - mean);
        if (!std::isfinite(square)) continue;
        sum += square;
        if (square > most.second) most = {static_cast<std::uint32_t>(i), square};
    }
    if (sum > 0) most.second /= sum;
    return most;
}

std::vector<NoiseShare> sharesByTechnique(const PathsResult& result) {
    std::vector<NoiseShare> sums = summed(result, [](const NoiseShare& s) { return s.technique; });
    sortByShare(sums);
    return sums;
}

std::vector<NoiseShare> sharesByBounces(const PathsResult& result) {
    std::vector<NoiseShare> sums = summed(result, [](const NoiseShare& s) { return s.bounces; });
    std::ranges::sort(sums, {}, &NoiseShare::bounces);
    return sums;
}

PathsRun::PathsRun(const SceneFormulas& scene, const scene::CameraDesc& camera, std::uint32_t x, std::uint32_t y,
                   const PathsSettings& settings)
    : paths_(scene, camera, x, y), position_(paths_.seen()), settings_(settings) {}

void PathsRun::advance() {
    for (std::size_t i = 0; i < kPortion && !isDone(); ++i) {
        const auto sample = static_cast<std::uint32_t>(samples_.size());
        add(sample, paths_.trace(sample));
    }
}

void PathsRun::add(std::uint32_t sample, const TracedSample& traced) {
    if (settings_.selected == sample)
        for (const FoundLight& found : traced.found) selected_.push_back({sample, found});
    dominant_.push_back(dominantOf(traced));
    if (!shared::isFinite(traced.radiance)) {
        ++dropped_;
        samples_.push_back(std::numeric_limits<float>::quiet_NaN());
        return;
    }
    const double whole = lightOf(traced.radiance);
    samples_.push_back(static_cast<float>(whole));
    radiance_ += glm::dvec3(traced.radiance);
    sum_ += whole;
    for (const FoundLight& found : traced.found) {
        const double part = lightOf(found.radiance);
        Part& sums = parts_[{found.technique, std::min(found.bounces, kPooledBounces)}];
        sums.sum += part;
        sums.product += part * whole;
        list(sample, found);
    }
}

void PathsRun::list(std::uint32_t sample, const FoundLight& found) {
    ListedPath path{sample, found};
    const auto place = std::ranges::upper_bound(listed_, path, isBrighter);
    if (static_cast<std::size_t>(place - listed_.begin()) >= settings_.listed) return;
    listed_.insert(place, std::move(path));
    if (listed_.size() > settings_.listed) listed_.pop_back();
}

PathsResult PathsRun::result() const {
    PathsResult result;
    result.settings = settings_;
    result.samples = samples_;
    result.dominant = dominant_;
    result.dropped = dropped_;
    const double count = static_cast<double>(samples_.size()) - dropped_;
    // A sample that is dropped stays in the divisor, as in the film.
    if (!samples_.empty()) result.radiance = radiance_ / static_cast<double>(samples_.size());
    if (count > 0) result.mean = sum_ / count;
    double squares = 0;
    for (const float sample : samples_)
        if (std::isfinite(sample)) squares += (sample - result.mean) * (sample - result.mean);
    if (count > 1) result.variance = squares / (count - 1);
    result.shares = shares(count, squares);
    result.listed = listed_;
    result.selected = selected_;
    std::ranges::stable_sort(result.selected, isBrighter);
    result.position = position_;
    result.sharesPaths = paths_.sharesPaths();
    result.isDone = isDone();
    return result;
}

std::vector<NoiseShare> PathsRun::shares(double count, double squares) const {
    std::vector<NoiseShare> all;
    for (const auto& [key, part] : parts_) {
        const double share = squares > 0 ? (part.product - part.sum * sum_ / count) / squares : 0;
        all.push_back({key.first, key.second, part.sum / count, share});
    }
    sortByShare(all);
    return all;
}

} // namespace rt::probe
