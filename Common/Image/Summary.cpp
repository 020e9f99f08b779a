#include "Common/Image/Summary.h"

#include <algorithm>
#include <cmath>

#include "Common/Image/Statistics.h"

namespace rt::image {

Summary summarise(std::span<const double> values) {
    if (values.empty()) return {};
    Summary summary;
    summary.count = values.size();
    const Estimate mean = estimate(values);
    summary.mean = mean.mean;
    summary.median = median({values.begin(), values.end()});
    const auto [minimum, maximum] = std::minmax_element(values.begin(), values.end());
    summary.min = *minimum;
    summary.max = *maximum;
    if (values.size() > 1) summary.halfWidth95 = studentQuantile(0.05, mean.dof) * std::sqrt(mean.varianceOfMean);
    return summary;
}

double median(std::vector<double> values) {
    const std::size_t middle = values.size() / 2;
    std::sort(values.begin(), values.end());
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double studentQuantile(double p, double dof) {
    double low = 0, high = 1;
    while (studentTwoSided(high, dof) > p) high *= 2;
    for (int i = 0; i < 80; ++i) {
        const double middle = 0.5 * (low + high);
        (studentTwoSided(middle, dof) > p ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

} // namespace rt::image
