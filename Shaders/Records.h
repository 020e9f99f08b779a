// What the engine hands to its shaders, valid as C++20 and as GLSL like Common/Shared: addresses of arrays, the records
// of the uniform buffer and of a launch, and how the samples of a launch are divided into blocks.
#ifndef RT_SHADERS_RECORDS_H
#define RT_SHADERS_RECORDS_H
#include "Common/Shared/Base/Elementary.h"
#include "Common/Shared/Base/PathTypes.h"
#include "Common/Shared/Base/SceneArrays.h"
#include "Common/Shared/Base/Types.h"
#include "Common/Shared/Shape/TreeRecords.h"

// A read-only array of `Type` on the device; in C++ its address.
#ifdef __cplusplus
#define RT_ARRAY(Name, Type) using Name = std::uint64_t;
#define RT_VECTOR_ARRAY(Name, Type) using Name = std::uint64_t;
#define RT_MUTABLE_ARRAY(Name, Type) using Name = std::uint64_t;
#else
#define RT_ARRAY(Name, Type)                                                            \
    layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Name { \
        Type at[];                                                                      \
    };
// Of records made of vectors of four, each of which is one load.
#define RT_VECTOR_ARRAY(Name, Type)                                                      \
    layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Name { \
        Type at[];                                                                       \
    };
#define RT_MUTABLE_ARRAY(Name, Type)                                           \
    layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Name { \
        Type at[];                                                             \
    };
#endif

RT_SHARED_BEGIN

// ---- scene ---------------------------------------------------------------------------------------------------------

#define RT_DECLARE(Type, name, load, title) RT_ARRAY(name##Array, Type)
RT_SCENE_ARRAYS(RT_DECLARE, RT_DECLARE)
#undef RT_DECLARE

// Addresses of the compiled scene's arrays; 0 where the scene has none.
struct SceneArrays {
#define RT_MEMBER(Type, name, load, title) name##Array name;
    RT_SCENE_ARRAYS(RT_MEMBER, RT_MEMBER)
#undef RT_MEMBER
};

RT_ARRAY(WordArray, uint)
RT_VECTOR_ARRAY(TreeNodeArray, TreeNode)
RT_VECTOR_ARRAY(WideTreeNodeArray, WideTreeNode)
RT_VECTOR_ARRAY(TreeQuadArray, TreeQuad)
RT_VECTOR_ARRAY(TreeTriangleArray, TreeTriangle)
RT_VECTOR_ARRAY(TreeRoundArray, TreeRound)
RT_VECTOR_ARRAY(FourArray, vec4)

// The tree of the compute engine, see Common/Shared/TreeRecords.h; zero without one.
struct TreeArrays {
    TreeNodeArray nodes; // or
    WideTreeNodeArray wideNodes;
    FourArray spheres;       // center, radius
    FourArray sphereMotions; // of each of them, if the features have motion
    WordArray sphereIndices; // of each of them in the scene
    TreeQuadArray quads;
    TreeTriangleArray triangles;
    TreeRoundArray rounds;
    WordArray instanceRoots; // of each instance
    uint root;
    uint unused; // C++ ends records of addresses at a multiple of 8 bytes, scalar layout does not
};

// The uniform buffer.
struct RenderConstants {
    SceneArrays arrays;
    TreeArrays tree;
    WordArray edges;     // of lights, a bit a pixel, where params.edgeRays > 0: what all pixels read stays in caches
    WordArray edgeParts; // of these pixels, as scene::LightEdges::parts
    SceneGlobals globals;
    RenderParams params;
    Camera camera;
    LightBound lightBounds[kContributionLights]; // of a table that is weighed light by light
};

// ---- film ----------------------------------------------------------------------------------------------------------
// Slots follow each other as in image::Film: tiles of 8x8 pixels, the replicates of each tile side by side.
// A value of a pixel stands at slot * kTilePixels + (row * 8 + column) in its array, slots counted from the film's
// first.

const uint kTile = 8u;
const uint kTilePixels = 64u;
const uint kBlock = 16u; // samples of a pixel that are summed in floats, in order

// An unevaluated sum of two floats, high + low, |low| <= half an ulp of high: 48 bits. The sum of both is always exact
// in a double, so that a film that went through the host goes on bit for bit.
struct FilmSum {
    vec3 high;
    vec3 low;
};

RT_MUTABLE_ARRAY(FilmSumArray, FilmSum)
RT_MUTABLE_ARRAY(MutableVectorArray, vec3)
RT_MUTABLE_ARRAY(MutableWordArray, uint)

// A path under way at the end of a launch, with which the next one goes on.
struct UnfinishedPath {
    uint number; // of its sample, whose key, index and base are those of the Sampler
    uint key;
    uint index;
    uint base;
    uvec2 pixel;
    uint edgeRays; // of the sample, see PathLoop.glsl
    uint goesOn;   // 1: it has a next vertex; 0: only shadow rays are to be traced
    PathState path;
    DirectLight direct;
    SpecularConnection connection; // read with kMethodConnections
};

// Counters of a launch. Invocations are spread over kCounterLines lines, which the host adds up.
const uint kCounterWork = 0u;      // of line 0: samples handed out
const uint kCounterScattered = 1u; // rays
const uint kCounterShadow = 2u;
const uint kCounterNonfinite = 3u; // samples that were dropped
const uint kCounterFinished = 4u;  // samples
const uint kCounterLeft = 5u;      // of line 0: paths left to the next launch
const uint kCounterReuse = 6u;     // rays, of the launch before
const uint kCounterEdgeRays = 7u;
const uint kCounterCutOff = 8u; // throughput that max depth cut off, in parts of kCutOffUnit
const uint kCounters = 16u;
const float kCutOffUnit = 0.00390625f; // 2^-8: the sums of any launch fit
const uint kCounterLines = 64u;
// Of line 1: samples that have been listed, see SampleList.comp.
const uint kListed = kCounters + kCounterWork;
// 1 when no sample is left; away from what is written often.
const uint kSpent = (kCounterLines - 1u) * kCounters + kCounterLeft;

// Where an invocation counts: neighbours, whose sums are one access, in one place.
RT_FN uint counterLine(uint invocation) {
    return invocation / 32u % kCounterLines * kCounters;
}

// What the invocations of a launch tell each other, the next launch and the host.
const uint kSharedPathBytes = 64u; // of each sample that shares its path
#ifdef __cplusplus
using LaunchProgress = std::uint64_t;
using SharedPathArray = std::uint64_t;
#else
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer SharedPathArray {
    uvec4 at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LaunchProgress {
    uint counters[kCounters * kCounterLines];
    UnfinishedPath left[]; // as many as the counters say
};
#endif

// What a film keeps besides sums, and how the samples of a launch are numbered.
const uint kKeepsBlockSquares = 1u;  // of (block sum)^2 / kBlock
const uint kKeepsSampleSquares = 2u; // of the samples of a pilot
const uint kIsPlanned = 4u;          // each pixel has an end of its own
const uint kSharesPaths = 8u;        // groups of pixels share

// A sample that a plan gives a launch.
struct PlannedSample {
    uint place; // sampleAt()
    uint number;
};
RT_MUTABLE_ARRAY(PlannedSampleArray, PlannedSample)

// The samples of a launch: of some slots of each of the bands that the film's slots are cut into, so that each launch
// has its share of what takes long in the image.
struct FilmLaunch {
    MutableWordArray samples;    // per slot: samples of its pixels; from filmSlots on: its tiles (packTile)
    MutableWordArray plan;       // most samples of each pixel, if kIsPlanned
    MutableWordArray starts;     // likewise: see plannedAt()
    MutableVectorArray radiance; // of each sample, by its number
    uint replicates;
    uint filmSlots;
    uint bandSlots;   // the last band may lack some
    uint firstSlot;   // of each band
    uint bandWidth;   // from firstSlot on
    uint slotCount;   // bandWidth times the bands
    uint steps;       // samples that the launch may take each slot further
    uint spp;         // per pixel, all replicates, at which the launch stops
    uint sampleCount; // how many have a number, those that do not exist at the borders of the image included
    uint flags;       // kKeepsBlockSquares and so on
};

// Push constants of its paths, and of what they share. Its last paths are left to the launch that follows it; one
// without slots takes no samples and leaves no paths.
struct PathLaunch {
    FilmLaunch film;
    PlannedSampleArray planned;  // in the order in which they are traced, if kIsPlanned
    SharedPathArray sharedPaths; // of each sample, where params.methods says so; see SharedPaths.glsl
    LaunchProgress progress;
    MutableVectorArray radianceBefore; // these three: of the launch before
    SharedPathArray sharedPathsBefore;
    LaunchProgress progressBefore;
};

// Push constants of SampleList.comp.
struct ListLaunch {
    FilmLaunch film;
    PlannedSampleArray planned;
    LaunchProgress progress;
};

// Push constants of FilmReduce.comp.
struct ReduceLaunch {
    FilmLaunch film;
    FilmSumArray sums;       // of closed blocks
    FilmSumArray squares;    // if a flag says of what
    MutableVectorArray open; // sums of open blocks; needed only where a block is or stays open
};

// Push constants of FilmResolve.comp, for a film that is whole.
struct ResolveLaunch {
    MutableWordArray samples; // as FilmLaunch's and ReduceLaunch's, and so are the next three
    FilmSumArray sums;
    MutableVectorArray open;
    MutableWordArray plan;
    MutableVectorArray pixels; // the means, row by row; 0 where there are no samples
    uint width;
    uint height;
    uint replicates;
    uint halves; // whose means make the picture: 2 where there is a plan, else 1
    uint filmSlots;
    uint isPlanned;
    uint apart; // 1: both halves make a picture each, one after the other
};

// Samples of replicate r among the first `spp` of a pixel: sample s belongs to replicate s mod R.
RT_FN uint replicateSamples(uint spp, uint replicate, uint replicates) {
    if (replicates == 1u) return spp;
    return replicate < spp ? (spp - 1u - replicate) / replicates + 1u : 0u;
}

// How many samples the pixels of a slot of this replicate have after a launch, before which they have `done`.
RT_FN uint samplesAfter(RT_IN(FilmLaunch) launch, uint replicate, uint done) {
    uint end = replicateSamples(launch.spp, replicate, launch.replicates);
    return max(done, min(done + launch.steps, end));
}

// Slot i of a launch, i < slotCount. There is none from filmSlots on, where the last band ends early.
RT_FN uint launchSlot(RT_IN(FilmLaunch) launch, uint i) {
    uint inBand;
    uint band = quotient(i, launch.bandWidth, inBand);
    return band * launch.bandSlots + launch.firstSlot + inBand;
}

// The samples of a launch follow each other slot by slot, in each step by step, a step being one sample of each pixel:
// rays of neighbours, which are alike, are then traced at a time. This is the place of one of slot i of the launch, and
// without a plan its number.
RT_FN uint sampleAt(RT_IN(FilmLaunch) launch, uint i, uint step, uint tilePixel) {
    return (i * launch.steps + step) * kTilePixels + tilePixel;
}

// Pixel i of a tile where those of a group that shares follow each other, row by row, i < kTilePixels.
RT_FN uint groupedPixel(uint i) {
    const uint kColumns = kTile / kReuseSide;
    uint group = i / kReuseGroup;
    uint inGroup = i % kReuseGroup;
    uint row = group / kColumns * kReuseSide + inGroup / kReuseSide;
    return row * kTile + group % kColumns * kReuseSide + inGroup % kReuseSide;
}

// With a plan, which gives the pixels of a slot different numbers of samples, not every place has one. Those of a pixel
// are then numbered one after the other, where paths are shared alternating with those of its group, so that no number
// is without a sample and no memory without use. This is the number of the pixel's sample of this index; `start` is
// what FilmLaunch::starts has of it.
RT_FN uint plannedAt(RT_IN(FilmLaunch) launch, uint start, uint index) {
    return start + index * ((launch.flags & kSharesPaths) != 0u ? kReuseGroup : 1u);
}

// A tile of the image, as samples of a film have it: its column and its row.
RT_FN uint packTile(uint column, uint row) {
    return column | row << 16u;
}

RT_FN uvec2 pixelInTile(uint tile, uint tilePixel) {
    return uvec2((tile & 0xffffu) * kTile + tilePixel % kTile, (tile >> 16u) * kTile + tilePixel / kTile);
}

// ---- features of surfaces and costs ---------------------------------------------------------------------------------

RT_MUTABLE_ARRAY(MutableFloatArray, float)

// Push constants of PixelPass.glsl: of an image's runs, which are so many pixels of a row as an invocation does, or what
// is left of the row, firstRun and following.
struct PixelLaunch {
    MutableFloatArray values; // of the first of these pixels, then of the others; features: aovValues() each
    uint firstRun;
    uint runs;
    uint samples;
    uint looksThrough; // features: 0: nothing but kFirstValues is wanted
    uint isAdaptive;   // features: 1: fewer samples where these agree (SeenSurfaces.h)
};
RT_FN uint runsOfRow(uint width, uint pixelsOfRun) {
    return (width + pixelsOfRun - 1u) / pixelsOfRun;
}
RT_FN uvec2 firstPixelOfRun(uint run, uint width, uint pixelsOfRun) {
    uint runs = runsOfRow(width, pixelsOfRun);
    return uvec2(run % runs * pixelsOfRun, run / runs);
}
const uint kSurfaceValues = 7u;          // albedo, normal and depth
const uint kFirstValues = 0u;            // where those of the first surface begin
const uint kWideValues = kSurfaceValues; // of the first that scatters widely
const uint kEmissionValues = 14u;
const uint kAovValues = 17u;
RT_FN uint aovValues(bool looksThrough) {
    return looksThrough ? kAovValues : kSurfaceValues;
}

// ---- preview by rasterisation --------------------------------------------------------------------------------------

RT_MUTABLE_ARRAY(MutableFourArray, vec4)

const int kPreviewSamples = 4;        // of each pixel: what every device has
const uint kPreviewDrawnBinding = 2u; // what was drawn, for Preview.comp

// Push constants of Preview.vert, .frag and .comp. A point p is drawn at (clipX, clipY, near, clipW), each row times
// (p, 1).
struct PreviewLaunch {
    WordArray indices;       // lightCount lights, then what a draw's instances are: kNone is the world itself
    MutableFourArray pixels; // radiance, and the distance along the pixel's ray, 0 where nothing is drawn
    vec4 clipX;
    vec4 clipY;
    vec4 clipW;   // 1 in the plane of focus, 0 at the camera
    vec3 ambient; // radiance from all around
    float near;
    uint lightCount;
    uint firstRow; // of the image, in the band that is drawn
    uint rowCount; // of the band
};

// ---- shader binding table ------------------------------------------------------------------------------------------

// A hit group's record is the offset of the instance plus the index of the geometry in its structure, so that a
// structure may hold triangles and quads.
const uint kHitRecordTriangle = 0u;
const uint kHitRecordQuad = 1u;
const uint kHitRecordSphere = 2u;
const uint kHitRecordRound = 3u;
const uint kHitRecords = 4u;

// ---- rays ----------------------------------------------------------------------------------------------------------

// An intersection shader sees neither the payload nor any other word of the ray that is free, so time travels in tMin.
// That is sound: gl_RayTminEXT is the trace call's own operand in every stage of the ray (Vulkan specification,
// RayTminKHR; only RayTmaxKHR changes), the same in object and world space. A product with a power of two is exact, its
// range of 2^-84 to 2^-60 normal, and no hit lies that near.
const float kTimeToTMin = 8.67361738e-19f; // 2^-60
const float kTMinToTime = 1.15292150e18f;  // 2^60

RT_SHARED_END

#endif
