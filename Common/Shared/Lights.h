// Sampling of one light: a direction towards it, and the density of that direction given this light. sampleLight and lightPdf
// take every decision from the same function of the light and the shading point, never from the sample.
#ifndef RT_SHARED_LIGHTS_H
#define RT_SHARED_LIGHTS_H
#include "Bilinear.h"
#include "EllipsoidLight.h"
#include "Features.h"
#include "LightSample.h"
#include "ProjectedQuery.h"
#include "WholeCap.h"
#if defined(RT_PROJECTED) && !defined(RT_PROJECTED_CALLS) // else the includer has the functions
#include "ProjectedPolygon.h"
#include "ProjectedSphere.h"
#endif

RT_SHARED_BEGIN

RT_FN vec3 sphereLightCenter(uint features, RT_IN(Light) light, float time) {
    return has(features, kFeatureMotion) ? light.position + light.edgeU * time : light.position;
}

// Ratio of extent to distance below which directions are too coarse for projected samplers.
const float kTinyExtent = 1.0e-3f;

// ---- regimes --------------------------------------------------------------------------------------------------------

RT_FN bool wantsProjected(uint features, uint method, vec3 normal) {
    return kProjectedCompiled && has(features, kFeatureProjected) && method == kShapeProjected && isSurface(normal);
}

RT_FN uint sphereLightRegime(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 toCenter,
                             vec3 normal) {
    float d2 = dot(toCenter, toCenter);
    float r2 = light.radius * light.radius;
    if (d2 <= r2) return kRegimeInside;
    if (wantsProjected(features, params.sphereLight, normal) && r2 >= kTinyExtent * kTinyExtent * d2)
        return kRegimeProjected;
    // A medium's normal is 0.
    bool whole = r2 >= kLeastCapSine2 * d2 && dot(normal, toCenter) >= light.radius;
    if (params.sphereLight == kShapeAuto && whole) return kRegimeWholeCap;
    return params.sphereLight == kShapeArea ? kRegimeArea : kRegimeSolidAngle;
}

// Whether a quad or triangle is sampled by projected solid angle from a point, `corner` relative to it. One that should be but
// is too small for it is sampled by area.
RT_FN bool isFlatProjected(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 corner, vec3 normal) {
    bool quad = has(features, kFeatureQuadLights) && light.kind == kLightQuad &&
                wantsProjected(features, params.quadLight, normal);
    bool triangle = has(features, kFeatureTriangleLights) && light.kind == kLightTriangle &&
                    wantsProjected(features, params.triangleLight, normal);
    if (!quad && !triangle) return false;
    vec3 toMiddle = corner + (light.edgeU + light.edgeV) * (quad ? 0.5f : 1.0f / 3.0f);
    float extent2 = dot(light.edgeU, light.edgeU) + dot(light.edgeV, light.edgeV);
    return extent2 >= kTinyExtent * kTinyExtent * dot(toMiddle, toMiddle);
}

// Automatic: a flat light whose extent is below a tenth of its distance subtends nearly the same solid angle per area
// everywhere, so the cheaper sampler is as good.
RT_FN bool isFar(vec3 toCenter, vec3 edgeU, vec3 edgeV) {
    return dot(edgeU, edgeU) + dot(edgeV, edgeV) < 0.01f * dot(toCenter, toCenter);
}

RT_FN uint triangleLightRegime(uint features, uint method, RT_IN(Light) light, vec3 corner, vec3 normal) {
    bool area = method == kShapeArea || wantsProjected(features, method, normal);
    if (method == kShapeAuto)
        area = isFar(corner + (light.edgeU + light.edgeV) * (1.0f / 3.0f), light.edgeU, light.edgeV);
    return area ? kRegimeArea : kRegimeSolidAngle;
}

RT_FN bool isRectangle(RT_IN(Light) light) {
    float skew = dot(light.edgeU, light.edgeV);
    return skew * skew <= 1.0e-12f * (dot(light.edgeU, light.edgeU) * dot(light.edgeV, light.edgeV));
}

// Where h(t) = h + slope t, t in [0,1], is above 0: first and last t.
RT_FN vec2 spanAbove(float h, float slope) {
    float zero = clamp(-h / slope, 0.0f, 1.0f);
    return vec2(slope > 0.0f ? zero : 0.0f, slope < 0.0f ? zero : 1.0f);
}

// The part of a quad that can illuminate a surface with this normal, as the smallest parallelogram along its edges around what is
// above the horizon: its first corner and its extent, in coordinates of the edges. Exact where an edge is parallel to the horizon,
// as between walls and floors. Worth its cost near a quad alone, where solid angle is sampled.
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

// A quad light from a point, with what its regime depends on.
struct QuadView {
    vec3 corner; // relative to the point
    uint regime;
    float weighting; // of solid angle by the cosines at the corners, 0 to 1
    bool swapped;    // edgeV is the long edge
    Columns columns; // in that regime
};

// Automatic: a rectangle at twice its short edge or farther is sampled by columns, a nearer one more and more with regard to the
// cosine.
RT_FN QuadView viewQuad(uint features, uint method, RT_IN(Light) light, vec3 position, vec3 normal) {
    QuadView q;
    q.corner = light.position - position;
    bool area = method == kShapeArea || wantsProjected(features, method, normal);
    q.regime = area ? kRegimeArea : kRegimeSolidAngle;
    q.weighting = 0.0f;
    q.swapped = false;
    if (method != kShapeAuto) return q;
    if (isFar(q.corner + (light.edgeU + light.edgeV) * 0.5f, light.edgeU, light.edgeV)) {
        q.regime = kRegimeArea;
    } else if (isRectangle(light)) {
        float u2 = dot(light.edgeU, light.edgeU);
        float v2 = dot(light.edgeV, light.edgeV);
        q.swapped = v2 > u2;
        vec3 longEdge = q.swapped ? light.edgeV : light.edgeU;
        vec3 shortEdge = q.swapped ? light.edgeU : light.edgeV;
        q.columns = makeColumns(q.corner + shortEdge * 0.5f, longEdge, min(u2, v2));
        float shortEdges2 = columnsDistance2(q.columns) / (min(u2, v2) * q.columns.inverse);
        if (shortEdges2 > 4.0f) q.regime = kRegimeColumns;
        // Fading: where the method changes within a pixel, Sobol's points lose what they had gained.
        if (isSurface(normal)) q.weighting = clamp((4.0f - shortEdges2) * (1.0f / 3.0f), 0.0f, 1.0f);
    }
    return q;
}

// ---- spheres --------------------------------------------------------------------------------------------------------

RT_FN CapQuery capQuery(RT_IN(Light) light, vec3 toCenter, vec3 normal, uint use, vec3 given) {
    CapQuery query;
    query.toCenter = toCenter;
    query.radius = light.radius;
    query.normal = normal;
    query.given = given;
    query.use = use;
    return query;
}

RT_FN LightSample sampleSphereProjected(RT_IN(Light) light, vec3 center, vec3 toCenter, vec3 position, vec3 normal,
                                        vec2 u) {
    LightSample s = noLightSample();
#ifdef RT_PROJECTED
    CapSample d = useProjectedSphere(capQuery(light, toCenter, normal, kProjectedDraw, vec3(u.x, u.y, 0.0f)));
    if (!(d.density > 0.0f)) return s;
    s.wi = d.direction;
    s.distance = d.distance;
    s.normal = d.normal;
    bool close = length(toCenter) < 2.0f * light.radius;
    s.point = close ? position + s.wi * s.distance : center + s.normal * light.radius;
    s.pdf = d.density * max(dot(normal, s.wi), 0.0f);
#endif
    return s;
}

RT_FN float sphereProjectedPdf(RT_IN(Light) light, vec3 toCenter, vec3 normal, vec3 wi) {
#ifdef RT_PROJECTED
    float density = useProjectedSphere(capQuery(light, toCenter, normal, kProjectedDensity, wi)).density;
    return density * max(dot(normal, wi), 0.0f);
#else
    return 0.0f;
#endif
}

RT_FN LightSample sampleSphereLight(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position,
                                    vec3 normal, float time, vec2 u) {
    LightSample s = noLightSample();
    vec3 center = sphereLightCenter(features, light, time);
    vec3 toCenter = center - position;
    float radius = light.radius;
    uint regime = sphereLightRegime(features, params, light, toCenter, normal);
    if (has(features, kFeatureProjected) && regime == kRegimeProjected) {
        s = sampleSphereProjected(light, center, toCenter, position, normal, u);
    } else if (regime == kRegimeSolidAngle || regime == kRegimeWholeCap) {
        SphereCone cone = makeSphereCone(toCenter, radius);
        ConeSample c;
        if (regime == kRegimeWholeCap) {
            c = sampleWholeCap(cone, radius, normal, u);
            s.pdf = wholeCapPdf(cone, normal, c.direction);
        } else {
            c = sampleSphereCone(cone, radius, u);
            s.pdf = sphereConePdf(cone);
        }
        s.wi = c.direction;
        s.distance = c.distance;
        s.normal = c.normal;
        // The point must lie on the ray; near the sphere only this form guarantees it, far from it the other is finer.
        s.point = cone.distance < 2.0f * radius ? position + s.wi * s.distance : center + s.normal * radius;
    } else if (regime == kRegimeInside) {
        vec4 w = sampleInside(normal, u);
        s.wi = vec3(w);
        float along = dot(toCenter, s.wi);
        float inside2 = radius * radius - dot(toCenter, toCenter);
        s.distance = along + sqrt(along * along + inside2);
        s.point = position + s.wi * s.distance;
        s.normal = (s.point - center) / radius;
        s.pdf = light.sides == kSidesBoth ? w.w : 0.0f;
    } else {
        s.normal = sampleSphere(u);
        s.point = center + s.normal * radius;
        vec3 v = s.point - position;
        s.distance = length(v);
        s.wi = v / s.distance;
        float cosine = -dot(s.normal, s.wi);
        // The far half is hidden by the near one, and a mixture's density counts the direction once.
        s.pdf = cosine > 0.0f ? areaPdf(light.area, s.distance, cosine) : 0.0f;
    }
    return s;
}

RT_FN float sphereLightPdf(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                           float time, vec3 wi, float distance, vec3 lightNormal) {
    vec3 toCenter = sphereLightCenter(features, light, time) - position;
    uint regime = sphereLightRegime(features, params, light, toCenter, normal);
    // Samples lie on the near side, from inside on the far one. Near a huge sphere rounding may take the point to be inside.
    if ((dot(lightNormal, wi) > 0.0f) != (regime == kRegimeInside)) return 0.0f;
    if (has(features, kFeatureProjected) && regime == kRegimeProjected)
        return sphereProjectedPdf(light, toCenter, normal, wi);
    if (regime == kRegimeSolidAngle) return sphereConePdf(makeSphereCone(toCenter, light.radius));
    if (regime == kRegimeWholeCap) return wholeCapPdf(makeSphereCone(toCenter, light.radius), normal, wi);
    if (regime == kRegimeArea) return areaPdf(light.area, distance, dot(lightNormal, wi));
    return isSurface(normal) ? max(dot(normal, wi), 0.0f) * kInvPi : 0.25f * kInvPi;
}

// ---- flat lights ----------------------------------------------------------------------------------------------------

// Fills in what follows from s.uv.
RT_FN void placeOnLight(RT_INOUT(LightSample) s, RT_IN(Light) light, vec3 position) {
    s.point = light.position + light.edgeU * s.uv.x + light.edgeV * s.uv.y;
    vec3 v = s.point - position;
    s.distance = length(v);
    s.wi = v * (1.0f / s.distance);
    s.normal = light.normal;
}

// The halves (corner, corner + U, corner + U + V) and (corner, corner + U + V, corner + V) of a parallelogram.
RT_FN SphericalTriangle quadHalf(RT_IN(Light) light, vec3 corner, bool second) {
    vec3 opposite = corner + light.edgeU + light.edgeV;
    vec3 v1 = second ? opposite : corner + light.edgeU;
    vec3 v2 = second ? corner + light.edgeV : opposite;
    return makeSphericalTriangle(corner, v1, v2, light.normal * light.area);
}

RT_FN SphericalTriangle triangleShape(RT_IN(Light) light, vec3 corner) {
    return makeSphericalTriangle(corner, corner + light.edgeU, corner + light.edgeV,
                                 light.normal * (2.0f * light.area));
}

// Coordinates of p, relative to the corner and in the light's plane, in the basis of the edges.
RT_FN vec2 edgeCoordinates(RT_IN(Light) light, vec3 p) {
    vec3 n = cross(light.edgeU, light.edgeV);
    return vec2(dot(cross(p, light.edgeV), n), dot(cross(light.edgeU, p), n)) * (1.0f / dot(n, n));
}

// Fills in what follows from s.wi, a direction that meets the light's plane.
RT_FN void projectToLight(RT_INOUT(LightSample) s, RT_IN(Light) light, vec3 corner, vec3 position) {
    s.distance = dot(corner, light.normal) / dot(s.wi, light.normal);
    s.point = position + s.wi * s.distance;
    s.normal = light.normal;
    s.uv = edgeCoordinates(light, s.wi * s.distance - corner);
}

RT_FN SphericalRectangle rectangleShape(RT_IN(Light) light, vec3 corner) {
    return makeSphericalRectangle(corner, light.edgeU, light.edgeV, light.normal);
}

// Cosines to the receiver's normal at the corners of a rectangle. Within a rectangle that is cut by the horizon none is so small
// that the density falls far below the cosine elsewhere.
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
    float most = max(max(max(cosines.x, cosines.y), max(cosines.z, cosines.w)), 0.01f);
    return mix(vec4(most), max(cosines, vec4(0.1f * most)), weighting);
}

// By solid angle: uniform, or weighted by the cosines at the corners, if the rectangle is not so small that they hardly differ. A pdf
// of 0 if the light is too small for that.
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
    s.wi = sampleSphericalTriangle(half0, vec2(min(x / half0.solidAngle, 1.0f), u.y));
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

RT_FN FanQuery fanQuery(RT_IN(Light) light, vec3 corner, vec3 normal, uint use, vec3 given) {
    FanQuery query;
    query.corner = corner;
    query.edgeU = light.edgeU;
    query.edgeV = light.edgeV;
    query.plane = light.normal;
    query.normal = normal;
    query.given = given;
    query.kind = light.kind;
    query.use = use;
    return query;
}

RT_FN LightSample sampleFlatProjected(RT_IN(Light) light, vec3 corner, vec3 position, vec3 normal, vec2 u) {
    LightSample s = noLightSample();
#ifdef RT_PROJECTED
    FanSample drawn = useProjectedPolygon(fanQuery(light, corner, normal, kProjectedDraw, vec3(u.x, u.y, 0.0f)));
    if (!(drawn.density > 0.0f)) return s;
    s.uv = drawn.uv;
    placeOnLight(s, light, position);
    s.pdf = drawn.density * max(dot(normal, s.wi), 0.0f);
#endif
    return s;
}

RT_FN float flatProjectedPdf(RT_IN(Light) light, vec3 corner, vec3 normal, vec3 wi) {
#ifdef RT_PROJECTED
    float density = useProjectedPolygon(fanQuery(light, corner, normal, kProjectedDensity, wi)).density;
    return density * max(dot(normal, wi), 0.0f);
#else
    return 0.0f;
#endif
}

RT_FN LightSample sampleQuadLight(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position,
                                  vec3 normal, vec2 u) {
    QuadView view = viewQuad(features, params.quadLight, light, position, normal);
    LightSample s = noLightSample();
    if (view.regime == kRegimeSolidAngle) {
        QuadPart part = partAboveHorizon(light, view.corner, normal);
        s = sampleQuadSolidAngle(partOfQuad(light, part), position, normal, view.weighting, u);
        s.uv = part.from + s.uv * part.size;
        if (s.pdf > 0.0f) return s;
    }
    s.uv = u;
    float density = 1.0f;
    if (view.regime == kRegimeColumns) {
        ColumnSample c = sampleColumns(view.columns, view.swapped ? u.y : u.x);
        density = c.pdf;
        s.uv = view.swapped ? vec2(u.x, c.a) : vec2(c.a, u.y);
    }
    placeOnLight(s, light, position);
    s.pdf = density * areaPdf(light.area, s.distance, dot(light.normal, s.wi));
    return s;
}

RT_FN float quadLightPdf(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                         vec3 wi, float distance) {
    QuadView view = viewQuad(features, params.quadLight, light, position, normal);
    if (view.regime == kRegimeSolidAngle) {
        Light quad = partOfQuad(light, partAboveHorizon(light, view.corner, normal));
        float pdf = quadSolidAnglePdf(quad, position, normal, view.weighting, wi * distance);
        if (pdf > 0.0f) return pdf;
    }
    float density = 1.0f;
    if (view.regime == kRegimeColumns) {
        float along = dot(wi, view.swapped ? light.edgeV : light.edgeU);
        density = columnsPdf(view.columns, along * distance * view.columns.inverse);
    }
    return density * areaPdf(light.area, distance, dot(light.normal, wi));
}

RT_FN LightSample sampleTriangleLight(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position,
                                      vec3 normal, vec2 u) {
    LightSample s = noLightSample();
    vec3 corner = light.position - position;
    uint regime = triangleLightRegime(features, params.triangleLight, light, corner, normal);
    if (regime == kRegimeSolidAngle) {
        SphericalTriangle t = triangleShape(light, corner);
        if (t.solidAngle >= kTinySolidAngle) {
            s.wi = sampleSphericalTriangle(t, u);
            projectToLight(s, light, corner, position);
            s.pdf = 1.0f / t.solidAngle;
            return s;
        }
    }
    s.uv = sampleTriangleArea(u);
    placeOnLight(s, light, position);
    s.pdf = areaPdf(light.area, s.distance, dot(light.normal, s.wi));
    return s;
}

RT_FN float triangleLightPdf(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                             vec3 wi, float distance) {
    vec3 corner = light.position - position;
    uint regime = triangleLightRegime(features, params.triangleLight, light, corner, normal);
    if (regime == kRegimeSolidAngle) {
        float solidAngle = triangleShape(light, corner).solidAngle;
        if (solidAngle >= kTinySolidAngle) return 1.0f / solidAngle;
    }
    return areaPdf(light.area, distance, dot(light.normal, wi));
}

// ---- any light ------------------------------------------------------------------------------------------------------

// Whether a point lies on the side that a flat light illuminates.
RT_FN bool isLit(RT_IN(Light) light, vec3 position) {
    return light.sides == kSidesBoth || dot(light.normal, position - light.position) > 0.0f;
}

// `normal` is the shading point's geometric normal on the side of wo, zero for a point in a medium. The sky is not
// sampled here (Sky.h).
RT_FN LightSample sampleLight(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                              float time, vec2 u) {
    LightSample s = noLightSample();
    if (has(features, kFeatureSphereLights) && light.kind == kLightSphere) {
        s = sampleSphereLight(features, params, light, position, normal, time, u);
    } else if (has(features, kFeatureEllipsoidLights) && light.kind == kLightEllipsoid) {
        s = sampleEllipsoidLight(params, light, position, normal, u);
    } else if (light.kind != kLightSky && isLit(light, position)) {
        vec3 corner = light.position - position;
        if (isFlatProjected(features, params, light, corner, normal)) {
            s = sampleFlatProjected(light, corner, position, normal, u);
        } else if (has(features, kFeatureQuadLights) && light.kind == kLightQuad) {
            s = sampleQuadLight(features, params, light, position, normal, u);
        } else if (has(features, kFeatureTriangleLights) && light.kind == kLightTriangle) {
            s = sampleTriangleLight(features, params, light, position, normal, u);
        }
    }
    s.radiance = light.emission;
    // Rounding may let the point coincide with the shading point, and the direction run within the light's plane, which is
    // then infinitely far, or behind.
    bool isAhead = s.distance > 0.0f && s.distance < kInfinity;
    if (!(s.pdf < kInfinity && isAhead && dot(s.wi, s.wi) < 2.0f)) s.pdf = 0.0f;
    if (isSurface(normal) && dot(normal, s.wi) <= 0.0f) s.pdf = 0.0f;
    return s;
}

// Density of wi under sampleLight, for a direction that meets the light at `distance` under its geometric normal
// `lightNormal`.
RT_FN float lightPdf(uint features, RT_IN(RenderParams) params, RT_IN(Light) light, vec3 position, vec3 normal,
                     float time, vec3 wi, float distance, vec3 lightNormal) {
    if (has(features, kFeatureSphereLights) && light.kind == kLightSphere) {
        return sphereLightPdf(features, params, light, position, normal, time, wi, distance, lightNormal);
    }
    if (has(features, kFeatureEllipsoidLights) && light.kind == kLightEllipsoid) {
        return ellipsoidLightPdf(params, light, position, normal, wi, distance, lightNormal);
    }
    vec3 corner = light.position - position;
    if (isFlatProjected(features, params, light, corner, normal)) return flatProjectedPdf(light, corner, normal, wi);
    if (has(features, kFeatureQuadLights) && light.kind == kLightQuad) {
        return quadLightPdf(features, params, light, position, normal, wi, distance);
    }
    if (has(features, kFeatureTriangleLights) && light.kind == kLightTriangle) {
        return triangleLightPdf(features, params, light, position, normal, wi, distance);
    }
    return 0.0f;
}

// Bound of the error per axis of a point sampled on the light, for offsetOrigin at the light's end of a shadow ray: several
// times that of the point itself, since the device that traces the ray also rounds when it tests the light's shape.
RT_FN vec3 lightPointError(uint features, RT_IN(Light) light) {
    if (has(features, kFeatureEllipsoidLights) && light.kind == kLightEllipsoid) {
        return ellipsoidError(ellipsoidOf(light), light.position);
    }
    if (light.kind == kLightSphere) {
        float reach = maxComponent(abs(light.position) + abs(light.edgeU)) + light.radius;
        return vec3(32.0f * kEpsilon * reach);
    }
    return 32.0f * kEpsilon * (abs(light.position) + abs(light.edgeU) + abs(light.edgeV)) +
           extentError(light.edgeU, light.edgeV);
}

RT_SHARED_END

#endif
