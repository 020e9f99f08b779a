#include "Common/Scene/Pbrt/PbrtMaterials.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "Common/Core/Printable.h"
#include "Common/Scene/Json/JsonNode.h"
#include "Common/Scene/Pbrt/PbrtColor.h"
#include "Common/Scene/Pbrt/PbrtValues.h"

namespace rt::scene {

namespace {

constexpr const char* kMaterials =
    "diffuse, coateddiffuse, conductor, coatedconductor, dielectric, thindielectric, diffusetransmission, subsurface, "
    "hair, measured, mix, interface";
constexpr int kMaxMixDepth = 16;

MaterialDesc principledMaterial() {
    MaterialDesc material;
    material.kind = MaterialKind::Principled;
    material.principled.roughness.factor = 0;
    return material;
}

// Whether the material is no more than a lambertian can be, so that what needs more makes it principled.
MaterialDesc asPrincipled(MaterialDesc material) {
    if (material.kind == MaterialKind::Principled) return material;
    const bool isGlass = material.kind == MaterialKind::Dielectric;
    const double ior = isGlass ? material.parameters[0].value_or(1.5) : 1.5;
    material.kind = MaterialKind::Principled;
    material.parameters = {};
    material.principled.ior = std::clamp(ior, 1.0, kLargestIor);
    material.principled.transmission.factor = isGlass ? 1 : 0;
    material.principled.specular.factor = isGlass ? 1 : 0;
    material.principled.roughness.factor = isGlass ? 0 : 1;
    return material;
}

} // namespace

int PbrtMaterials::add(const std::string& kind, PbrtParameters parameters) {
    auto entry = std::make_unique<Entry>();
    entry->kind = kind;
    entry->parameters = std::move(parameters);
    entries_.push_back(std::move(entry));
    return static_cast<int>(entries_.size()) - 1;
}

void PbrtMaterials::addNamed(const std::string& name, PbrtParameters parameters) {
    std::string kind = parameters.string("type", "");
    if (kind.empty()) parameters.fail("\"string type\" is missing");
    const int material = named(name, parameters.place);
    Entry& entry = *entries_[static_cast<std::size_t>(material)];
    if (entry.isMade) parameters.fail("is in use already");
    entry.kind = std::move(kind);
    entry.parameters = std::move(parameters);
}

int PbrtMaterials::named(const std::string& name, const PbrtPlace& place) {
    const auto [found, isNew] = named_.try_emplace(name, -1);
    if (!isNew) return found->second;
    PbrtParameters none;
    none.what = "NamedMaterial \"" + printable(name, 100) + '"';
    none.place = place;
    found->second = add("", std::move(none)); // until it is defined
    entries_.back()->name = name;
    return found->second;
}

PbrtMaterials::Entry& PbrtMaterials::made(int material) {
    Entry& entry = *entries_[static_cast<std::size_t>(material)];
    if (!entry.isMade) make(entry, 0);
    return entry;
}

bool PbrtMaterials::isInterface(int material) {
    return made(material).isInterface;
}

bool PbrtMaterials::needsTangents(int material) {
    return !made(material).material.principled.normalTexture.empty();
}

std::string PbrtMaterials::use(int material, const PbrtSurface& surface) {
    Entry& entry = made(material);
    for (const auto& [known, key] : entry.uses)
        if (known == surface) return key;
    MaterialDesc desc = entry.material;
    if (surface.opacity != NumberOrTexture()) {
        desc = asPrincipled(std::move(desc));
        desc.principled.opacity = surface.opacity;
    }
    desc.emission = surface.emission;
    desc.emissionTexture = surface.emissionTexture;
    if (surface.emission != glm::dvec3(0)) desc.sides = surface.sides;
    std::string key = names_.unique(entry.name, "material", scene_.materials.size());
    scene_.materials[key] = std::move(desc);
    entry.uses.emplace_back(surface, key);
    return key;
}

// ---- kinds ---------------------------------------------------------------------------------------------------------

void PbrtMaterials::make(Entry& entry, int depth) {
    const PbrtParameters& parameters = entry.parameters;
    const std::string& kind = entry.kind;
    entry.isMade = true;
    parameters.find("type");
    if (kind == "mix") return mix(entry, depth);
    if (kind == "interface" || kind == "none" || (kind.empty() && entry.name.empty()))
        entry.isInterface = true;
    else if (kind.empty())
        parameters.fail("is not defined by any MakeNamedMaterial");
    else if (kind == "diffuse")
        entry.material = diffuse(parameters, 0.5);
    else if (kind == "coateddiffuse")
        entry.material = coatedDiffuse(parameters);
    else if (kind == "conductor")
        entry.material = conductor(parameters, "");
    else if (kind == "coatedconductor")
        entry.material = coatedConductor(parameters);
    else if (kind == "dielectric" || kind == "thindielectric")
        entry.material = dielectric(parameters, kind == "thindielectric");
    else
        entry.material = standIn(kind, parameters);
    addNormals(parameters, entry.material);
    notices_.addUnused(parameters);
}

MaterialDesc PbrtMaterials::diffuse(const PbrtParameters& parameters, double usual) {
    MaterialDesc material;
    const PbrtTexture reflectance = textures_.value(parameters, "reflectance", PbrtUse::Reflectance, glm::dvec3(usual));
    material.albedo = textures_.color(reflectance, parameters.place);
    return material;
}

double PbrtMaterials::indexOf(const PbrtParameters& parameters, const std::string& name, double usual) {
    const PbrtParameter* found = parameters.find(name);
    if (!found) return usual;
    const double index = pbrtIndex(*found, files_);
    if (!(index >= 1 / kLargest && index <= kLargest)) found->fail("must be from 1e-9 to 1e9");
    return index;
}

// The width of GGX's distribution is the square root of what pbrt calls roughness where that is remapped, else the
// roughness itself; ours is the square of the roughness. What differs between u and v counts by its mean.
double PbrtMaterials::roughness(const PbrtParameters& parameters, const std::string& prefix) {
    constexpr double kTextured = 0.25;
    const double both = textures_.plainNumber(parameters, prefix + "roughness", 0, kTextured);
    const double u = textures_.plainNumber(parameters, prefix + "uroughness", both, kTextured);
    const double v = textures_.plainNumber(parameters, prefix + "vroughness", both, kTextured);
    if (u != v) notices_.add(parameters.what + ": roughness is the mean of that in u and v", parameters.place);
    const double mean = std::clamp(0.5 * (u + v), 0.0, 1.0);
    return std::sqrt(parameters.boolean("remaproughness", true) ? std::sqrt(mean) : mean);
}

MaterialDesc PbrtMaterials::coatedDiffuse(const PbrtParameters& parameters) {
    MaterialDesc material = principledMaterial();
    material.albedo = diffuse(parameters, 0.5).albedo;
    material.principled.roughness.factor = roughness(parameters, "");
    material.principled.ior = std::clamp(indexOf(parameters, "eta", 1.5), 1.0, kLargestIor);
    for (const char* ofTheCoat : {"thickness", "maxdepth", "nsamples"}) parameters.find(ofTheCoat);
    if (parameters.has("albedo") || parameters.has("g"))
        notices_.add(parameters.what + ": what scatters within the coat is left out", parameters.place);
    return material;
}

glm::dvec3 PbrtMaterials::metalColor(const PbrtParameters& parameters, const std::string& prefix) {
    const PbrtParameter* eta = parameters.find(prefix + "eta");
    const PbrtParameter* k = parameters.find(prefix + "k");
    const auto isSpectrum = [](const PbrtParameter* parameter) {
        return !parameter || parameter->type == PbrtType::Spectrum;
    };
    if (!isSpectrum(eta) || !isSpectrum(k)) {
        constexpr double kMiddles[] = {611, 549, 465}; // nm, of the primaries of Rec. 709
        glm::dvec3 color;
        for (int c = 0; c < 3; ++c) {
            const auto channel = [&](const PbrtParameter* parameter, const char* usual) {
                if (!parameter) return pbrtMetal(usual)->at(kMiddles[c]);
                if (parameter->type == PbrtType::Spectrum) return pbrtSpectrum(*parameter, files_).at(kMiddles[c]);
                if (parameter->type != PbrtType::Rgb || parameter->numbers.size() != 3)
                    return pbrtIndex(*parameter, files_);
                return pbrtFinite(*parameter, parameter->numbers[static_cast<std::size_t>(c)]);
            };
            color[c] = reflectanceOfMetal(channel(eta, "metal-Cu-eta"), channel(k, "metal-Cu-k"));
        }
        return glm::clamp(color, 0.0, 1.0);
    }
    const PbrtSpectrum n = eta ? pbrtSpectrum(*eta, files_) : *pbrtMetal("metal-Cu-eta");
    const PbrtSpectrum absorption = k ? pbrtSpectrum(*k, files_) : *pbrtMetal("metal-Cu-k");
    PbrtSpectrum reflectance;
    for (int nm = 360; nm <= 830; nm += 5)
        reflectance.samples.emplace_back(nm, reflectanceOfMetal(n.at(nm), absorption.at(nm)));
    return pbrtReflectanceOf(reflectance);
}

MaterialDesc PbrtMaterials::conductor(const PbrtParameters& parameters, const std::string& prefix) {
    MaterialDesc material = principledMaterial();
    material.principled.metallic.factor = 1;
    if (parameters.has("reflectance"))
        material.albedo = diffuse(parameters, 1).albedo;
    else
        material.albedo = metalColor(parameters, prefix);
    material.principled.roughness.factor = roughness(parameters, prefix);
    return material;
}

MaterialDesc PbrtMaterials::coatedConductor(const PbrtParameters& parameters) {
    MaterialDesc material = conductor(parameters, "conductor.");
    material.principled.clearcoat.factor = 1;
    material.principled.clearcoatRoughness.factor = roughness(parameters, "interface.");
    constexpr double kIndexOfCoats = 1.5;
    if (indexOf(parameters, "interface.eta", kIndexOfCoats) != kIndexOfCoats)
        notices_.add(parameters.what + ": the coat's index of refraction is 1.5", parameters.place);
    for (const char* ofTheCoat : {"thickness", "maxdepth", "nsamples"}) parameters.find(ofTheCoat);
    if (parameters.has("albedo") || parameters.has("g"))
        notices_.add(parameters.what + ": what scatters within the coat is left out", parameters.place);
    return material;
}

// A sheet reflects on both sides, again and again: 2 R / (1 + R) of the light instead of R, which the surface of an
// index has that reflects as much.
MaterialDesc PbrtMaterials::dielectric(const PbrtParameters& parameters, bool isThin) {
    const double ior = indexOf(parameters, "eta", 1.5);
    const double width = isThin ? 0 : roughness(parameters, "");
    if (!isThin && (width == 0 || ior < 1)) {
        MaterialDesc glass;
        glass.kind = MaterialKind::Dielectric;
        glass.parameters[0] = ior;
        if (width > 0) notices_.add(parameters.what + ": an index below 1 is smooth", parameters.place);
        return glass;
    }
    MaterialDesc material = principledMaterial();
    material.principled.transmission.factor = 1;
    material.principled.roughness.factor = width;
    material.principled.ior = std::clamp(ior, 1.0, kLargestIor);
    if (!isThin) return material;
    material.principled.isThin = true;
    const double once = reflectanceOfMetal(ior, 0), amplitude = std::sqrt(2 * once / (1 + once));
    material.principled.ior = std::clamp((1 + amplitude) / (1 - amplitude), 1.0, kLargestIor);
    return material;
}

MaterialDesc PbrtMaterials::standIn(const std::string& kind, const PbrtParameters& parameters) {
    const bool isKnown = kind == "diffusetransmission" || kind == "subsurface" || kind == "hair" || kind == "measured";
    if (!isKnown) parameters.fail("the material is unknown; known are " + std::string(kMaterials));
    notices_.add("materials of the type \"" + kind + "\" are diffuse" +
                     (kind == "diffusetransmission" ? ": what they transmit is left out" : ""),
                 parameters.place);
    MaterialDesc material = diffuse(parameters, kind == "diffusetransmission" ? 0.25 : 0.5);
    for (const PbrtParameter& parameter : parameters.list) parameter.isUsed = true;
    return material;
}

void PbrtMaterials::mix(Entry& entry, int depth) {
    const PbrtParameters& parameters = entry.parameters;
    const PbrtParameter* names = parameters.find("materials", PbrtType::Text);
    if (!names || names->texts.size() != 2) parameters.fail("\"string materials\" must be two names");
    if (depth == kMaxMixDepth) parameters.fail("materials are mixed of each other too deep, or of themselves");
    const double amount = textures_.plainNumber(parameters, "amount", 0.5, 0.5);
    if (amount > 0 && amount < 1)
        notices_.add("of mixed materials the one of the larger amount stands for both", parameters.place);
    Entry& chosen = *entries_[static_cast<std::size_t>(named(names->texts[amount < 0.5 ? 0 : 1], parameters.place))];
    if (!chosen.isMade || chosen.kind == "mix") make(chosen, depth + 1);
    entry.material = chosen.material;
    entry.isInterface = chosen.isInterface;
    notices_.addUnused(parameters);
}

void PbrtMaterials::addNormals(const PbrtParameters& parameters, MaterialDesc& material) {
    if (parameters.has("displacement"))
        notices_.add("bumps by \"displacement\" are left out of materials", parameters.place);
    const std::string file = parameters.string("normalmap", "");
    if (file.empty()) return;
    material = asPrincipled(std::move(material));
    material.principled.normalTexture = textures_.image(file, ColorSpace::Linear, parameters.find("normalmap")->place);
}

} // namespace rt::scene
