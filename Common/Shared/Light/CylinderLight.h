// Sampling of open cylinders: uniform in area, or by what is seen of them.
//
// Gamito ("Solid Angle Sampling of Disk and Cylinder Lights", 2016) samples a rectangle around what is seen and rejects
// what misses. There is a map without rejection. In the coordinates around a line through the point along the
// cylinder's axis a solid angle is d(azimuth) d(sine of the elevation). At each azimuth the ray in the plane across the axis
// meets the cylinder at a near and a far distance, and its height there bounds the sine: the near wall is seen between
// the elevations of its ends, the far wall, if it emits inwards, in what the near one leaves of that. So the azimuth is
// drawn from a density that is linear between values of that length, as much as it follows the receiver's cosine, and
// the sine uniformly.
#ifndef RT_SHARED_CYLINDER_LIGHT_H
#define RT_SHARED_CYLINDER_LIGHT_H
#include "Common/Shared/Light/DiskLight.h"

RT_SHARED_BEGIN

struct CylinderView {
    vec3 x; // from the point towards the axis; y is across, z along it, on the side where most of the cylinder is
    vec3 y;
    vec3 z;
    float offset; // of the axis from the point
    float radius;
    float low; // of its ends along z, low < high
    float high;
    float height; // their difference
    float reach;  // azimuths in (-reach, reach) meet it
    bool isInside;
    bool seesFar; // the far wall, over the near one
};

RT_FN CylinderView viewCylinder(RT_IN(Light) light, vec3 position) {
    CylinderView c;
    vec3 toBase = light.position - position;
    float height = length(light.normal);
    vec3 axis = light.normal * (1.0f / height);
    float base = dot(toBase, axis);
    bool isTurned = base + 0.5f * height < 0.0f;
    c.z = isTurned ? -axis : axis;
    c.low = isTurned ? -(base + height) : base;
    c.high = isTurned ? -base : base + height;
    c.height = height;
    c.radius = length(light.edgeU);
    vec3 lateral = toBase - axis * base;
    c.offset = length(lateral);
    c.x = c.offset > 1.0e-6f * c.radius ? lateral * (1.0f / c.offset) : light.edgeU * (1.0f / c.radius);
    c.y = cross(c.z, c.x);
    float squared = (c.offset - c.radius) * (c.offset + c.radius);
    c.isInside = squared <= 0.0f;
    c.reach = c.isInside ? kPi : arcTan(c.radius, sqrt(squared));
    c.seesFar = !c.isInside && light.sides == kSidesBoth && c.low > 0.0f;
    return c;
}

// How much the sine of the elevation grows between two heights at a distance; without cancellation, of what is far away
// too. `height`: the difference of the heights.
RT_FN float elevationLength(float low, float high, float height, float distance) {
    float s2 = distance * distance;
    float toLow = sqrt(low * low + s2);
    float toHigh = sqrt(high * high + s2);
    float mixed = high * toLow + low * toHigh;
    float difference = high / toHigh - low / toLow;
    return max(low > 0.0f ? s2 * height * (low + high) / (toLow * toHigh * mixed) : difference, 0.0f);
}

// 1 - the sine of the elevation of a height at a distance, without cancellation where that is high.
RT_FN float elevationRest(float height, float distance) {
    return stripRest(height, distance * distance);
}

// What is seen of the cylinder at an azimuth, as the lengths that it takes in the sine of the elevation.
struct CylinderSlice {
    float across;   // from the axis to the ray, in the plane across the axis
    float chord;    // half of what the cylinder cuts out of the ray there
    float near;     // distance of the wall that is seen first, in that plane
    float far;      // of the other, if that is seen over it
    float nearRest; // elevationRest() of the lower ends
    float farRest;
    float nearLength;
    float farLength;
};

// `sc`: sine and cosine of the azimuth.
RT_FN CylinderSlice sliceCylinder(RT_IN(CylinderView) c, vec2 sc) {
    CylinderSlice slice;
    slice.across = c.offset * sc.x;
    slice.chord = sqrt(max((c.radius - slice.across) * (c.radius + slice.across), 0.0f));
    float far = c.offset * sc.y + slice.chord;
    slice.near = c.isInside ? far : max((c.offset - c.radius) * (c.offset + c.radius) / far, 0.0f);
    slice.far = far;
    slice.nearRest = elevationRest(c.low, slice.near);
    slice.nearLength = elevationLength(c.low, c.high, c.height, slice.near);
    slice.farRest = 0.0f;
    slice.farLength = 0.0f;
    if (c.seesFar) {
        // Up to where the near wall begins, or to its own end.
        float end = min(c.high, c.low * far / slice.near);
        slice.farRest = elevationRest(c.low, far);
        slice.farLength = elevationLength(c.low, end, end - c.low, far);
    }
    return slice;
}

RT_FN float sliceLength(RT_IN(CylinderSlice) slice) {
    return slice.nearLength + slice.farLength;
}

// ---- density of the azimuth ----------------------------------------------------------------------------------------

const uint kCylinderSteps = 8u;

RT_FN vec2 cylinderAzimuth(RT_IN(CylinderView) c, float part) {
    float turn = (2.0f * part - 1.0f) * c.reach * 0.159154943f;
    vec2 sc = sinCos2Pi(abs(turn));
    return vec2(turn < 0.0f ? -sc.x : sc.x, sc.y);
}

// Of azimuth i of those that divide what is seen: the length there times the receiver's cosine in its middle, or what
// counts for lower ones. `normal`: the receiver's in x, y, z.
RT_FN float cylinderWeight(RT_IN(CylinderView) c, vec3 normal, uint i) {
    vec2 sc = cylinderAzimuth(c, float(i) * (1.0f / float(kCylinderSteps)));
    CylinderSlice slice = sliceCylinder(c, sc);
    float seen = max(sliceLength(slice), 1.0e-37f);
    if (dot(normal, normal) == 0.0f) return seen;
    float rest = slice.nearRest - 0.5f * slice.nearLength;
    float flatness = sqrt(rest * (2.0f - rest));
    float cosine = dot(normal, vec3(flatness * sc.y, flatness * sc.x, 1.0f - rest));
    return seen * max(cosine, 0.05f);
}

RT_FN float cylinderTotal(RT_IN(CylinderView) c, vec3 normal) {
    float total = 0.0f;
    for (uint i = 0u; i <= kCylinderSteps; i++) {
        float weight = cylinderWeight(c, normal, i);
        total += i % kCylinderSteps == 0u ? 0.5f * weight : weight;
    }
    return total;
}

// Per steradian, where the weights are `weight` between azimuths.
RT_FN float cylinderDensity(RT_IN(CylinderView) c, float total, float weight, RT_IN(CylinderSlice) slice) {
    float seen = sliceLength(slice);
    return seen > 0.0f ? weight * float(kCylinderSteps) / (2.0f * c.reach * total * seen) : 0.0f;
}

// ---- the light -----------------------------------------------------------------------------------------------------

// Ratio of radius or height to distance below which a direction does not resolve it. Much smaller than kTinyExtent, as
// this density hardly varies.
const float kTinyCylinder = 1.0e-6f;

// What is too small for a direction to resolve, and what affine maps have made elliptic or slanted, goes by area.
RT_FN uint cylinderLightStrategy(RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position) {
    float u2 = dot(light.edgeU, light.edgeU);
    float h2 = dot(light.normal, light.normal);
    float slant = max(abs(dot(light.edgeU, light.normal)), abs(dot(light.edgeV, light.normal)));
    vec3 toMiddle = light.position + 0.5f * light.normal - position;
    float d2 = dot(toMiddle, toMiddle);
    bool isRight = isCircle(light.edgeU, light.edgeV) && slant * slant <= 1.0e-12f * u2 * h2;
    bool isResolved = min(u2, h2) >= kTinyCylinder * kTinyCylinder * d2;
    return params.quadLight == kShapeArea || !isRight || !isResolved ? kStrategyArea : kStrategySolidAngle;
}

// Whether the strategy by what is seen sees anything: from inside only walls that emit inwards.
RT_FN bool isCylinderSeen(RT_IN(CylinderView) c, RT_IN(Light) light) {
    return !c.isInside || light.sides == kSidesBoth;
}

RT_FN vec3 cylinderReceiver(RT_IN(RenderParams) params, RT_IN(CylinderView) c, vec3 normal) {
    if (params.quadLight != kShapeAuto) return vec3(0.0f);
    return vec3(dot(normal, c.x), dot(normal, c.y), dot(normal, c.z));
}

// Density per steradian of a point whose azimuth about the axis and height are uniform, at `place` of the cylinder's
// own coordinates.
RT_FN float cylinderAreaPdf(RT_IN(Light) light, vec3 place, vec3 wi, float distance) {
    vec3 element = cross(light.edgeV * place.x - light.edgeU * place.y, light.normal);
    float projected = abs(dot(element, wi)) * 6.28318531f;
    return projected > 0.0f ? distance * distance / projected : 0.0f;
}

// A point of what is seen at an azimuth, uniform in the sine of the elevation: the direction from the axis to it in x
// and y, and its height.
RT_FN vec3 drawOnCylinder(RT_IN(CylinderView) c, RT_IN(CylinderSlice) slice, float u, vec2 sc) {
    float x = u * sliceLength(slice);
    bool isNear = x < slice.nearLength || slice.farLength <= 0.0f;
    float rest = isNear ? slice.nearRest - min(x, slice.nearLength) : slice.farRest - (x - slice.nearLength);
    float distance = isNear ? slice.near : slice.far;
    float height = distance * (1.0f - rest) * inversesqrt(max(rest * (2.0f - rest), 1.0e-37f));
    float side = isNear && !c.isInside ? -slice.chord : slice.chord;
    vec2 toRim = normalize(vec2(side * sc.y - slice.across * sc.x, side * sc.x + slice.across * sc.y));
    return vec3(toRim.x, toRim.y, clamp(height, c.low, c.high));
}

RT_CALL LightSample sampleCylinderLight(RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                                        vec2 u) {
    LightSample s = noLightSample();
    bool byArea = cylinderLightStrategy(params, light, position) == kStrategyArea;
    RoundFrame frame = roundFrame(light.edgeU, light.edgeV, light.normal);
    vec3 place;
    if (byArea) {
        vec2 sc = sinCos2Pi(u.x);
        place = vec3(sc.y, sc.x, u.y);
    } else {
        CylinderView c = viewCylinder(light, position);
        if (!isCylinderSeen(c, light)) return s;
        vec3 receiver = cylinderReceiver(params, c, normal);
        float total = cylinderTotal(c, receiver);
        float left = u.x * total;
        float begin = 0.0f;
        float end = cylinderWeight(c, receiver, 0u);
        uint step = 0u;
        for (uint i = 0u; i < kCylinderSteps; i++) {
            begin = end;
            end = cylinderWeight(c, receiver, i + 1u);
            step = i;
            if (left < 0.5f * (begin + end) || i + 1u == kCylinderSteps) break;
            left -= 0.5f * (begin + end);
        }
        float within = invertLinear(begin, end, min(left, 0.5f * (begin + end)));
        vec2 sc = cylinderAzimuth(c, (float(step) + within) * (1.0f / float(kCylinderSteps)));
        CylinderSlice slice = sliceCylinder(c, sc);
        vec3 drawn = drawOnCylinder(c, slice, u.y, sc);
        s.pdf = cylinderDensity(c, total, mix(begin, end, within), slice);
        vec3 rim = c.x * drawn.x + c.y * drawn.y;
        float height = clamp(abs(drawn.z - c.low) / (c.high - c.low), 0.0f, 1.0f);
        bool isTurned = dot(c.z, light.normal) < 0.0f;
        place =
            vec3(dot(frame.dualU, rim) * c.radius, dot(frame.dualV, rim) * c.radius, isTurned ? 1.0f - height : height);
    }
    RoundPoint point = roundPoint(light.position, light.edgeU, light.edgeV, light.normal, frame, false, place);
    s.point = point.position;
    s.normal = point.normal;
    vec3 v = s.point - position;
    s.distance = length(v);
    s.wi = v * (1.0f / s.distance);
    if (byArea) s.pdf = cylinderAreaPdf(light, place, s.wi, s.distance);
    if (light.sides != kSidesBoth && dot(s.normal, s.wi) >= 0.0f) s.pdf = 0.0f; // its inside
    s.uv = roundUv(place, -1.0f);
    return s;
}

RT_CALL float cylinderLightPdf(RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal, vec3 wi,
                               float distance, vec3 lightNormal) {
    if (light.sides != kSidesBoth && dot(lightNormal, wi) >= 0.0f) return 0.0f;
    if (cylinderLightStrategy(params, light, position) == kStrategyArea) {
        RoundFrame frame = roundFrame(light.edgeU, light.edgeV, light.normal);
        vec3 place = toRound(frame, position + wi * distance - light.position);
        return cylinderAreaPdf(light, place, wi, distance);
    }
    CylinderView c = viewCylinder(light, position);
    if (!isCylinderSeen(c, light)) return 0.0f;
    vec2 lateral = vec2(dot(wi, c.y), dot(wi, c.x));
    float squared = dot(lateral, lateral);
    if (!(squared > 0.0f)) return 0.0f;
    vec2 sc = lateral * inversesqrt(squared);
    float part = 0.5f + 0.5f * arcTan(sc.x, sc.y) / c.reach;
    float at = clamp(part, 0.0f, 1.0f) * float(kCylinderSteps);
    uint step = min(uint(at), kCylinderSteps - 1u);
    vec3 receiver = cylinderReceiver(params, c, normal);
    float weight = mix(cylinderWeight(c, receiver, step), cylinderWeight(c, receiver, step + 1u), at - float(step));
    return cylinderDensity(c, cylinderTotal(c, receiver), weight, sliceCylinder(c, sc));
}

RT_SHARED_END

#endif
