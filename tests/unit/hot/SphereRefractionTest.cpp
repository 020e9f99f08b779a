// Paths that a sphere of glass refracts twice, and reflects inside in between or not, against Snell's law and rays
// traced in double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ostream>

#include <glm/geometric.hpp>

#include "Common/Shared/Light/SphereRefraction.h"
#include "Common/Shared/Material/Dielectric.h"
#include "tests/unit/SphereConstellations.h"
#include "tests/unit/Statistics.h"

namespace rt::shared {
namespace {

using glm::dvec3;
using test::acrossOf;
using test::coneDirection;
using test::coneSolidAngle;
using test::Constellation;
using test::LightQuad;
using test::Mean;
using test::Traced;
using test::traceThrough;
using test::Uniforms;

using test::kPiD;

double turn(double i, uint crossings, double eta, double nearX, double nearY) {
    const double s = std::sin(i);
    return 2 * (i - crossings * std::asin(s / eta)) - std::asin(s * nearX) - std::asin(s * nearY);
}

RefractionPair pairOf(uint crossings, double eta, double nearX, double nearY, double bend) {
    RefractionPair p;
    p.inverseEta = float(1 / eta);
    p.crossings = crossings;
    p.nearX = float(nearX);
    p.nearY = float(nearY);
    p.bend = vec2(float(std::cos(bend)), float(std::sin(bend)));
    return p;
}

// Every other one is reflected inside: of an index of 1.3 or more, and ends not both near, see kNearestInside.
struct RandomPair {
    explicit RandomPair(Uniforms& u)
        : crossings(u() < 0.5f ? kRefracted : kReflectedInside),
          eta(u.between(isBack() ? 1.3 : 1.05, 2.6)),
          nearX(u.between(0, 0.999)),
          nearY(u.between(0, isBack() ? std::min(1.8 - nearX, 0.999) : 0.999)),
          bend(u.between(0, kPiD)) {}
    bool isBack() const { return crossings == kReflectedInside; }
    double turnAt(double i) const { return turn(i, crossings, eta, nearX, nearY); }
    RefractionPair pair() const { return pairOf(crossings, eta, nearX, nearY, bend); }
    uint crossings;
    double eta, nearX, nearY, bend;
};

std::ostream& operator<<(std::ostream& out, const RandomPair& r) {
    return out << r.crossings << " crossings, eta " << r.eta << ", near " << r.nearX << " and " << r.nearY << ", bend "
               << r.bend;
}

// Paths by signs of the turn minus each target over a thousand angles; -1 where one is about to appear.
int countByScan(const RandomPair& r) {
    constexpr int kAngles = 1000;
    int count = 0;
    double minimum = 0, before = 0;
    for (int k = 1; k <= kAngles; ++k) {
        const double now = r.turnAt(0.5 * kPiD * k / kAngles);
        EXPECT_LT(std::abs(now), kPiD) << r;
        for (const double target : {-r.bend, r.bend}) count += (before - target) * (now - target) < 0 ? 1 : 0;
        minimum = std::min(minimum, now);
        before = now;
    }
    const double margin = 1e-4;
    const bool isClose = std::abs(minimum + r.bend) < margin || std::abs(std::abs(before) - r.bend) < margin;
    return isClose ? -1 : count;
}

TEST(SphereRefraction, FindsAllPaths) {
    Uniforms u(1);
    std::array<std::array<int, 4>, 2> seen{};
    for (int k = 0; k < 5000; ++k) {
        const RandomPair r(u);
        const int expected = countByScan(r);
        if (expected < 0) continue;
        ASSERT_LE(expected, 3);
        ++seen[r.isBack() ? 1 : 0][std::size_t(expected)];
        const RefractionPair p = r.pair();
        ASSERT_EQ(int(refractionRoots(p, minTurn(p)).count), expected) << r;
    }
    for (const auto& counts : seen)
        for (const int count : counts) EXPECT_GT(count, 20);
}

// Rays in the directions found meet y. Near the fold, where two paths are about to meet, the angle is known to the root
// of the rounding.
TEST(SphereRefraction, PathsObeySnellsLaw) {
    Uniforms u(2);
    std::array<int, 2> found{};
    for (int k = 0; k < 200000; ++k) {
        const RandomPair r(u);
        const RefractionPair p = r.pair();
        const RefractionRoots roots = refractionRoots(p, minTurn(p));
        for (uint kind = 0; kind < kRefractedPaths; ++kind) {
            if (!hasPath(roots, kind)) continue;
            const Refraction at = refractedPath(p, kind);
            const RefractedPlaces places = refractedPlaces(at, r.crossings, kind, vec3(1, 0, 0), vec3(0, 1, 0));
            const dvec3 x(-1 / r.nearX, 0, 0);
            const double side = r.isBack() ? -1 : 1;
            const dvec3 y = side * dvec3(std::cos(r.bend), std::sin(r.bend), 0) / r.nearY;
            if (at.incident.x < 0.02f) continue; // grazing: all is reflected
            const double tolerance = std::abs(at.slope) > 0.1f ? 2e-5 : 2e-3;
            const double expected = kind == kOppositePath ? r.bend : -r.bend;
            const double i = std::atan2(double(at.incident.y), double(at.incident.x));
            ASSERT_NEAR(r.turnAt(i), expected, tolerance) << "kind " << kind << ", slope " << at.slope << ", " << r;
            if (std::abs(at.slope) < 0.1f || r.nearX > 0.9) continue;
            const dvec3 direction = glm::normalize(dvec3(places.atX));
            const Traced ray = traceThrough(x, direction, r.eta, r.isBack() ? 1 : 0);
            ASSERT_GT(ray.left, 0);
            ASSERT_LT(glm::length(ray.origin - dvec3(places.leave)), 1e-3);
            const dvec3 toY = y - ray.origin;
            const double aside = glm::length(toY - ray.direction * glm::dot(toY, ray.direction));
            ASSERT_LT(aside, 3e-3 * (1 + 1 / r.nearX + 1 / r.nearY) / double(std::min(std::abs(at.slope), 1.0f)));
            ++found[r.isBack() ? 1 : 0];
        }
    }
    for (const int count : found) EXPECT_GT(count, 10000);
}

// ---- irradiance through the sphere ---------------------------------------------------------------------------------

// Densities of solid angle at x with which connections, and directions uniform in the sphere's cone, find a path.
struct Densities {
    double connecting, scattering;
};

class Irradiance {
  public:
    explicit Irradiance(const Constellation& c) : c_(c), light_(c) {}

    double scatter(Uniforms& u, dvec3& y, Traced& ray) const {
        return light_.along(coneDirection(c_, u), y, ray) * coneSolidAngle(c_);
    }

    double scatterWeighted(Uniforms& u) const {
        dvec3 y;
        Traced ray;
        const double light = scatter(u, y, ray);
        if (light == 0) return 0;
        const RefractionPair p = pair(y);
        if (refractionRoots(p, minTurn(p)).count == 0) return light;
        const float sine = float(std::min(glm::length(glm::cross(ray.origin, ray.direction)), 1.0));
        const Refraction at = refractionAt(p, angleOfSine(sine));
        const Densities d = densities(p, at, ray.direction);
        return light * d.scattering / (d.scattering + d.connecting);
    }

    double connectWeighted(Uniforms& u) const {
        const dvec3 y = c_.corner + double(u()) * c_.edgeU + double(u()) * c_.edgeV;
        const dvec3 axis = -glm::normalize(c_.x);
        const RefractionPair p = pair(y);
        const RefractionRoots roots = refractionRoots(p, minTurn(p));
        double sum = 0;
        for (uint kind = 0; kind < kRefractedPaths; ++kind) {
            if (!hasPath(roots, kind)) continue;
            const Refraction at = refractedPath(p, kind);
            const dvec3 toY = glm::normalize(y);
            const dvec3 across = toY - axis * glm::dot(toY, axis);
            const dvec3 aside = glm::length(across) > 0 ? glm::normalize(across) : acrossOf(axis);
            const RefractedPlaces places = refractedPlaces(at, kRefracted, kind, vec3(axis), vec3(aside));
            const Densities d = densities(p, at, glm::normalize(y - dvec3(places.leave)));
            const double kept = d.scattering * coneSolidAngle(c_);
            sum += kept / (d.connecting + d.scattering);
            EXPECT_TRUE(std::isfinite(sum));
        }
        return sum;
    }

  private:
    RefractionPair pair(const dvec3& y) const {
        const dvec3 axis = -glm::normalize(c_.x), toY = glm::normalize(y);
        RefractionPair p;
        p.inverseEta = float(1 / c_.eta);
        p.crossings = kRefracted;
        p.nearX = float(1 / glm::length(c_.x));
        p.nearY = float(1 / glm::length(y));
        p.bend = vec2(float(glm::dot(axis, toY)), float(glm::length(glm::cross(axis, toY))));
        return p;
    }

    Densities densities(const RefractionPair& p, const Refraction& at, const dvec3& direction) const {
        const double cosine = std::abs(glm::dot(direction, light_.normal));
        const double connecting = 1 / (light_.area * double(refractionDensity(p, at)) * cosine);
        const double reflected = double(fresnel(at.incident.x, p.inverseEta).x);
        return {connecting, (1 - reflected) * (1 - reflected) / coneSolidAngle(c_)};
    }

    Constellation c_;
    LightQuad light_;
};

// Directions of the cone alone, in double precision, against connections and directions weighed against each other.
TEST(SphereRefraction, IrradianceIsThatOfTracedRays) {
    constexpr int kTraced = 400000, kWeighed = 100000;
    std::uint32_t seed = 3;
    for (const Constellation& c : test::kConstellations) {
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
