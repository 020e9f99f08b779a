#include "Common/Accel/Build/PrimitiveBoxes.h"

namespace rt::accel {
namespace {

using shared::vec3;

float largest(vec3 v) {
    return shared::max(v.x, shared::max(v.y, v.z));
}

// Grown by `roundings` units of roundoff, relative to the box's size and its distance from the origin.
Box grown(Box box, float roundings) {
    const float reach = largest(shared::max(shared::abs(box.lower), shared::abs(box.upper)));
    const vec3 margin{roundings * shared::kEpsilon * (reach + largest(box.size()))};
    box.lower -= margin;
    box.upper += margin;
    return box;
}

} // namespace

Box boxOf(const shared::Sphere& sphere) {
    return boxOf(sphere, vec3(0.0f));
}

Box boxOf(const shared::Sphere& sphere, vec3 motion) {
    Box box;
    box.add(sphere.center);
    box.add(sphere.center + motion);
    box.lower -= vec3(sphere.radius);
    box.upper += vec3(sphere.radius);
    return grown(box, 4.0f);
}

Box boxOf(const shared::Quad& quad) {
    Box box;
    box.add(quad.corner);
    box.add(quad.corner + quad.edgeU);
    box.add(quad.corner + quad.edgeV);
    box.add(quad.corner + quad.edgeU + quad.edgeV);
    return grown(box, 32.0f); // the test of a quad is generous at its edges: shared::kQuadError
}

Box boxOf(const shared::Round& round) {
    vec3 reach; // of the ellipse, along each axis
    for (int a = 0; a < 3; ++a)
        reach[a] = shared::sqrt(round.edgeU[a] * round.edgeU[a] + round.edgeV[a] * round.edgeV[a]);
    Box box;
    const vec3 end = round.hole < 0.0f ? round.origin + round.axis : round.origin;
    box.add(round.origin - reach);
    box.add(round.origin + reach);
    box.add(end - reach);
    box.add(end + reach);
    return grown(box, 64.0f); // the test is generous at rims: shared::kRoundError
}

Box boxOf(vec3 vertex0, vec3 vertex1, vec3 vertex2) {
    Box box;
    box.add(vertex0);
    box.add(vertex1);
    box.add(vertex2);
    const vec3 margin{4.0f * shared::kEpsilon * largest(box.size())}; // vertices themselves are exact
    box.lower -= margin;
    box.upper += margin;
    return box;
}

Box boxOf(const shared::Instance& instance, const Box& object) {
    Box box;
    float reach = 0.0f; // bounds the terms that the ray's transformation sums
    for (int row = 0; row < 3; ++row) {
        const shared::vec4 m = instance.toWorld[row];
        double lower = m.w, upper = m.w, terms = shared::abs(m.w);
        for (int a = 0; a < 3; ++a) {
            const double p = double{m[a]} * object.lower[a];
            const double q = double{m[a]} * object.upper[a];
            lower += p < q ? p : q;
            upper += p < q ? q : p;
            terms += std::abs(p) > std::abs(q) ? std::abs(p) : std::abs(q);
        }
        box.lower[row] = static_cast<float>(lower);
        box.upper[row] = static_cast<float>(upper);
        reach = shared::max(reach, static_cast<float>(terms));
    }
    const vec3 margin{32.0f * shared::kEpsilon * reach};
    box.lower -= margin;
    box.upper += margin;
    return box;
}

} // namespace rt::accel
