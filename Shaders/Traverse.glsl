// Traverses what Common/Accel/GpuBvh builds. One routine answers both questions, what a ray hits first and whether it
// hits anything, because lanes of a group ask both at a time.
#include "Bindings.glsl"
#include "Common/Shared/Medium/Media.h"
#include "Common/Shared/Shape/Rounds.h"
#include "Common/Shared/Shape/Shapes.h"
#include "TracedRay.glsl"
#include "TraverseLists.glsl"
#include "TraverseTree.glsl"

layout(constant_id = kIsLinearId) const uint kIsLinear = 1u; // there are the lists instead of a tree

// See PathLoop.glsl: all lanes of a group shade at a time, then all trace. Of lists a program can hold two copies.
const uint kRaysPerStep = 2u;
bool tracesApart() { return kIsLinear != 0u || !has(kFeatures, kFeatureLights); }

// What the ray, of unit direction, meets in (0, tMax): the nearest, or when `anyHit` the first that is found, and then
// only the sign of t tells anything. A negative t if there is nothing.
Hit traceRay(Ray ray, bool anyHit, float tMax) {
    if (kIsLinear != 0u) return traceLinear(ray, anyHit, tMax);
    return traceTree(ray, anyHit, tMax);
}
