// Tests of hypotheses: are two means the same, and which of many are not?
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace rt::image {

// A mean estimated from samples. Zero variance: it is known exactly.
struct Estimate {
    double mean = 0;
    double varianceOfMean = 0;
    double dof = 0; // degrees of freedom of the variance
};

Estimate estimate(std::span<const double> samples);

struct TTest {
    double t = 0;
    double dof = 0;
    double p = 1; // probability of |t| or more if the means are the same
};

// Welch's test with Satterthwaite's degrees of freedom. Two means without variance are compared exactly, but for a
// relative difference of 1e-5 that rounding may cause (numerics: a zero-variance estimator is off by 4e-8).
TTest welch(const Estimate& a, const Estimate& b);

// Probability that |t| or more is drawn from Student's distribution.
double studentTwoSided(double t, double dof);

// Regularised incomplete beta function I_x(a, b), a, b > 0, x in [0,1]; relative error about 1e-15 log Gamma(a + b).
double incompleteBeta(double a, double b, double x);

// Benjamini and Hochberg 1995: indices, ascending, of the hypotheses to reject so that the expected share of false ones
// among them is at most q.
std::vector<std::size_t> discoveries(std::span<const double> pValues, double q);

} // namespace rt::image
