// What a path carries from vertex to vertex, and what a step of it leaves behind. None of it is in the scene.
#ifndef RT_SHARED_PATH_TYPES_H
#define RT_SHARED_PATH_TYPES_H
#include "Common/Shared/Base/Types.h"

RT_SHARED_BEGIN

struct LightChoice {
    uint light;        // kNone: nothing to choose
    float probability; // > 0 otherwise
    float u;           // the number that chose, stretched to [0,1) for further use
};

// Where lights are seen from. The point and the normal (zero in a medium) that selection and sampling used must also be
// those that a density is asked for, or the weights of multiple importance sampling would not sum to one.
struct LightContext {
    vec3 position;
    vec3 normal;
    float total; // sum of contributions where selection is by contribution; 0: no light can contribute
};

const uint kChainNone = 0u;
const uint kChainScattered = 1u;   // by a surface or in a medium, with a density
const uint kChainInside = 2u;      // then refracted into a sphere
const uint kChainInsideAgain = 3u; // and reflected there
const uint kChainBeyond = 4u;      // plus the crossings: then gone on from the sphere

// How a path goes on since it scattered, for the weight against a connection from there through a sphere.
struct SpecularChain {
    vec3 from;   // where it scattered
    float pdf;   // density of the direction that it took there
    float rate;  // probability of a connection there over the sum of weights that it was chosen by; 0: there was none
    uint sphere; // the first of specularCasters that is at the path's vertex; kNone: another surface
    uint met;    // the one that the path was refracted into or reflected on
    uint state;  // kChain...
};

// What of a path is shared, see PathReuse.h.
const uint kReuseBefore = 0u; // it has met mirrors and glass only
const uint kReuseFirst = 1u;  // it has scattered at its first vertex
const uint kReuseSuffix = 2u; // it is behind its second, whose light it finds
const uint kReuseEnded = 3u;  // its first vertex is shared, but there was no second one
const uint kReuseNone = 4u;   // nothing is

// How emission counts that a path's ray finds, see EdgeRays.h.
const uint kEmissionWeighed = 0u;           // against the light sampling of the vertex before
const uint kEmissionApart = 1u;             // not at all: edge rays count it
const uint kEmissionApartBehindGlossy = 2u; // nor behind a glossy mirror, whose reflected light they sample as well
const uint kEmissionOfEdgeRay = 3u;         // in full: the path is an edge ray

// Pixels of a row whose features are sampled together, see SeenSurfaces.h.
const uint kSeenTogether = 4u;

// What a step settles of a path that is shared.
struct SharedPart {
    vec3 prefix;     // at its second vertex: the radiance that it had brought before
    vec3 throughput; // at its first, where scattering is aimed (AimedScattering.h): behind it, had it not been,
    float aimed;     // and the share of directions that are drawn towards a sphere
};

// A path between two steps of PathStep.h.
struct PathState {
    Ray ray;
    vec3 throughput;
    vec3 radiance;
    float pdf;         // density over solid angle of ray.direction; 0: from the camera or a delta lobe
    uint vertex;       // surfaces and collisions met so far; one more where max depth has cut it off
    LightContext last; // where ray starts, for the weights of multiple importance sampling
    // Of techniques, see Techniques.h:
    SpecularChain chain; // where it scattered, for the weights against connections
    uint reuse;          // kReuse...
    uint emission;       // kEmission...
};

// What next-event estimation adds to a path unless something is in the way. The shadow ray starts where the path goes
// on, at PathState::last.position; it is traced only after the step is complete, so that nothing else has to be
// remembered meanwhile.
struct DirectLight {
    vec3 radiance;
    vec3 direction; // unit
    float distance; // that has to be free of surfaces; 0: there is no shadow ray, radiance arrives
};

// Segments of a connection; the one of the lowest bit is traced first.
const uint kSegmentBeyond = 1u; // from the sphere to the light
const uint kSegmentBefore = 2u; // from the vertex to the sphere
const uint kSegmentInside = 4u; // from where it enters to where it leaves, or is reflected
const uint kSegmentAgain = 8u;  // from there to where it leaves

// What a connection by way of a sphere adds to a path unless something is in the way of one of its segments.
struct SpecularConnection {
    vec3 radiance;
    vec3 begin;    // where the path scattered
    vec3 entry[2]; // where the light leaves the sphere's surface and arrives there: outside, inside
    vec3 bounce;   // where it is reflected inside
    vec3 leave[2]; // on the light's side: inside, outside
    vec3 end;      // at the light
    uint segments; // kSegment... that have yet to be found free; 0: there is no connection
};

// What techniques leave behind a step of a path, for the engine to deal with.
struct TechniqueStep {
    SharedPart part;
    SpecularConnection connection;
};

RT_SHARED_END

#endif
