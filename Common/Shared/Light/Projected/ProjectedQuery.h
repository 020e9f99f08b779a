// What samplers by projected solid angle are asked, and what they answer. The ray tracing pipeline asks through callable
// shaders, so that the code is part of a kernel once, apart from the rest, and only if the scene needs it.
#ifndef RT_SHARED_PROJECTED_QUERY_H
#define RT_SHARED_PROJECTED_QUERY_H
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

const uint kProjectedDraw = 0u;    // draw a point by two random numbers
const uint kProjectedDensity = 1u; // the density at a direction that meets the light

// A parallelogram or triangle (half of it) and a receiver.
struct FanQuery {
    vec3 corner; // relative to the receiver
    vec3 edgeU;
    vec3 edgeV;
    vec3 plane;  // unit normal of the light
    vec3 normal; // of the receiver, unit
    vec3 given;  // the random numbers in x and y, or the direction
    uint kind;   // of the light
    uint use;
};

// A point of the light with the density of its direction on the unit disk of the tangent plane.
struct FanSample {
    vec2 uv;       // of kProjectedDraw
    float density; // 0: nothing is visible
};

// A sphere and a receiver outside of it.
struct CapQuery {
    vec3 toCenter;
    float radius;
    vec3 normal; // of the receiver, unit
    vec3 given;  // as above
    uint use;
};

// A direction with its density on the unit disk of the tangent plane: density per steradian is that times the cosine.
struct CapSample {
    vec3 direction; // this and what follows of kProjectedDraw
    float distance;
    vec3 normal;   // of the sphere
    float density; // 0: nothing is visible
};

RT_SHARED_END

#endif
