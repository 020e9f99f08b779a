// Where the primitive at hand stands in the scene. Of closest hit and intersection shaders.
#include "RayTracing.glsl"
#include "Instances.glsl"

uint hitInstance() {
    return instanceOf(uint(gl_InstanceCustomIndexEXT));
}

Geometry hitGeometry() {
    return geometryOf(hitInstance());
}
