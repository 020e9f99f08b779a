// Materials of MTL files as those of a scene.
#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "Common/Scene/Obj/MtlFile.h"
#include "Common/Scene/Obj/ObjFiles.h"
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
// says, roughness 1 - sqrt(Ns / 1000), opacity d. illum 0 is as bright as Kd, 1 has no highlight, 3, 5 and 8 mirror Ks,
// above Kd where that is said, 6 and 7 are glass of the colour Tf, and so are 4 and 9 where there is no Kd. docs/obj.md
// has them all. Pm outweighs what illum says of reflection, and Ke that there is no shading.
class MtlMaterials {
  public:
    // Images are looked for in `folder` and beside the file that names them.
    MtlMaterials(const std::filesystem::path& folder, const std::string& prefix, FileFinder& files, ObjModel& model)
        : modelFolder_(folder), prefix_(prefix), files_(files), model_(model) {}

    // Those of a file; throws InputError. Of materials with one name the last counts.
    void addFile(const std::filesystem::path& file);
    // Key of ObjModel::materials; null: no file has it. A name that no material has is looked for without a comment
    // behind it and in other case.
    const std::string* find(const std::string& name);
    // Key of a white one, which the colours of vertices tint.
    const std::string& white();
    bool isUnlit(const std::string& key) const { return unlit_.count(key) > 0; } // as bright as its colour
    // Key of the same material without its maps; the same key where it has none.
    const std::string& withoutMaps(const std::string& key);
    // What had to be left out of the materials that find() has found, as notices of the model.
    void appendNotices();

  private:
    MaterialDesc surface(const MtlMaterial& source);
    MaterialDesc unlit(const MtlMaterial& source);
    MaterialDesc glass(const MtlMaterial& source);
    MaterialDesc mirror(const MtlMaterial& source);
    MaterialDesc coated(const MtlMaterial& source);
    MaterialDesc opaque(const MtlMaterial& source);
    void addLayers(const MtlMaterial& source, MaterialDesc& material);
    ColorOrTexture diffuse(const MtlMaterial& source);
    void addNormals(const MtlMaterial& source, MaterialDesc& material);
    void addOpacity(const MtlMaterial& source, MaterialDesc& material);
    ColorOrTexture color(const glm::dvec3& factor, const MtlMap& map, const char* keyword, ColorSpace space);
    NumberOrTexture number(std::optional<double> factor, double usual, const MtlMap& map, const char* keyword);
    std::string texture(const MtlMap& map, const char* keyword, ColorSpace space, const glm::dvec3& tint);

    const std::filesystem::path modelFolder_;
    const std::string& prefix_;
    FileFinder& files_;
    ObjModel& model_;
    UniqueNames names_;
    std::map<std::string, std::string> keys_;        // by name in the files
    std::map<std::string, std::string> bareKeys_;    // by name without a comment
    std::map<std::string, std::string> lowerKeys_;   // by name in lower case
    std::map<std::string, MtlMaterial> sources_;     // by key
    std::map<std::string, std::string> withoutMaps_; // keys by key of those with them
    std::set<std::string> unlit_;                    // keys
    std::set<std::string> used_;                     // keys
    std::string white_;                              // key; empty: there is none yet
    std::filesystem::path folder_;                   // of the file at hand
    std::string key_;                                // of the material at hand
    std::set<std::string> missing_;                  // images
    std::set<std::string> inOtherCase_;              // names of materials as they are used
};

} // namespace rt::scene
