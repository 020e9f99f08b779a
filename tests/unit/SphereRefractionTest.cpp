// Paths that a sphere of glass refracts twice, against Snell's law and rays traced in double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include "Common/Shared/Light/SphereRefraction.h"
#include "Common/Shared/Material/Dielectric.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::Mean;
using test::Uniforms;

constexpr double kPiD = 3.14159265358979323846;

// A ray that has been refracted by the unit sphere at the origin, and the fraction of its light that is left.
struct Traced {
    dvec3 origin{};
    dvec3 direction{};
    double transmitted = 0; // 0: it missed the sphere
};

double reflectance(double c, double t, double eta) {
    const double across = (c - eta * t) / (c + eta * t), along = (eta * c - t) / (eta * c + t);
    return 0.5 * (across * across + along * along);
}

Traced traceThrough(const dvec3& x, const dvec3& direction, double eta) {
    const double b = -glm::dot(x, direction);
    const dvec3 foot = x + b * direction;
    const double squared = 1 - glm::dot(foot, foot);
    if (squared <= 0 || b <= 0) return {};
    const dvec3 entry = x + (b - std::sqrt(squared)) * direction;
    const double c = -glm::dot(direction, entry);
    const double t = std::sqrt(1 - (1 - c * c) / (eta * eta));
    const dvec3 inside = direction / eta + entry * (c / eta - t);
    const dvec3 leave = entry - 2 * glm::dot(inside, entry) * inside;
    const double kept = 1 - reflectance(c, t, eta);
    return {leave, glm::normalize(eta * inside - leave * (eta * t - c)), kept * kept};
}

double turn(double i, double eta, double nearX, double nearY) {
    const double s = std::sin(i);
    return 2 * (i - std::asin(s / eta)) - std::asin(s * nearX) - std::asin(s * nearY);
}

RefractionPair pairOf(double eta, double nearX, double nearY, double bend) {
    RefractionPair p;
    p.inverseEta = float(1 / eta);
    p.nearX = float(nearX);
    p.nearY = float(nearY);
    p.bend = vec2(float(std::cos(bend)), float(std::sin(bend)));
    return p;
}

struct RandomPair {
    explicit RandomPair(Uniforms& u)
        : eta(u.between(1.05, 2.6)), nearX(u.between(0, 0.999)), nearY(u.between(0, 0.999)), bend(u.between(0, kPiD)) {}
    RefractionPair pair() const { return pairOf(eta, nearX, nearY, bend); }
    double eta, nearX, nearY, bend;
};

// Paths by signs of the turn minus each target over a thousand angles; -1 where one is about to appear.
int countByScan(const RandomPair& r) {
    constexpr int kAngles = 1000;
    int count = 0;
    double least = 0, before = 0;
    for (int k = 1; k <= kAngles; ++k) {
        const double now = turn(0.5 * kPiD * k / kAngles, r.eta, r.nearX, r.nearY);
        for (const double target : {-r.bend, r.bend}) count += (before - target) * (now - target) < 0 ? 1 : 0;
        least = std::min(least, now);
        before = now;
    }
    const double margin = 1e-4;
    const bool isClose = std::abs(least + r.bend) < margin || std::abs(std::abs(before) - r.bend) < margin;
    return isClose ? -1 : count;
}

TEST(SphereRefraction, FindsAllPaths) {
    Uniforms u(1);
    std::array<int, 4> seen{};
    for (int k = 0; k < 5000; ++k) {
        const RandomPair r(u);
        const int expected = countByScan(r);
        if (expected < 0) continue;
        ASSERT_LE(expected, 3);
        ++seen[std::size_t(expected)];
        const RefractionPair p = r.pair();
        ASSERT_EQ(int(refractionRoots(p, leastTurn(p)).count), expected)
            << "eta " << r.eta << ", near " << r.nearX << " and " << r.nearY << ", bend " << r.bend;
    }
    for (const int count : seen) EXPECT_GT(count, 20);
}

// Rays in the directions found meet y. Near the fold, where two paths are about to meet, the angle is known to the root
// of the rounding.
TEST(SphereRefraction, PathsObeySnellsLaw) {
    Uniforms u(2);
    int found = 0;
    for (int k = 0; k < 100000; ++k) {
        const RandomPair r(u);
        const RefractionPair p = r.pair();
        const RefractionRoots roots = refractionRoots(p, leastTurn(p));
        for (uint kind = 0; kind < kRefractedPaths; ++kind) {
            if (!hasPath(roots, kind)) continue;
            const Refraction at = refractedPath(p, kind);
            const RefractedPlaces places = refractedPlaces(at, kind, vec3(1, 0, 0), vec3(0, 1, 0));
            const dvec3 x(-1 / r.nearX, 0, 0);
            const dvec3 y = dvec3(std::cos(r.bend), std::sin(r.bend), 0) / r.nearY;
            if (at.incident.x < 0.02f) continue; // grazing: all is reflected
            const double tolerance = std::abs(at.slope) > 0.1f ? 2e-5 : 2e-3;
            const double expected = kind == kOppositePath ? r.bend : -r.bend;
            const double i = std::atan2(double(at.incident.y), double(at.incident.x));
            ASSERT_NEAR(turn(i, r.eta, r.nearX, r.nearY), expected, tolerance)
                << "kind " << kind << ", slope " << at.slope << ", eta " << r.eta << ", near " << r.nearX << " and "
                << r.nearY << ", bend " << r.bend;
            if (std::abs(at.slope) < 0.1f || r.nearX > 0.9) continue;
            const Traced ray = traceThrough(x, glm::normalize(dvec3(places.atX)), r.eta);
            ASSERT_GT(ray.transmitted, 0);
            ASSERT_LT(glm::length(ray.origin - dvec3(places.leave)), 1e-3);
            const dvec3 toY = y - ray.origin;
            const double aside = glm::length(toY - ray.direction * glm::dot(toY, ray.direction));
            ASSERT_LT(aside, 3e-3 * (1 + 1 / r.nearX + 1 / r.nearY) / double(std::min(std::abs(at.slope), 1.0f)));
            ++found;
        }
    }
    EXPECT_GT(found, 10000);
}

// ---- irradiance through the sphere ---------------------------------------------------------------------------------

struct Constellation {
    const char* name;
    double eta;
    dvec3 x;
    dvec3 corner, edgeU, edgeV; // of a quad that emits 1 to both sides
};

const std::array kConstellations = {
    Constellation{"on the axis", 1.5, {0, 0, -4}, {-0.5, -0.5, 6}, {1, 0, 0}, {0, 1, 0}},
    Constellation{"focus of the light", 1.5, {0, 0, -1.9}, {-0.5, -0.5, 7.125}, {1, 0, 0}, {0, 1, 0}},
    Constellation{"fold", 1.5, {0.32, 0, -1.4}, {-0.3, -0.3, 6}, {0.6, 0, 0}, {0, 0.6, 0}},
    Constellation{"touching the sphere", 1.5, {0, 0, -1.001}, {-1, -1, 4}, {2, 0, 0}, {0, 2, 0}},
    Constellation{"light touching the sphere", 1.5, {0.3, 0.1, -3}, {-0.3, -0.3, 1.01}, {0.6, 0, 0}, {0, 0.6, 0}},
    Constellation{"far", 1.5, {1, 2, -40}, {-1, -1, 8}, {2, 0, 0}, {0, 2, 0}},
    Constellation{"far light", 1.5, {0.2, 0.1, -2.5}, {-2, -2, 60}, {4, 0, 0}, {0, 4, 0}},
    Constellation{"beside", 1.5, {4, 0, -2}, {-1, -1, 3}, {2, 0, 0}, {0, 2, 0}},
    Constellation{"on the other side", 1.5, {2, 0, -3}, {1, -0.5, 5}, {1, 0, 0.5}, {0, 1, 0}},
    Constellation{"diamond", 2.4, {0.2, 0, -1.5}, {-0.6, -0.5, 5}, {1, 0, 0}, {0, 1, 0}},
    Constellation{"ice", 1.31, {0.4, 0.3, -2.2}, {-0.6, -0.5, 5}, {1, 0, 0.3}, {0, 1, 0}},
    Constellation{"small light", 1.5, {0.5, 0, -3}, {0, 0, 9}, {0.1, 0, 0}, {0, 0.1, 0}},
};

// Densities of solid angle at x with which connections, and directions uniform in the sphere's cone, find a path.
struct Densities {
    double connecting, scattering;
};

class Irradiance {
  public:
    explicit Irradiance(const Constellation& c)
        : c_(c), across_(glm::cross(c.edgeU, c.edgeV)), area_(glm::length(across_)), normal_(across_ / area_) {
        const double distance = glm::length(c.x);
        axis_ = -c.x / distance;
        height_ = 1 - std::sqrt(1 - 1 / (distance * distance));
        aside_ = glm::normalize(glm::cross(axis_, std::abs(axis_.x) > 0.5 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
    }

    // Light along a direction that is uniform in the cone, and the point y that it comes from.
    double scatter(Uniforms& u, dvec3& y, Traced& ray) const {
        const double h = height_ * double(u()), sine = std::sqrt(h * (2 - h)), phi = 2 * kPiD * double(u());
        const dvec3 other = glm::cross(axis_, aside_);
        const dvec3 d = axis_ * (1 - h) + aside_ * (sine * std::cos(phi)) + other * (sine * std::sin(phi));
        ray = traceThrough(c_.x, d, c_.eta);
        if (ray.transmitted == 0) return 0;
        const double t = glm::dot(c_.corner - ray.origin, normal_) / glm::dot(ray.direction, normal_);
        y = ray.origin + t * ray.direction;
        const dvec3 at = y - c_.corner;
        const double a = glm::dot(glm::cross(at, c_.edgeV), normal_) / area_;
        const double b = glm::dot(glm::cross(c_.edgeU, at), normal_) / area_;
        if (!(t > 0 && a >= 0 && a <= 1 && b >= 0 && b <= 1)) return 0;
        return ray.transmitted * solidAngle();
    }

    double scatterWeighted(Uniforms& u) const {
        dvec3 y;
        Traced ray;
        const double light = scatter(u, y, ray);
        if (light == 0) return 0;
        const RefractionPair p = pair(y);
        if (refractionRoots(p, leastTurn(p)).count == 0) return light;
        const float sine = float(std::min(glm::length(glm::cross(ray.origin, ray.direction)), 1.0));
        const Refraction at = refractionAt(p, angleOfSine(sine));
        const Densities d = densities(p, at, ray.direction);
        return light * d.scattering / (d.scattering + d.connecting);
    }

    double connectWeighted(Uniforms& u) const {
        const dvec3 y = c_.corner + double(u()) * c_.edgeU + double(u()) * c_.edgeV;
        const RefractionPair p = pair(y);
        const RefractionRoots roots = refractionRoots(p, leastTurn(p));
        double sum = 0;
        for (uint kind = 0; kind < kRefractedPaths; ++kind) {
            if (!hasPath(roots, kind)) continue;
            const Refraction at = refractedPath(p, kind);
            const dvec3 toY = glm::normalize(y);
            dvec3 aside = toY - axis_ * glm::dot(toY, axis_);
            aside = glm::length(aside) > 0 ? glm::normalize(aside) : aside_;
            const RefractedPlaces places = refractedPlaces(at, kind, vec3(axis_), vec3(aside));
            const Densities d = densities(p, at, glm::normalize(y - dvec3(places.leave)));
            const double kept = d.scattering * solidAngle();
            sum += kept / (d.connecting + d.scattering);
            EXPECT_TRUE(std::isfinite(sum));
        }
        return sum;
    }

  private:
    double solidAngle() const { return 2 * kPiD * height_; }

    RefractionPair pair(const dvec3& y) const {
        const dvec3 toY = glm::normalize(y);
        RefractionPair p;
        p.inverseEta = float(1 / c_.eta);
        p.nearX = float(1 / glm::length(c_.x));
        p.nearY = float(1 / glm::length(y));
        p.bend = vec2(float(glm::dot(axis_, toY)), float(glm::length(glm::cross(axis_, toY))));
        return p;
    }

    Densities densities(const RefractionPair& p, const Refraction& at, const dvec3& direction) const {
        const double cosine = std::abs(glm::dot(direction, normal_));
        const double connecting = 1 / (area_ * double(refractionDensity(p, at)) * cosine);
        const double reflected = double(fresnel(at.incident.x, p.inverseEta).x);
        return {connecting, (1 - reflected) * (1 - reflected) / solidAngle()};
    }

    Constellation c_;
    dvec3 across_;
    double area_;
    dvec3 normal_, axis_{}, aside_{};
    double height_ = 0;
};

// Directions of the cone alone, in double precision, against connections and directions weighed against each other.
TEST(SphereRefraction, IrradianceIsThatOfTracedRays) {
    constexpr int kTraced = 400000, kWeighed = 100000;
    std::uint32_t seed = 3;
    for (const Constellation& c : kConstellations) {
        const Irradiance irradiance(c);
        Uniforms u(seed++);
        Mean traced, scattered, connected;
        for (int k = 0; k < kTraced; ++k) {
            dvec3 y;
            Traced ray;
            traced.add(irradiance.scatter(u, y, ray));
        }
        for (int k = 0; k < kWeighed; ++k) scattered.add(irradiance.scatterWeighted(u));
        for (int k = 0; k < kWeighed; ++k) connected.add(irradiance.connectWeighted(u));
        const double sum = scattered.mean() + connected.mean();
        const double error =
            std::sqrt(traced.variance() / kTraced + (scattered.variance() + connected.variance()) / kWeighed);
        ASSERT_GT(traced.mean(), 0) << c.name;
        const double z = (sum - traced.mean()) / error;
        EXPECT_LT(std::abs(z), 4) << c.name << ": " << sum << " in place of " << traced.mean();
    }
}

} // namespace
} // namespace rt::shared
