// What repeated measurements of one quantity say.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace rt::image {

struct Summary {
    std::size_t count = 0;
    double mean = 0;
    double median = 0;
    double min = 0;
    double max = 0;
    double halfWidth95 = 0; // of the mean's 95 % confidence interval by Student's distribution; 0 for less than two
};

// All zero for no value at all.
Summary summarise(std::span<const double> values);

double median(std::vector<double> values); // of at least one

// t that |T| exceeds with this probability, 0 < p < 1, T of Student's distribution.
double studentQuantile(double p, double dof);

} // namespace rt::image
