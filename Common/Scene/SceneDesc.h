// The authoring scene: what a person writes, in code or in a scene file. Names, files and nesting are still there;
// lengths are world units, angles degrees, colours linear RGB, everything but some meshes in double precision.
// compileScene() turns it into the compiled scene.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "Common/Scene/Boxed.h"
#include "Common/Scene/Moment.h"
#include "Common/Shared/Material/Materials.h"
#include "Common/Shared/Material/PrincipledParameters.h"

namespace rt::scene {

struct CameraDesc {
    glm::dvec3 lookFrom{0, 0, 0};
    glm::dvec3 lookAt{0, 0, -1};
    glm::dvec3 up{0, 1, 0};
    double verticalFov = 90;   // degrees, (0, 180)
    double defocusAngle = 0;   // degrees, full apex angle of the cone of the lens; 0: pinhole
    double focusDistance = 10; // world units, > 0
    bool operator==(const CameraDesc&) const = default;
};

// What a scene suggests; flags override it.
struct RenderDefaults {
    double aspect = 1.0; // width / height
    bool operator==(const RenderDefaults&) const = default;
};

// ---- background ----------------------------------------------------------------------------------------------------

struct ConstantBackground {
    glm::dvec3 color{0, 0, 0};
    bool operator==(const ConstantBackground&) const = default;
};
// Between bottom and top by the height of the ray's direction.
struct GradientBackground {
    glm::dvec3 bottom{1, 1, 1};
    glm::dvec3 top{0.5, 0.7, 1.0};
    bool operator==(const GradientBackground&) const = default;
};
// How an image covers the sphere. Pbrt: a square one in equal areas, on an octahedron whose middle is +Z (P. Clarberg,
// Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD, 2008); another one by latitude and longitude, its upper row
// at +Z, from +X by way of +Y.
enum class SkyProjection { LatitudeLongitude, Pbrt };
// A latitude-longitude image, its upper row at +Y, unless `projection` says otherwise.
struct ImageBackground {
    std::string file;
    glm::dvec3 factor{1, 1, 1};
    double rotation = 0; // degrees, right-handed about +Y
    SkyProjection projection = SkyProjection::LatitudeLongitude;
    // Rows of the map from directions of the world, turned back by `rotation`, to those of the image.
    std::array<double, 9> orientation{1, 0, 0, 0, 1, 0, 0, 0, 1};
    bool operator==(const ImageBackground&) const = default;
};
// A clear sky with its sun above a ground that both shine on: Daylight.h.
struct SunSkyBackground {
    double sunElevation = 40;   // degrees above the horizon, [0, 90]
    double sunAzimuth = 135;    // degrees from -Z by way of +X, as on a compass whose north is -Z
    double turbidity = 3;       // how hazy the air is, [kLeastTurbidity, kMostTurbidity]
    glm::dvec3 ground{0.2};     // what it reflects
    glm::dvec3 factor{1, 1, 1}; // so many times as bright as 100 000 lx for an irradiance of pi
    bool operator==(const SunSkyBackground&) const = default;
};
inline constexpr double kLeastTurbidity = 2, kMostTurbidity = 10;
using Background = std::variant<ConstantBackground, GradientBackground, ImageBackground, SunSkyBackground>;

// ---- appearance ----------------------------------------------------------------------------------------------------

using ColorOrTexture = std::variant<glm::dvec3, std::string>; // a constant, or the name of a texture

struct SolidTexture {
    glm::dvec3 color{1, 1, 1};
    bool operator==(const SolidTexture&) const = default;
};
// Cubes of two textures alternating in world space.
struct CheckerTexture {
    double scale = 1; // edge of a cube
    ColorOrTexture even{glm::dvec3(1)};
    ColorOrTexture odd{glm::dvec3(0)};
    bool operator==(const CheckerTexture&) const = default;
};
enum class NoiseKind { Marble, Turbulence, Smooth };
// Perlin noise in world space; formulas stand beside the kinds in Shared/Types.h.
struct NoiseTexture {
    NoiseKind kind = NoiseKind::Marble;
    double scale = 1;     // multiplies the point
    double frequency = 1; // marble: of the stripes along z
    glm::dvec3 tint{1, 1, 1};
    std::uint32_t seed = 0; // textures of one seed share their tables
    bool operator==(const NoiseTexture&) const = default;
};
enum class Wrap { Clamp, Repeat, Mirror }; // what lies beyond the edges of an image
enum class ColorSpace { Srgb, Linear };    // how the numbers of an image with 8 or 16 bits are encoded
// Stands in for images of models that cannot be read: one texel, so that the factor beside the image counts alone.
inline constexpr const char* kWhiteStandIn = "white";
struct ImageTexture {
    std::string file;    // with an image number: a file of glTF that contains it
    std::string standIn; // name of what takes over where the file is missing; empty: that is an error
    glm::dvec3 tint{1, 1, 1};
    std::optional<std::uint32_t> image = std::nullopt; // its number among the images of a glTF file
    ColorSpace colorSpace = ColorSpace::Srgb;
    Wrap wrapU = Wrap::Clamp;
    Wrap wrapV = Wrap::Clamp;
    std::uint32_t uvSet = 0; // which texture coordinates of a mesh: MeshData::uvs or uvs2
    // Two rows of three: the place in the image is rows . (u, v, 1), before wrapping.
    std::array<double, 6> uvTransform{1, 0, 0, 0, 1, 0};
    bool operator==(const ImageTexture&) const = default;
};
using TextureDesc = std::variant<SolidTexture, CheckerTexture, NoiseTexture, ImageTexture>;

// Of the table Common/Shared/Material/Materials.h.
enum class MaterialKind : std::uint32_t {
#define RT_SURFACE(Name, kind, name, help, scatters, parameters) Name = kind,
#define RT_BLACK(Name, kind, name, help, parameters) Name = kind,
    RT_MATERIALS(RT_SURFACE, RT_BLACK)
#undef RT_SURFACE
#undef RT_BLACK
};
enum class Sides { Front, Both };

// A number, or a number times a channel of an image texture.
enum class Channel { Red, Green, Blue, Alpha };
struct NumberOrTexture {
    double factor = 1;   // negative, only with a texture: 1 + factor times channel
    std::string texture; // empty: none
    Channel channel = Channel::Red;
    bool operator==(const NumberOrTexture&) const = default;
};

// The largest index of refraction: facets of it reflect all but half a thousandth.
inline constexpr double kLargestIor = 1e4;
inline constexpr double kLargestFilmIor = 5; // of a thin film

// What a principled material has beyond MaterialDesc, whose albedo is its base colour: Principled.h explains.
struct PrincipledDesc {
#define RT_NUMBER(member, usual) NumberOrTexture member{usual, {}, Channel::Red};
#define RT_COLOR(member, usual) ColorOrTexture member{glm::dvec3(usual)};
    RT_PRINCIPLED_NUMBERS(RT_NUMBER)
    RT_PRINCIPLED_COLORS(RT_COLOR)
#undef RT_NUMBER
#undef RT_COLOR
    double ior = 1.5;                          // index of refraction inside over outside, >= 1
    bool isThin = false;                       // transmits without bending, as a sheet does
    glm::dvec3 attenuationColor{1, 1, 1};      // what is left of white after attenuationDistance inside
    std::optional<double> attenuationDistance; // unset: nothing is absorbed inside
    std::string normalTexture;                 // tangent-space normals, 2 rgb - 1; empty: none
    double normalScale = 1;                    // of their x and y
    std::string clearcoatNormalTexture;        // of the clear coat alone, which else is smooth
    double clearcoatNormalScale = 1;
    std::optional<double> alphaCutoff;        // opacity below it is 0, else 1; unset: opacity is a probability
    double dispersion = 0;                    // 20 over the Abbe number, 0: the index is that of all wavelengths
    double iridescenceIor = 1.3;              // of the thin film
    double iridescenceThicknessMinimum = 100; // in nm, where iridescenceThickness is 0
    double iridescenceThicknessMaximum = 400; // where it is 1
    double anisotropyRotation = 0;            // of the direction of rougher facets, from the tangent, in radians
    std::string anisotropyTexture;            // that direction, 2 rg - 1, before it is rotated; empty: the tangent
    bool emitsColors = false; // vertex colours multiply emission, too; light sampling leaves such surfaces out
    bool operator==(const PrincipledDesc&) const = default;
};

struct MaterialDesc {
    MaterialKind kind = MaterialKind::Lambertian;
    ColorOrTexture albedo{glm::dvec3(1)}; // the colour parameter of the kind, if it has one; components in [0,1]
    std::array<std::optional<double>, shared::kMaterialParameters> parameters; // its numbers; unset: the usual value
    glm::dvec3 emission{0, 0, 0};                                              // radiance; any kind may emit
    std::string emissionTexture;                                               // multiplies emission; empty: none
    std::optional<Sides> sides; // which emit; unset: as CompileOptions::oneSidedLights says
    PrincipledDesc principled;  // of MaterialKind::Principled
    bool operator==(const MaterialDesc&) const = default;
};

// ---- objects -------------------------------------------------------------------------------------------------------

struct Translate {
    glm::dvec3 offset{0, 0, 0};
    bool operator==(const Translate&) const = default;
};
// Right-handed about an axis through the origin, which need not be of unit length.
struct Rotate {
    glm::dvec3 axis{0, 1, 0};
    double degrees = 0;
    bool operator==(const Rotate&) const = default;
};
struct Scale {
    glm::dvec3 factors{1, 1, 1};
    bool operator==(const Scale&) const = default;
};
// Three rows of four: x' = rows . (x, 1).
struct Matrix {
    std::array<double, 12> rows{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    bool operator==(const Matrix&) const = default;
};
// The first step is applied to the object first.
using Transform = std::vector<std::variant<Translate, Rotate, Scale, Matrix>>;

struct SphereDesc {
    glm::dvec3 center{0, 0, 0};
    double radius = 1;
    std::optional<glm::dvec3> centerEnd; // a moving sphere is here at time 1
    std::string material;
    bool light = true; // false: an emitter that is not in the light table
    bool operator==(const SphereDesc&) const = default;
};
// Many spheres of one radius and material.
struct SphereSetDesc {
    std::vector<glm::dvec3> centers;
    double radius = 1;
    std::string material;
    bool light = true;
    bool operator==(const SphereSetDesc&) const = default;
};
// Parallelogram corner + a edgeU + b edgeV; front: the side edgeU x edgeV points to.
struct QuadDesc {
    glm::dvec3 corner{0, 0, 0};
    glm::dvec3 edgeU{1, 0, 0};
    glm::dvec3 edgeV{0, 1, 0};
    std::string material;
    bool light = true;
    bool operator==(const QuadDesc&) const = default;
};
// Six quads facing outwards.
struct BoxDesc {
    glm::dvec3 min{0, 0, 0};
    glm::dvec3 max{1, 1, 1};
    std::string material;
    bool light = true;
    bool operator==(const BoxDesc&) const = default;
};
// A circle, or a ring around its hole; front: the side that `normal`, of any length, points to.
struct DiskDesc {
    glm::dvec3 center{0, 0, 0};
    glm::dvec3 normal{0, 0, 1};
    double radius = 1;
    double innerRadius = 0; // of its hole
    std::string material;
    bool light = true;
    bool operator==(const DiskDesc&) const = default;
};
// Open at both ends; front: the outside.
struct CylinderDesc {
    glm::dvec3 base{0, 0, 0}; // centres of its ends
    glm::dvec3 top{0, 0, 1};
    double radius = 1;
    std::string material;
    bool light = true;
    bool operator==(const CylinderDesc&) const = default;
};
template <class Real>
struct MeshOf {
    using Vec2 = glm::vec<2, Real>;
    using Vec3 = glm::vec<3, Real>;
    using Vec4 = glm::vec<4, Real>;

    std::vector<Vec3> positions;
    std::vector<Vec3> normals;         // one per position, or none: flat
    std::vector<Vec2> uvs;             // one per position, or none
    std::vector<Vec2> uvs2;            // a second set, one per position, or none
    std::vector<Vec4> colors;          // one per position, or none: linear rgb, opacity; times a principled material's
    std::vector<Vec4> tangents;        // one per position, or none: direction of u, sign of the bitangent normal x u
    std::vector<glm::uvec3> triangles; // indices into positions, counter-clockwise seen from the front
    bool operator==(const MeshOf&) const = default;

    template <class Other>
    MeshOf<Other> as() const {
        const auto converted = []<int N>(const std::vector<glm::vec<N, Real>>& values) {
            return std::vector<glm::vec<N, Other>>(values.begin(), values.end());
        };
        return {converted(positions), converted(normals),  converted(uvs), converted(uvs2),
                converted(colors),    converted(tangents), triangles};
    }
};
using MeshData = MeshOf<double>;
using FloatMeshData = MeshOf<float>; // in half the memory: large meshes of files that tell no more
struct MeshFile {
    std::string file;    // OBJ
    std::string standIn; // name of a generated mesh that takes over where the file is missing; empty: that is an error
    bool operator==(const MeshFile&) const = default;
};
struct MeshDesc {
    std::variant<MeshFile, Boxed<MeshData>, Boxed<FloatMeshData>> source;
    std::string material; // empty: those of the file
    bool light = true;
    bool operator==(const MeshDesc&) const = default;
};
struct SphereBoundary {
    glm::dvec3 center{0, 0, 0};
    double radius = 1;
    bool operator==(const SphereBoundary&) const = default;
};
struct BoxBoundary {
    glm::dvec3 min{0, 0, 0};
    glm::dvec3 max{1, 1, 1};
    bool operator==(const BoxBoundary&) const = default;
};
// Homogeneous and isotropic; its boundary is no surface.
struct MediumDesc {
    std::variant<SphereBoundary, BoxBoundary> boundary;
    double density = 1; // extinction per unit of world length, whatever transforms stand above
    ColorOrTexture albedo{glm::dvec3(1)};
    bool operator==(const MediumDesc&) const = default;
};
// Lights without extent, as KHR_lights_punctual of glTF has them. Transforms move and turn them; what they emit stays
// the same under scales. No camera and no reflection shows them.
struct PointLightDesc {
    glm::dvec3 position{0, 0, 0};
    glm::dvec3 intensity{1, 1, 1}; // radiant intensity: irradiance at a distance of 1
    bool operator==(const PointLightDesc&) const = default;
};
struct SpotLightDesc {
    glm::dvec3 position{0, 0, 0};
    glm::dvec3 direction{0, -1, 0}; // in which it shines; of any length but 0
    glm::dvec3 intensity{1, 1, 1};  // within innerAngle of the direction
    double innerAngle = 0;          // degrees, [0, outerAngle)
    double outerAngle = 45;         // degrees, (0, 90]: dark from here on, and a smooth edge in between
    bool operator==(const SpotLightDesc&) const = default;
};
struct DirectionalLightDesc {
    glm::dvec3 direction{0, -1, 0}; // in which it shines; of any length but 0
    glm::dvec3 irradiance{1, 1, 1}; // of a surface across the direction
    bool operator==(const DirectionalLightDesc&) const = default;
};
struct ObjectDesc;
struct GroupDesc {
    Transform transform;
    std::vector<ObjectDesc> objects;
    bool operator==(const GroupDesc&) const; // of an incomplete type no comparison can be defaulted
};
struct InstanceDesc {
    std::string prototype;
    Transform transform;
    std::string material; // replaces that of every surface in the prototype; empty: keeps them
    bool operator==(const InstanceDesc&) const = default;
};
struct ObjectDesc {
    using Shape =
        std::variant<SphereDesc, SphereSetDesc, QuadDesc, BoxDesc, DiskDesc, CylinderDesc, MeshDesc, MediumDesc,
                     PointLightDesc, SpotLightDesc, DirectionalLightDesc, GroupDesc, InstanceDesc>;
    Shape shape;
    bool hidden = false; // it, and all that is in it, is as if it were not there
    bool operator==(const ObjectDesc&) const = default;
};
inline bool GroupDesc::operator==(const GroupDesc& other) const {
    return transform == other.transform && objects == other.objects;
}

// Where `mixture` also aims although nothing emits there. Materials are of no meaning.
struct TargetDesc {
    std::variant<SphereBoundary, QuadDesc> shape;
    bool operator==(const TargetDesc&) const = default;
};

// A file of glTF, OBJ or pbrt, or a scene file, that the scene has taken in: AddedModels.h.
struct ModelDesc {
    std::string file;
    std::string animation; // by name; empty: the first
    double time = 0;       // of it, in seconds
    bool operator==(const ModelDesc&) const = default;
};

struct SceneDesc {
    std::string id; // of a built-in scene, or the name of the file; not part of a scene file
    std::string title;
    CameraDesc camera;
    std::map<std::string, CameraDesc> cameras; // others that it can be seen with, by name
    Background background;
    std::map<std::string, TextureDesc> textures;
    std::map<std::string, MaterialDesc> materials;
    std::map<std::string, std::vector<ObjectDesc>> prototypes; // what instances refer to
    std::vector<ObjectDesc> objects;
    std::map<std::string, ModelDesc> models; // where a part of what has names comes from
    std::vector<TargetDesc> importanceTargets;
    RenderDefaults render;
    std::vector<std::string> notices; // of reading it, one line each; not part of a scene file
    Motion motion;                    // of the model that it is or begins with; likewise
    bool operator==(const SceneDesc&) const = default;
};

} // namespace rt::scene
