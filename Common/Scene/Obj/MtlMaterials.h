// Materials of MTL files as those of a scene.
#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "Common/Scene/Obj/MtlFile.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "Common/Scene/UniqueNames.h"

namespace rt::scene {

// Whether the colours of vertices multiply the colour of a material: not those of mirrors and glass.
bool takesVertexColors(const MaterialDesc& material);
// `material` as one that the colours of vertices multiply.
MaterialDesc withVertexColors(MaterialDesc material);

// Adds them to a model, which must outlive this; the names of materials and textures begin with `prefix`.
//
// What is no more than Kd, Ke and their maps becomes a lambertian. Ks, opacity, maps of normals and the PBR extension
// make a principled material, whose parameters are what Blender takes for its own: specular Ks, where 0.5 is what ior
// says, roughness 1 - sqrt(Ns / 1000), opacity d. illum 3, 5 and 8 are metals of the colour Ks, illum 4, 6, 7 and 9
// glass of the colour Tf; they become principled where they say more than `metal` and `dielectric` can. Pm outweighs
// what illum says of reflection.
class MtlMaterials {
  public:
    // Images are looked for in `folder` and beside the file that names them.
    MtlMaterials(const std::filesystem::path& folder, const std::string& prefix, ObjModel& model)
        : modelFolder_(folder), prefix_(prefix), model_(model) {}

    // Those of a file; throws InputError. Of materials with one name the last counts.
    void addFile(const std::filesystem::path& file);
    // Key of ObjModel::materials; null: no file has it.
    const std::string* find(std::string_view name) const;
    // Adds a white one, which the colours of vertices tint, and returns its key.
    std::string addWhite();
    // What had to be left out, as notices of the model.
    void appendNotices();

  private:
    MaterialDesc surface(const MtlMaterial& source);
    MaterialDesc glass(const MtlMaterial& source);
    MaterialDesc mirror(const MtlMaterial& source);
    MaterialDesc opaque(const MtlMaterial& source);
    void addLayers(const MtlMaterial& source, MaterialDesc& material);
    void addNormals(const MtlMaterial& source, MaterialDesc& material);
    void addOpacity(const MtlMaterial& source, MaterialDesc& material);
    ColorOrTexture color(const glm::dvec3& factor, const MtlMap& map, const char* keyword, ColorSpace space);
    NumberOrTexture number(std::optional<double> factor, double usual, const MtlMap& map, const char* keyword);
    std::string texture(const MtlMap& map, const char* keyword, ColorSpace space, const glm::dvec3& tint);

    const std::filesystem::path modelFolder_;
    const std::string& prefix_;
    ObjModel& model_;
    UniqueNames names_;
    std::map<std::string, std::string, std::less<>> keys_; // by name in the files
    std::filesystem::path folder_;                         // of the file at hand
    std::string key_;                                      // of the material at hand
    std::set<std::string> missing_;                        // images
    std::map<std::string, std::size_t> leftOut_;           // materials, by what
};

} // namespace rt::scene
