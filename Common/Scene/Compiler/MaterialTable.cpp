#include "Common/Scene/Compiler/MaterialTable.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "Common/Core/Error.h"
#include "Common/Scene/Compiler/DirectionalAlbedos.h"
#include "Common/Scene/MaterialTypes.h"

namespace rt::scene {

namespace {

constexpr double kMinAttenuation = 1e-6; // of attenuation colours: black would absorb infinitely much

// Of red, green and blue, in nm: Fraunhofer's lines C, d and F, by which the Abbe number says how far apart the
// outer two are. At d the index is the material's own.
constexpr std::array<double, 3> kChannelWavelengths = {656.3, 587.6, 486.1};

// Cauchy's equation for an index of refraction at 587.6 nm and 20 over an Abbe number, as in KHR_materials_dispersion.
double dispersedIor(double ior, double dispersion, double wavelength) {
    const auto squared = [](double x) { return 1 / (x * x); };
    const double part = (squared(wavelength) - squared(kChannelWavelengths[1])) /
                        (squared(kChannelWavelengths[2]) - squared(kChannelWavelengths[0]));
    return ior + (ior - 1) * dispersion / 20 * part;
}

// Share of the rays that meet a surface; of one whose opacity has a texture 1, which bounds it.
double constantOpacity(const shared::Principled& p) {
    if (p.opacity.texture != shared::kNone) return 1;
    if (p.alphaCutoff < 0) return p.opacity.factor;
    return p.opacity.factor < p.alphaCutoff ? 0 : 1;
}

} // namespace

MaterialTable::MaterialTable(const SceneDesc& desc, const CompileOptions& options, CompiledScene& out,
                             TextureTable& textures)
    : desc_(desc), options_(options), out_(out), textures_(textures) {
    for (const auto& [name, material] : desc.materials) names_[&material] = name;
}

const MaterialDesc& MaterialTable::find(const std::string& name) const {
    const auto found = desc_.materials.find(name);
    if (found == desc_.materials.end()) throw InputError(desc_.id + ": material \"" + name + "\" is not defined");
    return found->second;
}

std::uint32_t MaterialTable::index(const MaterialDesc& desc) {
    const auto [entry, isNew] = indices_.try_emplace(&desc, static_cast<std::uint32_t>(out_.materials.size()));
    if (!isNew) return entry->second;
    shared::Material material{};
    const MaterialType& type = materialType(desc.kind);
    material.kind = static_cast<std::uint32_t>(desc.kind);
    material.texture = shared::kNone;
    if (colorOf(type)) material.texture = textures_.resolve(desc.albedo, material.albedo);
    forEachNumber(type, [&](const MaterialParameter& parameter, std::size_t i) {
        material.parameter[i] = static_cast<float>(desc.parameters[i].value_or(parameter.usual));
    });
    material.emission = shared::vec3(desc.emission);
    material.emissionTexture = shared::kNone;
    const bool front = desc.sides ? *desc.sides == Sides::Front : options_.oneSidedLights;
    material.emissionSides = front ? shared::kSidesFront : shared::kSidesBoth;
    glm::dvec3 mean = desc.emission;
    if (emits(desc) && !desc.emissionTexture.empty()) {
        shared::vec3 factor;
        material.emissionTexture = textures_.resolve(desc.emissionTexture, factor);
        mean *=
            material.emissionTexture == shared::kNone ? glm::dvec3(factor) : textures_.mean(material.emissionTexture);
        material.emission *= factor;
    }
    if (desc.kind == MaterialKind::Principled) {
        addPrincipled(desc.principled);
        mean *= constantOpacity(out_.principled.back());
    }
    out_.materials.push_back(material);
    out_.materialNames.push_back(names_[&desc]);
    if (!out_.principled.empty()) out_.principled.resize(out_.materials.size());
    meanEmission_.push_back(mean);
    return entry->second;
}

std::uint32_t MaterialTable::normalMap(const std::string& name) {
    if (name.empty()) return shared::kNone;
    shared::vec3 ignored;
    const std::uint32_t texture = textures_.resolve(name, ignored);
    if (texture == shared::kNone || !textures_.isGreyImage(texture)) return texture;
    out_.notices.push_back("texture \"" + name + "\" is grey, a map of heights and not of normals: left out");
    return shared::kNone;
}

void MaterialTable::addPrincipled(const PrincipledDesc& desc) {
    if (out_.principled.empty()) out_.directionalAlbedos = directionalAlbedos();
    shared::Principled p{};
    const auto record = [&](const NumberOrTexture& source) {
        shared::ScaledChannel number{};
        number.factor = static_cast<float>(source.factor);
        number.texture = shared::kNone;
        number.channel = static_cast<std::uint32_t>(source.channel);
        if (source.texture.empty()) return number;
        shared::vec4 constant(1.0f);
        shared::vec3 color;
        number.texture = textures_.resolve(source.texture, color);
        if (number.texture == shared::kNone) {
            constant = shared::vec4(color, 1.0f);
            number.factor =
                (number.factor < 0 ? 1.0f : 0.0f) + number.factor * constant[static_cast<int>(source.channel)];
        }
        return number;
    };
#define RT_NUMBER(member, usual) p.member = record(desc.member);
#define RT_COLOR(member, usual) p.member.texture = textures_.resolve(desc.member, p.member.color);
    RT_PRINCIPLED_NUMBERS(RT_NUMBER)
    RT_PRINCIPLED_COLORS(RT_COLOR)
#undef RT_NUMBER
#undef RT_COLOR
    p.ior = static_cast<float>(desc.ior);
    p.thin = desc.isThin ? 1u : 0u;
    p.glass = shared::kNone;
    if (desc.transmission.factor != 0 && !desc.isThin) addGlass(desc, p);
    if (desc.attenuationDistance)
        for (int c = 0; c < 3; ++c)
            p.absorption[c] = static_cast<float>(-std::log(std::max(desc.attenuationColor[c], kMinAttenuation)) /
                                                 *desc.attenuationDistance);
    p.normalTexture = normalMap(desc.normalTexture);
    p.normalScale = static_cast<float>(desc.normalScale);
    p.coatTexture = normalMap(desc.clearcoatNormalTexture);
    p.coatScale = static_cast<float>(desc.clearcoatNormalScale);
    addAnisotropy(desc, p);
    p.filmThickness = shared::vec2(desc.iridescenceThicknessMinimum, desc.iridescenceThicknessMaximum);
    p.filmIor = static_cast<float>(desc.iridescenceIor);
    p.alphaCutoff = desc.alphaCutoff ? static_cast<float>(*desc.alphaCutoff) : -1.0f;
    p.emitsColors = desc.emitsColors ? 1u : 0u;
    out_.principled.resize(out_.materials.size());
    out_.principled.push_back(p);
}

std::uint32_t MaterialTable::glassTable(float ior) {
    const auto [entry, isNew] = glass_.try_emplace(ior, static_cast<std::uint32_t>(out_.glassAlbedos.size()));
    if (isNew) {
        const std::vector<float> albedos = glassAlbedos(ior);
        out_.glassAlbedos.insert(out_.glassAlbedos.end(), albedos.begin(), albedos.end());
    }
    return entry->second;
}

void MaterialTable::addGlass(const PrincipledDesc& desc, shared::Principled& p) {
    if (desc.dispersion == 0) {
        p.glass = glassTable(p.ior);
        return;
    }
    for (int c = 0; c < 3; ++c) {
        const double ior = dispersedIor(desc.ior, desc.dispersion, kChannelWavelengths[static_cast<std::size_t>(c)]);
        p.channelIor[c] = static_cast<float>(std::clamp(ior, 1.0, kLargestIor));
        p.channelGlass[c] = glassTable(p.channelIor[c]);
    }
    p.glass = p.channelGlass.y;
}

// A texture that is one colour everywhere becomes part of the rotation.
void MaterialTable::addAnisotropy(const PrincipledDesc& desc, shared::Principled& p) {
    p.stretch = shared::vec2(std::cos(desc.anisotropyRotation), std::sin(desc.anisotropyRotation));
    p.stretchTexture = shared::kNone;
    if (desc.anisotropy.factor == 0) return;
    if (out_.stretchedAlbedos.empty()) out_.stretchedAlbedos = stretchedAlbedos();
    if (desc.anisotropyTexture.empty()) return;
    shared::vec3 color;
    p.stretchTexture = textures_.resolve(desc.anisotropyTexture, color);
    if (p.stretchTexture != shared::kNone) return;
    const shared::vec2 d(2 * color.x - 1, 2 * color.y - 1);
    p.stretch = shared::vec2(d.x * p.stretch.x - d.y * p.stretch.y, d.x * p.stretch.y + d.y * p.stretch.x);
}

bool MaterialTable::mayShowImage(const MaterialDesc& desc) const {
    bool shows = false;
    forEachTexture(desc, [&](const std::string& name) { shows = shows || textures_.mayShowImage(name); });
    return shows;
}

} // namespace rt::scene
