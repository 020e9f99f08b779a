// The compiled scene's records: what kernels see, CPU or GPU, byte for byte (scalar block layout). Lengths are in world
// units, relative to SceneGlobals::origin; radiance is linear RGB with Rec. 709 primaries.
#ifndef RT_SHARED_TYPES_H
#define RT_SHARED_TYPES_H
#include "Common/Shared/Base/Shim.h"
#include "Common/Shared/Material/PrincipledParameters.h"
#include "Common/Shared/Shape/ShapeRecords.h"

RT_SHARED_BEGIN

const float kPi = 3.14159265358979f;
const float kInvPi = 0.318309886183791f;
const float kInfinity = 3.0e38f;      // farther than any hit; finite, because GLSL may not honour infinities
const float kEpsilon = 5.9604645e-8f; // 2^-24, the unit roundoff of a float
const uint kNone = 0xffffffffu;       // "no such index"

// Kinds of primitive, also the kinds of hit.
const uint kSphere = 0u;
const uint kQuad = 1u;
const uint kTriangle = 2u;
const uint kRound = 3u;

// ---- geometry ------------------------------------------------------------------------------------------------------

// What the triangles of one mesh and one material share. A triangle's front is the side from which its vertices turn
// counter-clockwise. Vertex attributes exist per vertex or not at all for a whole mesh.
struct Mesh {
    uint material;
    uint firstTriangle;
    uint triangleCount;
    uint firstVertex;
    uint firstNormal;  // into normals: normals[firstNormal + vertex - firstVertex]; kNone: flat
    uint firstUv;      // into uvs, as firstNormal; kNone: barycentric coordinates serve as texture coordinates
    uint firstUv2;     // into uvs, as firstNormal, of the second set; kNone: there is none
    uint firstColor;   // into colors, as firstNormal; kNone: white
    uint firstTangent; // into tangents, as firstNormal; kNone: there are none
    uint firstLight;   // light of triangle i is firstLight + i - firstTriangle; kNone: not in the light table
};

// A contiguous run of each kind of primitive: the unit that instances refer to. Geometry 0 is the world's own.
struct Geometry {
    uint firstSphere;
    uint sphereCount;
    uint firstQuad;
    uint quadCount;
    uint firstTriangle;
    uint triangleCount;
    uint firstRound;
    uint roundCount;
};

// Affine placement of a geometry; x' = row . (x, 1). Both directions were rounded once, from double.
struct Instance {
    vec4 toWorld[3];
    vec4 toObject[3];
    uint geometry; // > 0
    uint material; // overrides the primitives' own unless kNone
    uint light;    // of a unit sphere that emits; kNone for all others
};

// ---- appearance ----------------------------------------------------------------------------------------------------

const uint kSidesFront = 1u;
const uint kSidesBoth = 3u;

const uint kMaterialParameters = 2u;
const uint kAlbedoSteps = 32u; // of the table of directional albedos, see PrincipledAlbedos.h
// Of that of stretched facets: cosines, directions about the normal, roughnesses, strengths.
const uint kStretchedCosines = 16u;
const uint kStretchedTurns = 8u;
const uint kStretchedRoughnesses = 16u;
const uint kStretchedStrengths = 10u;

// What kinds there are and what their parameters mean: Common/Shared/Material/Materials.h.
struct Material {
    uint kind;                            // kMaterial...
    vec3 albedo;                          // the colour parameter; the texture replaces it
    uint texture;                         // kNone: constant
    float parameter[kMaterialParameters]; // the numbers
    vec3 emission;                        // emitted radiance; zero for most. Any material may emit as well as scatter
    uint emissionTexture;                 // multiplies emission; kNone: constant
    uint emissionSides;                   // kSidesFront or kSidesBoth
};

const uint kTextureSolid = 0u;
const uint kTextureChecker = 1u;    // solid checker in world space
const uint kTextureMarble = 2u;     // 0.5 (1 + sin(frequency z + 10 turbulence(scale p)))
const uint kTextureTurbulence = 3u; // turbulence(scale p)
const uint kTextureNoise = 4u;      // 0.5 (1 + noise(scale p))
const uint kTextureImage = 5u;

// What lies beyond the edges of an image.
const uint kWrapClamp = 0u;
const uint kWrapRepeat = 1u;
const uint kWrapMirror = 2u;

struct Texture {
    uint kind;
    vec3 color;      // solid: the colour; noise kinds and images: a tint
    float scale;     // checker: edge of a cell; noise: multiplies the point
    float frequency; // marble
    uint first;      // checker: texture of even cells; noise: Perlin table; image: index into images
    uint second;     // checker: texture of odd cells
    uint wrapU;      // images: kWrap...
    uint wrapV;
    uint uvSet; // images: 0 or 1, of a mesh's texture coordinates
    vec3 uRow;  // images: the place is (uRow . (u, v, 1), vRow . (u, v, 1)), before wrapping
    vec3 vRow;
};

const uint kTexelSrgb8 = 0u;      // one word a texel, R in the low byte, opacity in the high one; colours sRGB-encoded
const uint kTexelLinearF32 = 1u;  // three words a texel, floats
const uint kTexelLinear8 = 2u;    // as kTexelSrgb8, but not encoded
const uint kTexelLinearF32A = 3u; // four words a texel, floats, the last of them opacity

struct Image {
    uint firstTexel; // word offset into texels
    uint width;
    uint height;
    uint format;
};

// Perlin's tables: kPerlinSize unit gradients and three permutations of [0, kPerlinSize).
const uint kPerlinSize = 256u;

// ---- participating media -------------------------------------------------------------------------------------------

const uint kMediumSphere = 0u; // boundary: the unit sphere under the inverse of toLocal
const uint kMediumBox = 1u;    // boundary: the cube [-1,1]^3 under the inverse of toLocal

struct Medium {
    vec4 toLocal[3]; // affine world-to-local, rows
    uint shape;
    float extinction; // per world unit of length, > 0
    vec3 albedo;      // single scattering
    uint texture;     // replaces albedo; kNone: constant
};

// ---- lights --------------------------------------------------------------------------------------------------------

const uint kLightSphere = 0u;
const uint kLightQuad = 1u;
const uint kLightTriangle = 2u;
const uint kLightSky = 3u;       // the sky image
const uint kLightEllipsoid = 4u; // the unit sphere under an affine map
const uint kLightDisk = 5u;
const uint kLightCylinder = 6u;
// Punctual lights, which no ray can hit: kinds from here on.
const uint kLightPoint = 7u;
const uint kLightSpot = 8u;
const uint kLightDirectional = 9u;

// An emitter with its geometry in world space, or an importance target (emission zero).
struct Light {
    uint kind;
    uint material; // kNone for the sky, punctual lights and importance targets
    vec3 position; // sphere: centre at time 0; quad: corner; triangle: vertex 0; ellipsoid, disk: centre; cylinder:
                   // that of its base; directional light: centre of the scene
    vec3 edgeU;    // quad; triangle: vertex 1 - vertex 0; sphere: displacement over the shutter; ellipsoid: image of x;
                   // disk, cylinder: as in Round; spot: 1 - cos(outer angle), 1 / (cos(inner) - cos(outer)), 0
    vec3 edgeV;    // quad; triangle: vertex 2 - vertex 0; ellipsoid: image of y; disk, cylinder: as in Round; near
                   // sphere: its power, 1, 0
    vec3 normal;   // unit, front side; quad, triangle, disk; ellipsoid: image of z; cylinder: from base to top; unit
                   // direction in which a spot or directional light shines
    float radius;  // sphere; ellipsoid, cylinder: that of a sphere of the same area; disk: Round::hole; directional
                   // light: of the scene
    float area;    // world units squared, one side; of an ellipsoid within 1.1 %; of a punctual light its flux over
                   // pi times its emission
    vec3 emission; // radiance, mean over the surface if textured; point: radiant intensity; spot: that on its axis;
                   // directional: irradiance of a surface across its direction
    uint sides;    // kSidesFront or kSidesBoth
    uint triangle; // of a mesh's triangle: into triangles
    float selection; // probability under power-proportional selection
    float cdf;       // sum of selection up to and including this light; exactly 1 for the last that can be chosen
};

// What bounds a light's contribution at a point: a sphere around it and the cone of its normals.
struct LightBound {
    vec3 center;
    float radius;
    vec3 axis;             // unit normal of a flat light; zero for a light that emits in all directions
    float twoSided;        // 1: emits to both sides of axis
    float omnidirectional; // 1: there is no axis; otherwise 0
    float intensity;       // luminance(emission) * area (sphere: * pi r^2): radiant intensity along the normal
};

const uint kContributionLights = 32u; // up to here `contribution` weighs every light at the shading point

struct LightWeights {
    float weight[kContributionLights];
};

// A place on the line along which the weights of a short table are laid end to end.
struct LightPick {
    uint light;   // whose weight is there
    float weight; // of this light
    float beyond; // the part of it behind the place
    float total;  // of all weights
};

// ---- spheres by way of which lights are connected to ----------------------------------------------------------------

const uint kConnectedSpheres = 8u; // at most
const uint kReachSteps = 16u;

// Crossings of a sphere by the light that goes on from it.
const uint kReflectedOutside = 0u;
const uint kRefracted = 1u;       // where it enters and where it leaves
const uint kReflectedInside = 2u; // and in between once, after which it crosses the sphere again

// A sphere of glass or a mirror, and a way by which light goes on from it to a point: one sphere of glass may be there
// three times.
struct SpecularCaster {
    vec3 center; // at time 0
    float radius;
    vec3 motion;             // displacement over the shutter
    float inverseEta;        // index outside over inside, < 1; 0: a mirror
    vec3 tint;               // of light that has gone this way
    uint crossings;          // how often the light crosses the sphere: kReflectedOutside...
    uint primitive;          // into spheres
    uint instance;           // into instances; kNone: it is one of the world's own
    float error;             // what the instance's map adds to the rounding of points on the surface
    float nearest;           // least radius over distance at which light through it is thought to matter; 1: nowhere
    uint firstLight;         // into casterLights: the lights that are connected to by way of it
    uint lightCount;         // kCasterLights at most
    vec2 reach[kReachSteps]; // by that ratio: cosine of how far, seen from the centre, a point may be from opposite
                             // a light, and irradiance there over that at the centre
};

const uint kCasterLights = 32u; // by way of one sphere, at most

// A light, or a patch of the sky image, as one of these spheres sees it.
struct CasterLight {
    vec3 axis;     // unit, from the sphere to the light; from the light to the sphere where that reflects
    vec2 extent;   // cosine and sine of the angle that bounds the light
    float weight;  // irradiance at the sphere, > 0
    uint light;    // into lights
    uint skyPatch; // of the sky: into skyPatches; kNone: any other light
};

// A bright part of the sky image that connections lead to: these texels.
struct SkyPatch {
    uvec2 begin; // column and row of the first
    uvec2 end;   // behind the last
};

// ---- light tree ----------------------------------------------------------------------------------------------------
// Over more lights `contribution` descends a tree. Node 0 is the root.

const uint kLightNodeChildren = 8u;
const uint kLightLeaf = 0x80000000u; // in LightNode::child: the rest is a light, not a node

// Bounds of up to eight children, each a light or a node, field by field so that they are weighed side by side. A child
// that does not exist has no intensity. Six cache lines.
struct LightNode {
    float centerX[8]; // of a sphere around the child's lights
    float centerY[8];
    float centerZ[8];
    float radius[8]; // negative: the child is a single light
    float axisX[8];  // unit axis of a cone that holds the normals of the lights counted in `planarIntensity`
    float axisY[8];
    float axisZ[8];
    float meanResultantLength[8];      // of those normals, weighed by intensity
    float spreadCosine[8];             // of the cone's half angle
    float planarIntensity[8];          // of planar lights along their normals; negative: a single light with two sides
    float omnidirectionalIntensity[8]; // mean intensity of the lights that emit in all directions
    uint child[8];
};

// One child of a LightNode.
struct LightCluster {
    vec3 center;
    float radius;
    vec3 axis;
    float meanResultantLength;
    float spreadCosine;
    float planarIntensity;
    float omnidirectionalIntensity;
    uint child;
};

struct ClusterWeights {
    float weight[kLightNodeChildren];
};

// ---- the scene as a whole ------------------------------------------------------------------------------------------

const uint kSkyBlack = 0u;
const uint kSkyConstant = 1u; // skyTop
const uint kSkyGradient = 2u; // mix(skyBottom, skyTop, 0.5 (unit direction.y + 1))
const uint kSkyImage = 3u;    // latitude-longitude image, skyTop is a factor

// The sphere of glass that paths aim at, see AimedScattering.h.
struct AimedSphere {
    vec3 center;
    float radius;
    vec3 axis;   // unit, from the centre away from the lights
    float gain;  // irradiance that it brings over the square of radius over distance; 0: there is no such sphere
    float limit; // cosine of how far from the axis it brings any
};

struct SceneGlobals {
    vec3 origin; // authored camera position, subtracted from every coordinate; solid textures add it back
    uint skyKind;
    vec3 skyTop;
    vec3 skyBottom;
    vec2 skyTurn;     // cosine and sine of the angle by which a sky image is turned about +y
    uint skyImage;    // into images
    uint skyLight;    // into lights, kNone unless the sky is sampled
    uint lightCount;  // lights proper
    uint targetCount; // importance targets, stored behind the lights
    uint mediumCount;
    uint instanceCount;
    float sceneRadius;         // half the diagonal of the bounds
    float maxCasterIrradiance; // greatest irradiance of one of specularCasters by the lights that are connected to
    AimedSphere aimed;
};

struct Camera {
    vec3 origin;
    vec3 corner; // from origin to the image's upper left corner on the plane of focus
    vec3 across; // upper left to upper right corner
    vec3 down;   // upper left to lower left corner
    vec3 lensU;  // half axes of the lens disk; zero for a pinhole
    vec3 lensV;
};

// Estimators, as named in the interface.
const uint kSampleBsdf = 0u;
const uint kSampleMixture = 1u;
const uint kSampleMis = 2u; // and above: next-event estimation weighed against scattering, by the power heuristic
const uint kSampleMisBalance = 3u; // by the balance heuristic

const uint kSelectUniform = 0u;
const uint kSelectPower = 1u;
const uint kSelectContribution = 2u;

const uint kShapeAuto = 0u;
const uint kShapeSolidAngle = 1u;
const uint kShapeProjected = 2u;
const uint kShapeArea = 3u;

const uint kSamplerIndependent = 0u;
const uint kSamplerStratified = 1u;
const uint kSamplerSobol = 2u;
const uint kSamplerSobolBlue = 3u; // one sequence for all pixels, near ones next to each other

// How many pixels a group has, whose samples of one number share: as many across and down.
const uint kReuseSide = 2u;
const uint kReuseGroup = kReuseSide * kReuseSide;

struct RenderParams {
    uint width; // pixels
    uint height;
    uint maxDepth; // path vertices after the camera
    uint seed;
    uint lightSampling;
    uint lightSelection;
    uint sphereLight;
    uint quadLight;
    uint triangleLight;
    uint samplerKind;
    uint strataX; // stratified: cells per round, strataX * strataY >= samples per pixel; kSamplerSobolBlue: binary
                  // logarithm of the samples of a pixel that are next to each other in the sequence
    uint strataY;
    uint connectedSpheres; // of specularCasters: lights are connected to through them; 0: none
    uint russianRoulette;  // a path of throughput T goes on with probability russianRoulette * T; 0: there is none
    uint edgeRays;         // of each sample in a pixel that the edge of a light crosses, see EdgeRays.h; 0: none
    uint methods;          // Features::methods in use: kernels may know more than a render asks for
};

// ---- rays ----------------------------------------------------------------------------------------------------------

struct Ray {
    vec3 origin;
    vec3 direction; // unit in world space
    float time;     // [0,1)
};

// The nearest intersection, as the engine's traversal reports it.
struct Hit {
    float t;        // ray parameter; negative: nothing was hit
    uint kind;      // kSphere, kQuad, kTriangle, kRound
    uint primitive; // index into spheres, quads, triangles or rounds of the whole scene
    uint instance;  // kNone: the world's own geometry
    float u;        // quad: along edgeU; triangle: weight of vertex 1
    float v;        // quad: along edgeV; triangle: weight of vertex 2
};

RT_SHARED_END

#endif
