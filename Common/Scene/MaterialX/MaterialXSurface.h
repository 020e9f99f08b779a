// One surface of a MaterialX document as a material of a scene.
#pragma once
#include <set>
#include <string>

#include "Common/Scene/MaterialX/MaterialXGraph.h"
#include "Common/Scene/MaterialX/MaterialXModels.h"
#include "Common/Scene/UniqueNames.h"

namespace rt::scene {

class MaterialXSurface {
  public:
    // Textures are added to the scene, under free names. All must outlive this.
    MaterialXSurface(MaterialXGraph& graph, const MaterialXModel& model, const XmlElement& node, SceneDesc& scene,
                     UniqueNames& names, std::set<std::string>& notices)
        : graph_(graph), model_(model), node_(node), scene_(scene), names_(names), notices_(notices) {}

    MaterialDesc material();

  private:
    // Of an input; nothing where the node does not have it or what it gets is left out.
    std::optional<MaterialXSignal> signal(const MaterialXInput& input);
    double constant(const MaterialXInput& input, double least, double most); // without an image
    glm::dvec3 constantColor(const MaterialXInput& input, double most);
    NumberOrTexture number(const MaterialXInput& input); // in [0,1]
    // Times a constant; in [0,1].
    ColorOrTexture color(const MaterialXInput& input, const glm::dvec3& weight);
    std::string normals(const MaterialXInput& input, double& scale);
    std::string texture(const MaterialXSignal& signal, const glm::dvec3& tint, ColorSpace space);

    void addBase(MaterialDesc& material);
    void addTransmission(MaterialDesc& material);
    void addCoatAndSheen(MaterialDesc& material);
    void addEmission(MaterialDesc& material);
    void addOpacity(PrincipledDesc& p);
    void addFilm(PrincipledDesc& p);
    void addDispersion(PrincipledDesc& p);
    void addAnisotropy(PrincipledDesc& p);
    void addNotices();
    void leaveOut(const MaterialXInput& input, const std::string& what);

    MaterialXGraph& graph_;
    const MaterialXModel& model_;
    const XmlElement& node_;
    SceneDesc& scene_;
    UniqueNames& names_;
    std::set<std::string>& notices_;
};

} // namespace rt::scene
