// Materials of the compiled scene, made when a primitive first refers to them: what nothing uses leaves no trace in the
// features.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "Common/Scene/Compiler/TextureTable.h"

namespace rt::scene {

inline bool emits(const MaterialDesc& material) {
    return material.emission.x > 0 || material.emission.y > 0 || material.emission.z > 0;
}

// Calls visit(name) for the textures of a material, in the order in which MaterialTable resolves them.
template <typename Visit>
void forEachTexture(const MaterialDesc& desc, const Visit& visit) {
    const auto color = [&](const ColorOrTexture& source) {
        if (const auto* name = std::get_if<std::string>(&source)) visit(*name);
    };
    const auto number = [&](const NumberOrTexture& source) {
        if (!source.texture.empty()) visit(source.texture);
    };
    const auto map = [&](const std::string& name) {
        if (!name.empty()) visit(name);
    };
    color(desc.albedo);
    if (emits(desc)) map(desc.emissionTexture);
    if (desc.kind != MaterialKind::Principled) return;
    const PrincipledDesc& p = desc.principled;
#define RT_NUMBER(member, usual) number(p.member);
#define RT_COLOR(member, usual) color(p.member);
    RT_PRINCIPLED_NUMBERS(RT_NUMBER)
    RT_PRINCIPLED_COLORS(RT_COLOR)
#undef RT_NUMBER
#undef RT_COLOR
    map(p.normalTexture);
    map(p.clearcoatNormalTexture);
    map(p.anisotropyTexture);
}

class MaterialTable {
  public:
    MaterialTable(const SceneDesc& desc, const CompileOptions& options, CompiledScene& out, TextureTable& textures);

    // The description behind a name; throws InputError when there is none.
    const MaterialDesc& find(const std::string& name) const;
    // The record of a description, which must stay where it is.
    std::uint32_t index(const MaterialDesc& desc);

    // What people call a description that is none of the scene's own.
    void setName(const MaterialDesc& desc, std::string name) { names_[&desc] = std::move(name); }

    // Whether texture coordinates matter to the material.
    bool mayShowImage(const MaterialDesc& desc) const;

    // Mean emitted radiance of a record.
    const glm::dvec3& meanEmission(std::uint32_t material) const { return meanEmission_[material]; }

  private:
    // The record beside the material that is about to be added.
    void addPrincipled(const PrincipledDesc& desc);
    std::uint32_t normalMap(const std::string& name); // kNone where there is none or it is grey
    void addAnisotropy(const PrincipledDesc& desc, shared::Principled& p);
    void addGlass(const PrincipledDesc& desc, shared::Principled& p);
    std::uint32_t glassTable(float ior); // first of its albedos

    const SceneDesc& desc_;
    const CompileOptions& options_;
    CompiledScene& out_;
    TextureTable& textures_;
    std::unordered_map<const MaterialDesc*, std::uint32_t> indices_;
    std::unordered_map<const MaterialDesc*, std::string> names_;
    std::map<float, std::uint32_t> glass_; // by index of refraction: first of glassAlbedos
    std::vector<glm::dvec3> meanEmission_;
};

} // namespace rt::scene
