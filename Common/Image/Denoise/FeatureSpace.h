// Which features of a tile are worth a dimension of the regression: the principal components of what varies there.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "Common/Shared/Denoise/DenoiseFit.h"

namespace rt::image {

using SurfaceFeatures = std::array<float, shared::kDenoiseSurfaceValues>; // albedo, normal, depth, each scaled

struct FeatureSpace {
    SurfaceFeatures mean{};
    std::vector<SurfaceFeatures> axes; // by falling variance; what varies less than noise is left out

    float coordinate(const SurfaceFeatures& features, std::size_t axis) const {
        float sum = 0;
        for (std::size_t i = 0; i < features.size(); ++i) sum += axes[axis][i] * (features[i] - mean[i]);
        return sum;
    }
};

// Of at least one pixel's features.
FeatureSpace principalFeatures(const std::vector<SurfaceFeatures>& pixels);

} // namespace rt::image
