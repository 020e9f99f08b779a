// A million rays against a loop over all primitives in double, and against Embree where it is installed: no hit is
// missed, and none is nearer than it can be.
#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#ifdef RT_HAS_EMBREE
#include <embree3/rtcore.h>
#endif

#include "tests/unit/AccelScene.h"

namespace rt::accel::testing {
namespace {

using glm::dvec3;
constexpr double kNever = std::numeric_limits<double>::infinity();

// Where the first hit of a ray must lie: not before `earliest`, since nothing is there even if all primitives grow by
// kDoubt of their size, and not behind `latest`, since that is hit even if they shrink.
struct FirstHit {
    double earliest = kNever, latest = kNever;

    bool allows(float t) const {
        const double found = t < 0.0f ? kNever : t;
        return earliest <= found && found <= latest;
    }
};
constexpr double kDoubt = 1e-4;
constexpr double kRounding = 1e-5; // of t, relative to the distances that went into it

// The first of two crossings, each within an interval of t, is the hit unless it lies behind the origin.
void addCrossings(FirstHit& first, double nearLow, double nearHigh, double farLow, double farHigh) {
    if (nearHigh > 0.0) {
        first.earliest = std::min(first.earliest, nearLow);
    } else if (farHigh > 0.0) {
        first.earliest = std::min(first.earliest, farLow);
    }
    if (nearLow > 0.0) {
        first.latest = std::min(first.latest, nearHigh);
    } else if (farLow > 0.0) {
        first.latest = std::min(first.latest, farHigh);
    }
}

void add(FirstHit& first, const Ray& ray, const shared::Sphere& s) {
    const dvec3 d(ray.direction), f = dvec3(ray.origin) - dvec3(s.center);
    const double a = glm::dot(d, d), middle = -glm::dot(f, d) / a;
    const dvec3 l = f + d * middle;
    const double slack = kRounding * (glm::length(f) + s.radius);
    const double small = s.radius * (1.0 - kDoubt), large = s.radius * (1.0 + kDoubt);
    if (glm::dot(l, l) > large * large) return;
    const double outer = std::sqrt((large * large - glm::dot(l, l)) / a) + slack;
    if (glm::dot(l, l) > small * small) { // touched or not
        if (middle + outer > 0.0) first.earliest = std::min(first.earliest, middle - outer);
        return;
    }
    const double inner = std::sqrt((small * small - glm::dot(l, l)) / a) - slack;
    addCrossings(first, middle - outer, middle - inner, middle + inner, middle + outer);
}

void add(FirstHit& first, const Ray& ray, dvec3 corner, dvec3 u, dvec3 v, bool isTriangle) {
    const dvec3 d(ray.direction), n = glm::cross(u, v), f = dvec3(ray.origin) - corner;
    const double squared = glm::dot(n, n);
    const double cosine = std::abs(glm::dot(n, d)) / std::sqrt(squared * glm::dot(d, d));
    if (cosine < 1e-9) return; // along the plane: no first hit is surely there
    const double t = -glm::dot(n, f) / glm::dot(n, d);
    const dvec3 p = f + d * t;
    const double a = glm::dot(glm::cross(p, v), n) / squared, b = glm::dot(glm::cross(u, p), n) / squared;
    const double depth = isTriangle ? std::min({a, b, 1.0 - a - b}) : std::min({a, b, 1.0 - a, 1.0 - b});
    const double size = std::sqrt(squared) / std::max(glm::length(u), glm::length(v)); // the smaller extent
    const double slack = kRounding * (glm::length(f) + std::abs(t)) / cosine;
    const double doubt = kDoubt / cosine + slack / size;
    if (depth > -doubt && t + slack > 0.0) first.earliest = std::min(first.earliest, t - slack);
    if (depth > doubt && t - slack > 0.0) first.latest = std::min(first.latest, t + slack);
}

// A hit of a disk or cylinder of radius 1 + kDoubt at t is `possible`, of one of radius 1 - kDoubt `certain`.
void addHit(FirstHit& first, double t, double slack, bool isPossible, bool isCertain) {
    if (isPossible && t + slack > 0.0) first.earliest = std::min(first.earliest, t - slack);
    if (isCertain && t - slack > 0.0) first.latest = std::min(first.latest, t + slack);
}

void add(FirstHit& first, const Ray& ray, const shared::Round& r) {
    const glm::dmat3 toLocal = glm::inverse(glm::dmat3(dvec3(r.edgeU), dvec3(r.edgeV), dvec3(r.axis)));
    const dvec3 f = dvec3(ray.origin) - dvec3(r.origin);
    const dvec3 o = toLocal * f, d = toLocal * dvec3(ray.direction);
    const double doubt = kDoubt + kRounding * glm::length(o);
    if (r.hole >= 0.0f) {
        const double cosine = std::abs(d.z) / glm::length(ray.direction);
        if (cosine < 1e-9) return; // along the plane: no first hit is surely there
        const double t = -o.z / d.z, radius = std::hypot(o.x + t * d.x, o.y + t * d.y), hole = double{r.hole};
        const double slack = kRounding * (glm::length(f) + std::abs(t)) / cosine;
        const double blur = (doubt + slack * std::hypot(d.x, d.y)) / cosine;
        addHit(first, t, slack, radius <= 1 + blur && radius >= hole - blur,
               radius <= 1 - blur && radius >= (hole > 0 ? hole + blur : 0));
        return;
    }
    const double a = d.x * d.x + d.y * d.y, middle = -(o.x * d.x + o.y * d.y) / a;
    const double squared = std::pow(std::hypot(o.x + middle * d.x, o.y + middle * d.y), 2);
    const auto half = [&](double radius) { return std::sqrt(std::max(radius * radius - squared, 0.0) / a); };
    const double outer = half(1 + doubt), inner = half(1 - doubt);
    const bool isMet = squared < (1 + doubt) * (1 + doubt), isSurelyMet = squared < (1 - doubt) * (1 - doubt);
    for (const double side : {-1.0, 1.0}) {
        const double t = middle + side * half(1);
        const double slack = outer - inner + kRounding * (glm::length(f) + std::abs(t));
        const double z = o.z + t * d.z, blur = doubt + slack * std::abs(d.z);
        addHit(first, t, slack, isMet && z >= -blur && z <= 1 + blur, isSurelyMet && z >= blur && z <= 1 - blur);
    }
}

FirstHit bruteForce(const Geometry& g, const Ray& ray) {
    FirstHit first;
    for (const shared::Sphere& s : g.spheres) {
        add(first, ray, s);
    }
    for (const shared::Quad& q : g.quads) {
        add(first, ray, q.corner, q.edgeU, q.edgeV, false);
    }
    for (const shared::Round& r : g.rounds) {
        add(first, ray, r);
    }
    for (const shared::uvec3& t : g.triangles) {
        const dvec3 a = g.positions[t.x];
        add(first, ray, a, dvec3(g.positions[t.y]) - a, dvec3(g.positions[t.z]) - a, true);
    }
    return first;
}

// Half of the primitives tiny or huge, or slivers.
Geometry adversarialGeometry() {
    Random random(61);
    Geometry g;
    const auto size = [&] {
        return random.uniform() < 0.5f ? random.uniform(0.1f, 1.0f) : std::exp(random.uniform(-7.0f, 2.0f));
    };
    for (int i = 0; i < 16; ++i) {
        g.addSphere(random.inCube(8.0f), size());
        const float s = size();
        g.addQuad(random.inCube(8.0f), random.direction() * s, random.direction() * (s * random.uniform(0.1f, 1.0f)));
        const vec3 a = random.inCube(8.0f);
        const vec3 along = random.direction() * size();
        g.addTriangle(a, a + along, a + along * random.uniform() + random.direction() * (0.3f * size()));
    }
    for (int i = 0; i < 16; ++i) {
        const vec3 u = random.direction(), v = shared::normalize(shared::cross(u, random.direction()));
        const float s = size();
        g.addDisk(random.inCube(8.0f), u * s, v * (s * random.uniform(0.1f, 1.0f)), i % 3 == 0 ? 0.5f : 0.0f);
        g.addCylinder(random.inCube(8.0f), u * s, v * s, shared::cross(u, v) * size());
    }
    g.addSphere(vec3(0.0f, -1010.0f, 0.0f), 1000.0f);
    return g;
}

// Random, aimed at vertices, along axes, and from far away.
Ray adversarialRay(const Geometry& g, Random& random, int i) {
    Ray ray{random.inCube(10.0f), random.direction(), 0.0f};
    if (i % 4 == 1) ray.direction = shared::normalize(g.positions[random.below(g.positions.size())] - ray.origin);
    if (i % 4 == 2) {
        ray.direction = vec3(0.0f);
        ray.direction[i / 4 % 3] = i % 8 < 4 ? 1.0f : -1.0f;
    }
    if (i % 4 == 3) {
        ray.origin = random.direction() * random.uniform(10.0f, 1000.0f);
        ray.direction = shared::normalize(random.inCube(8.0f) - ray.origin);
    }
    return ray;
}

void expectAgreementWithALoopInDouble(int rayCount) {
    constexpr int kBatch = 50000;
    Geometry g = adversarialGeometry();
    const auto tree = buildAccel(g);
    const std::vector<NamedQuery> queries = runnableQueries();
    Random random(62);
    int sure = 0;
    std::vector<int> wrong(queries.size(), 0);
    for (int first = 0; first < rayCount; first += kBatch) {
        std::vector<Ray> rays;
        std::vector<FirstHit> expected;
        for (int i = 0; i < kBatch; ++i) {
            rays.push_back(adversarialRay(g, random, i));
            expected.push_back(bruteForce(g, rays.back()));
            sure += expected.back().latest < kNever;
        }
        for (std::size_t k = 0; k < queries.size(); ++k) {
            const std::vector<Hit> found = closestHits(*queries[k].query, tree->view(), rays);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                wrong[k] += !expected[i].allows(found[i].t);
            }
        }
    }
    EXPECT_GT(sure, rayCount / 2);
    for (std::size_t k = 0; k < queries.size(); ++k) {
        EXPECT_EQ(wrong[k], 0) << queries[k].name;
    }
}

// One wrong ray in thirty thousand is seen with a probability of 95 %; one in three hundred thousand every night.
TEST(AccelOracle, AgreesWithALoopInDouble) {
    expectAgreementWithALoopInDouble(100'000);
}
TEST(NightlyAccelOracle, AgreesWithALoopInDouble) {
    expectAgreementWithALoopInDouble(1'000'000);
}

#ifdef RT_HAS_EMBREE

// A bumpy closed surface of about twenty thousand triangles with a cloud of spheres around it.
Geometry meshAndSpheres() {
    Geometry g;
    const std::uint32_t rows = 100, columns = 100;
    for (std::uint32_t j = 0; j <= rows; ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) {
            const float theta = shared::kPi * static_cast<float>(j) / static_cast<float>(rows);
            const float phi = 2.0f * shared::kPi * static_cast<float>(i) / static_cast<float>(columns);
            const float r = 1.0f + 0.1f * std::sin(8.0f * theta) * std::cos(7.0f * phi);
            const float across = j == 0 || j == rows ? 0.0f : r * std::sin(theta);
            g.positions.emplace_back(across * std::cos(phi), r * std::cos(theta), across * std::sin(phi));
        }
    }
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) {
            const std::uint32_t a = j * columns + i, b = j * columns + (i + 1) % columns;
            if (j != 0) g.triangles.emplace_back(a, b, b + columns);
            if (j != rows - 1) g.triangles.emplace_back(a, b + columns, a + columns);
        }
    }
    Random random(63);
    for (int i = 0; i < 3000; ++i) {
        g.addSphere(random.direction() * random.uniform(1.3f, 3.0f), random.uniform(0.01f, 0.1f));
    }
    return g;
}

class EmbreeScene {
  public:
    explicit EmbreeScene(const Geometry& g) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry mesh = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        copy(mesh, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, g.positions);
        copy(mesh, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, g.triangles);
        attach(mesh);
        RTCGeometry spheres = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        std::vector<shared::vec4> points;
        for (const shared::Sphere& s : g.spheres) {
            points.emplace_back(s.center, s.radius);
        }
        copy(spheres, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, points);
        attach(spheres);
        rtcCommitScene(scene_);
    }
    ~EmbreeScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    // Negative: nothing.
    float closest(const Ray& r) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit query{};
        query.ray = {
            r.origin.x,        r.origin.y,  r.origin.z, 0.0f, r.direction.x, r.direction.y, r.direction.z, 0.0f,
            shared::kInfinity, 0xffffffffu, 0,          0};
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &query);
        return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1.0f : query.ray.tfar;
    }

  private:
    template <class T>
    static void copy(RTCGeometry g, RTCBufferType type, RTCFormat format, const std::vector<T>& data) {
        T* target = static_cast<T*>(rtcSetNewGeometryBuffer(g, type, 0, format, sizeof(T), data.size()));
        std::copy(data.begin(), data.end(), target);
    }
    void attach(RTCGeometry g) {
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene_, g);
        rtcReleaseGeometry(g);
    }

    RTCDevice device_;
    RTCScene scene_;
};

void expectAgreementWithEmbree(int rayCount) {
    Geometry g = meshAndSpheres();
    const auto tree = buildAccel(g);
    const EmbreeScene embree(g);
    Random random(64);
    std::vector<Ray> rays;
    for (int i = 0; i < rayCount; ++i) {
        Ray ray{random.inCube(3.0f), random.direction(), 0.0f};
        if (i % 3 == 1) ray.direction = shared::normalize(g.positions[random.below(g.positions.size())] - ray.origin);
        if (i % 3 == 2) {
            const shared::uvec3 t = g.triangles[random.below(g.triangles.size())];
            ray.origin = random.inCube(0.2f);
            ray.direction =
                shared::normalize(shared::mix(g.positions[t.x], g.positions[t.y], random.uniform()) - ray.origin);
        }
        rays.push_back(ray);
    }
    std::vector<float> theirs;
    theirs.reserve(rays.size());
    for (const Ray& ray : rays) {
        theirs.push_back(embree.closest(ray));
    }
    for (const NamedQuery& q : runnableQueries()) {
        std::vector<Ray> some = rays;
        if (q.name == "generic") some.resize(std::min<std::size_t>(some.size(), 100'000)); // it is slow
        const std::vector<Hit> ours = closestHits(*q.query, tree->view(), some);
        int different = 0, wrong = 0;
        for (std::size_t i = 0; i < some.size(); ++i) {
            if (std::abs(ours[i].t - theirs[i]) <= 1e-4f * std::max(1.0f, theirs[i])) continue;
            ++different; // edges and tangents: then the loop in double decides
            wrong += !bruteForce(g, rays[i]).allows(ours[i].t);
        }
        EXPECT_EQ(wrong, 0) << q.name;
        EXPECT_LT(different, rayCount / 200) << q.name;
    }
}

TEST(AccelOracle, AgreesWithEmbree) {
    expectAgreementWithEmbree(100'000);
}
TEST(NightlyAccelOracle, AgreesWithEmbree) {
    expectAgreementWithEmbree(1'000'000);
}

#endif

} // namespace
} // namespace rt::accel::testing
