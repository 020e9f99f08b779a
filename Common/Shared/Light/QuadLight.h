// Sampling of quads: uniform in area, solid angle or projected solid angle, or what serves best from where it is seen.
#ifndef RT_SHARED_QUAD_LIGHT_H
#define RT_SHARED_QUAD_LIGHT_H
#include "Common/Shared/Base/Random.h"
#include "Common/Shared/Light/FlatLight.h"
#include "Common/Shared/Shape/SphericalShapes.h"
#include "Common/Shared/Texture/Bilinear.h"

RT_SHARED_BEGIN

RT_FN bool isRectangle(RT_IN(Light) light) {
    float skew = dot(light.edgeU, light.edgeV);
    return skew * skew <= 1.0e-12f * (dot(light.edgeU, light.edgeU) * dot(light.edgeV, light.edgeV));
}

// Where h(t) = h + slope t, t in [0,1], is above 0: first and last t.
RT_FN vec2 spanAbove(float h, float slope) {
    float zero = clamp(-h / slope, 0.0f, 1.0f);
    return vec2(slope > 0.0f ? zero : 0.0f, slope < 0.0f ? zero : 1.0f);
}

// The part of a quad that can illuminate a surface with this normal, as the smallest parallelogram along its edges
// around what is above the horizon: its first corner and its extent, in coordinates of the edges. Exact where an edge
// is parallel to the horizon, as between walls and floors. Worth its cost near a quad alone, where solid angle is
// sampled.
struct QuadPart {
    vec2 from;
    vec2 size;
};

RT_FN QuadPart partAboveHorizon(RT_IN(Light) light, vec3 corner, vec3 normal) {
    QuadPart part;
    part.from = vec2(0.0f);
    part.size = vec2(1.0f);
    float h = dot(normal, corner);
    float u = dot(normal, light.edgeU);
    float v = dot(normal, light.edgeV);
    if (h + min(u, 0.0f) + min(v, 0.0f) >= 0.0f) return part;
    vec2 spanU = spanAbove(h + max(v, 0.0f), u);
    vec2 spanV = spanAbove(h + max(u, 0.0f), v);
    part.from = vec2(spanU.x, spanV.x);
    part.size = vec2(spanU.y - spanU.x, spanV.y - spanV.x);
    return part;
}

RT_FN Light partOfQuad(RT_IN(Light) light, RT_IN(QuadPart) part) {
    Light quad = light;
    quad.position = light.position + light.edgeU * part.from.x + light.edgeV * part.from.y;
    quad.edgeU = light.edgeU * part.size.x;
    quad.edgeV = light.edgeV * part.size.y;
    quad.area = light.area * (part.size.x * part.size.y);
    return quad;
}

// A quad light from a point, with what its strategy depends on.
struct QuadView {
    vec3 corner; // relative to the point
    uint strategy;
    float weighting; // of solid angle by the cosines at the corners, 0 to 1
    bool swapped;    // edgeV is the long edge
    Strip strip;     // of a rectangle, under the automatic method
};

// Automatic: a rectangle at twice its short edge or farther is sampled as a strip, a nearer one more and more with
// regard to the cosine. Without a branch but for the method, for loops over lights.
RT_FN QuadView viewQuad(Features features, uint method, RT_IN(Light) light, vec3 position, vec3 normal) {
    QuadView q;
    q.corner = light.position - position;
    q.swapped = false;
    if (method != kShapeAuto) {
        bool area = method == kShapeArea || wantsProjected(features, method, normal);
        q.strategy = area ? kStrategyArea : kStrategySolidAngle;
        q.weighting = 0.0f;
        return q;
    }
    float u2 = dot(light.edgeU, light.edgeU);
    float v2 = dot(light.edgeV, light.edgeV);
    q.swapped = v2 > u2;
    vec3 longEdge = select(q.swapped, light.edgeV, light.edgeU);
    vec3 shortEdge = select(q.swapped, light.edgeU, light.edgeV);
    q.strip = makeStrip(q.corner + shortEdge * 0.5f, longEdge, min(u2, v2));
    float shortEdges2 = stripDistance2(q.strip) / (min(u2, v2) * q.strip.inverse);
    // Fading: where the method changes within a pixel, Sobol's points lose what they had gained.
    float near = clamp((4.0f - shortEdges2) * (1.0f / 3.0f), 0.0f, 1.0f);
    bool rectangle = isRectangle(light);
    q.weighting = rectangle && isSurface(normal) ? near : 0.0f;
    uint apart = isFar(q.corner + (light.edgeU + light.edgeV) * 0.5f, light.edgeU, light.edgeV) ? kStrategyArea
                                                                                                : kStrategySolidAngle;
    bool asStrip = rectangle && shortEdges2 > 4.0f && apart != kStrategyArea;
    q.strategy = asStrip ? kStrategyStrip : apart;
    return q;
}

// The halves (corner, corner + U, corner + U + V) and (corner, corner + U + V, corner + V) of a parallelogram.
RT_FN SphericalTriangle quadHalf(RT_IN(Light) light, vec3 corner, bool second) {
    vec3 opposite = corner + light.edgeU + light.edgeV;
    vec3 v1 = second ? opposite : corner + light.edgeU;
    vec3 v2 = second ? corner + light.edgeV : opposite;
    return makeSphericalTriangle(corner, v1, v2, light.normal * light.area);
}

RT_FN SphericalRectangle rectangleShape(RT_IN(Light) light, vec3 corner) {
    return makeSphericalRectangle(corner, light.edgeU, light.edgeV, light.normal);
}

// Cosines to the receiver's normal at the corners of a rectangle. Within a rectangle that is cut by the horizon none is
// so small that the density falls far below the cosine elsewhere.
RT_FN vec4 cornerCosines(RT_IN(SphericalRectangle) r, vec3 normal, float weighting) {
    float x1 = r.x0 + r.width;
    float y1 = r.y0 + r.height;
    float u0 = dot(normal, r.xAxis) * r.x0;
    float u1 = dot(normal, r.xAxis) * x1;
    float v0 = dot(normal, r.yAxis) * r.y0;
    float v1 = dot(normal, r.yAxis) * y1;
    float z = dot(normal, r.zAxis) * r.h;
    vec4 heights = vec4(u0 + v0 + z, u1 + v0 + z, u0 + v1 + z, u1 + v1 + z);
    vec4 cosines = heights * cornerReciprocals(r.x0, x1, r.y0, y1, r.h);
    float maximum = max(max(max(cosines.x, cosines.y), max(cosines.z, cosines.w)), 0.01f);
    return mix(vec4(maximum), max(cosines, vec4(0.1f * maximum)), weighting);
}

// By solid angle: uniform, or weighted by the cosines at the corners, if the rectangle is not so small that they hardly
// differ. A pdf of 0 if the light is too small for that.
RT_FN LightSample sampleQuadSolidAngle(RT_IN(Light) light, vec3 position, vec3 normal, float weighting, vec2 u) {
    LightSample s = noLightSample();
    vec3 corner = light.position - position;
    if (isRectangle(light)) {
        SphericalRectangle r = rectangleShape(light, corner);
        if (!(r.solidAngle >= kTinySolidAngle)) return s;
        vec2 numbers = u;
        s.pdf = 1.0f / r.solidAngle;
        if (weighting > 0.0f && r.solidAngle >= kSmallRectangle) {
            vec4 cosines = cornerCosines(r, normal, weighting);
            numbers = sampleBilinear(cosines, u);
            s.pdf *= bilinearDensity(cosines, numbers);
        }
        vec2 p = sampleSphericalRectangle(r, numbers);
        s.uv = vec2(p.x / r.width, p.y / r.height);
        placeOnLight(s, light, position);
        return s;
    }
    SphericalTriangle half0 = quadHalf(light, corner, false);
    SphericalTriangle half1 = quadHalf(light, corner, true);
    float whole = half0.solidAngle + half1.solidAngle;
    if (!(whole >= kTinySolidAngle)) return s;
    // The number that chooses the half is stretched to place the point in it, which keeps strata together.
    float x = u.x * whole;
    bool second = x >= half0.solidAngle;
    if (second) {
        x -= half0.solidAngle;
        half0 = half1;
    }
    s.wi = sampleSphericalTriangle(half0, vec2(remapSample(x, 0.0f, half0.solidAngle), u.y));
    projectToLight(s, light, corner, position);
    s.pdf = 1.0f / whole;
    return s;
}

// The same for the direction to a point of the light, relative to the position.
RT_FN float quadSolidAnglePdf(RT_IN(Light) light, vec3 position, vec3 normal, float weighting, vec3 toPoint) {
    vec3 corner = light.position - position;
    if (!isRectangle(light)) {
        float whole = quadHalf(light, corner, false).solidAngle + quadHalf(light, corner, true).solidAngle;
        return whole >= kTinySolidAngle ? 1.0f / whole : 0.0f;
    }
    SphericalRectangle r = rectangleShape(light, corner);
    if (!(r.solidAngle >= kTinySolidAngle)) return 0.0f;
    float pdf = 1.0f / r.solidAngle;
    if (weighting > 0.0f && r.solidAngle >= kSmallRectangle) {
        vec2 place = vec2(dot(toPoint, r.xAxis) - r.x0, dot(toPoint, r.yAxis) - r.y0);
        pdf *= bilinearDensity(cornerCosines(r, normal, weighting), wideRectangleNumbers(r, place));
    }
    return pdf;
}

// The sample where the strategy is by area or as a strip.
RT_FN LightSample sampleQuadApart(RT_IN(QuadView) view, RT_IN(Light) light, vec3 position, vec2 u) {
    LightSample s = noLightSample();
    s.uv = u;
    float density = 1.0f;
    if (view.strategy == kStrategyStrip) {
        StripSample c = sampleStrip(view.strip, view.swapped ? u.y : u.x);
        density = c.pdf;
        s.uv = vec2(view.swapped ? u.x : c.a, view.swapped ? c.a : u.y);
    }
    placeOnLight(s, light, position);
    s.pdf = density * areaPdf(light.area, s.distance, dot(light.normal, s.wi));
    return s;
}

RT_FN LightSample sampleQuadLight(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position,
                                  vec3 normal, vec2 u) {
    QuadView view = viewQuad(features, params.quadLight, light, position, normal);
    if (view.strategy == kStrategySolidAngle) {
        QuadPart part = partAboveHorizon(light, view.corner, normal);
        LightSample s = sampleQuadSolidAngle(partOfQuad(light, part), position, normal, view.weighting, u);
        s.uv = part.from + s.uv * part.size;
        if (s.pdf > 0.0f) return s;
    }
    return sampleQuadApart(view, light, position, u);
}

RT_FN float quadLightPdf(Features features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                         vec3 wi, float distance) {
    QuadView view = viewQuad(features, params.quadLight, light, position, normal);
    if (view.strategy == kStrategySolidAngle) {
        Light quad = partOfQuad(light, partAboveHorizon(light, view.corner, normal));
        float pdf = quadSolidAnglePdf(quad, position, normal, view.weighting, wi * distance);
        if (pdf > 0.0f) return pdf;
    }
    float density = 1.0f;
    if (view.strategy == kStrategyStrip) {
        float along = dot(wi, view.swapped ? light.edgeV : light.edgeU);
        density = stripPdf(view.strip, along * distance * view.strip.inverse);
    }
    return density * areaPdf(light.area, distance, dot(light.normal, wi));
}

RT_SHARED_END

#endif
