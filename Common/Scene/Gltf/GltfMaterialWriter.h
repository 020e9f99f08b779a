// Materials of a scene as those of a glTF file: the reverse of GltfMaterials.
#pragma once
#include <map>
#include <string>
#include <utility>

#include "Common/Scene/Gltf/GltfDocument.h"
#include "Common/Scene/Gltf/GltfTextureWriter.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

class GltfMaterialWriter {
  public:
    // All must outlive this.
    GltfMaterialWriter(const SceneDesc& scene, const GltfImageTools& tools, GltfDocument& document,
                       GltfNotices& notices)
        : scene_(scene), document_(document), notices_(notices), textures_(scene, tools, document, notices) {}

    // Of models that objects name.
    void add(const std::map<std::string, MaterialDesc>& materials, const std::map<std::string, TextureDesc>& textures);

    // Throws InputError where there is none of that name.
    const MaterialDesc& find(const std::string& name) const;
    // Clear material whose index of refraction is below 1, as of a bubble in glass: what is inside is less dense. glTF
    // has an index of at least 1, so surfaces of it are turned inside out.
    bool isTurned(const std::string& name) const;
    bool showsImage(const std::string& name) const;

    // Of the document. `blends`: vertices of its surfaces have an opacity below 1.
    int index(const std::string& name, bool blends);

  private:
    OrderedJson write(const MaterialDesc& material, bool blends);
    OrderedJson writeUnlit(const MaterialDesc& material);
    void writeGlossiness(const MaterialDesc& material, OrderedJson& out);
    void writeBase(const MaterialDesc& material, OrderedJson& out);
    void writeAlpha(const PrincipledDesc& p, bool blends, OrderedJson& out) const;
    void writeEmission(const MaterialDesc& material, OrderedJson& out);
    void writeDielectric(const PrincipledDesc& p, OrderedJson& out);
    void writeTransmission(const PrincipledDesc& p, OrderedJson& out);
    void writeLayers(const PrincipledDesc& p, OrderedJson& out);
    void writeAnisotropy(const PrincipledDesc& p, OrderedJson& out);
    void writeIridescence(const PrincipledDesc& p, OrderedJson& out);

    // A number as factor times channel; the channel is added where there is one.
    double number(const NumberOrTexture& source, Channel slot, GltfChannels& channels);
    glm::dvec3 color(const ColorOrTexture& source, GltfChannels& channels);
    void setNumber(OrderedJson& target, const char* factor, const char* texture, const NumberOrTexture& source,
                   Channel slot, double usual);
    void setColor(OrderedJson& target, const char* factor, const char* texture, const ColorOrTexture& source,
                  double usual);
    void setTexture(OrderedJson& target, const char* texture, const GltfChannels& channels, ColorSpace space);
    void setNormals(OrderedJson& target, const char* texture, const std::string& name, double scale);
    void extend(OrderedJson& out, const char* extension, OrderedJson values);

    const SceneDesc& scene_;
    GltfDocument& document_;
    GltfNotices& notices_;
    GltfTextureWriter textures_;
    std::map<std::string, MaterialDesc> more_;
    std::map<std::pair<std::string, bool>, int> written_;
};

} // namespace rt::scene
