#include "Common/Scene/Compiler/MaterialTable.h"

#include "Common/Core/Error.h"
#include "Common/Scene/MaterialTypes.h"

namespace rt::scene {

MaterialTable::MaterialTable(const SceneDesc& desc, const CompileOptions& options, CompiledScene& out,
                             TextureTable& textures)
    : desc_(desc), options_(options), out_(out), textures_(textures) {}

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
    out_.materials.push_back(material);
    meanEmission_.push_back(mean);
    return entry->second;
}

bool MaterialTable::mayShowImage(const MaterialDesc& desc) const {
    const auto* albedo = std::get_if<std::string>(&desc.albedo);
    return (albedo && textures_.mayShowImage(*albedo)) || textures_.mayShowImage(desc.emissionTexture);
}

} // namespace rt::scene
