// Bright patches of the sky image, as connections by way of smooth spheres lead to them: suns, lamps and windows.
#ifndef RT_SHARED_SKY_PATCHES_H
#define RT_SHARED_SKY_PATCHES_H
#include "Common/Shared/Light/Sky.h"

RT_SHARED_BEGIN

RT_FN bool isInPatch(RT_IN(SkyPatch) p, uvec2 texel) {
    return texel.x >= p.begin.x && texel.x < p.end.x && texel.y >= p.begin.y && texel.y < p.end.y;
}

// Probability with which sampleSky() would choose one of the patch's rows, times that of one of its columns given this
// row. 0: there is nothing to sample.
RT_FN float patchShare(SceneRef scene, RT_IN(Image) image, RT_IN(SkyPatch) p, uint row) {
    uint columns = skyColumns(image, row);
    return (loadSkyCdf(scene, p.end.y) - loadSkyCdf(scene, p.begin.y)) *
           (loadSkyCdf(scene, columns + p.end.x) - loadSkyCdf(scene, columns + p.begin.x));
}

// Density of sampleSkyPatch() where sampleSky() has density `pdf`, given the share of the row.
RT_FN float pdfInPatch(float pdf, float share) {
    return share > 0.0f ? pdf / share : 0.0f;
}

// Density over solid angle of sampleSkyPatch() in a direction within this texel of the patch.
RT_FN float skyPatchPdf(SceneRef scene, RT_IN(Image) image, RT_IN(SkyPatch) p, uvec2 texel) {
    return pdfInPatch(skyTexelPdf(scene, image, texel), patchShare(scene, image, p, texel.y));
}

// As sampleSky(), but within the patch: a row in proportion to all of its light, and a column by that in the patch.
RT_FN LightSample sampleSkyPatch(SceneRef scene, RT_IN(SkyPatch) p, vec2 u) {
    RT_IN(Image) image = loadImage(scene, loadGlobals(scene).skyImage);
    vec2 at;
    at.y = mix(loadSkyCdf(scene, p.begin.y), loadSkyCdf(scene, p.end.y), u.y);
    uint row = p.begin.y + skyCell(scene, p.begin.y, p.end.y - p.begin.y, at.y);
    uint first = skyColumns(image, row) + p.begin.x;
    at.x = mix(loadSkyCdf(scene, first), loadSkyCdf(scene, first + p.end.x - p.begin.x), u.x);
    uvec2 texel = uvec2(p.begin.x + skyCell(scene, first, p.end.x - p.begin.x, at.x), row);
    LightSample s = sampleSkyTexel(scene, texel, at);
    s.pdf = pdfInPatch(s.pdf, patchShare(scene, image, p, row));
    return s;
}

RT_SHARED_END

#endif
