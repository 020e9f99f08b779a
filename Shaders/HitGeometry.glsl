// Where the primitive at hand stands in the scene. Of closest hit and intersection shaders.
#include "RayTracing.glsl"

// Instances are numbered from 1 in the acceleration structure; the world's own geometry is 0.
uint hitInstance() {
    if (!has(kFeatures, kFeatureInstances)) return kNone;
    return uint(gl_InstanceCustomIndexEXT) - 1u;
}

Geometry hitGeometry() {
    Geometry none;
    none.firstSphere = 0u;
    none.firstQuad = 0u;
    none.firstTriangle = 0u;
    if (!has(kFeatures, kFeatureInstances)) return none;
    uint instance = hitInstance();
    uint geometry = instance == kNone ? 0u : constants.arrays.instances.at[instance].geometry;
    return constants.arrays.geometries.at[geometry];
}
