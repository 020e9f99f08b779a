// The nodes of a MaterialX document, and what the inputs of a surface get from them: constants and images.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "Common/Scene/MaterialX/XmlText.h"
#include "Common/Scene/SceneDesc.h"

namespace rt::scene {

// What an input gets: a constant, or an image times one. Numbers have four equal components.
struct MaterialXSignal {
    glm::dvec4 factor{1};
    std::optional<ImageTexture> image; // whose own tint stays white
    std::string imageNode;             // its name
    std::optional<Channel> channel;    // the only one that counts
    bool isInverted = false;           // 1 - all that, with an image
    bool isNormalMap = false;          // 2 rgb - 1 of the image is a normal in its own frame
};

class MaterialXGraph {
  public:
    // Notices are added to. All must outlive this. `file` stands in messages, images lie in `folder`.
    MaterialXGraph(const XmlElement& root, const std::string& file, const std::filesystem::path& folder,
                   std::set<std::string>& notices);

    // The node that an input of the document's own nodes is connected to; null: it has a value, or there is none.
    const XmlElement* source(const XmlElement& input) const;
    // Of an input of a node of the document: nothing where it gets what cannot be had here, which a notice tells.
    std::optional<MaterialXSignal> signal(const XmlElement& node, const XmlElement& input);

    bool flag(const XmlElement& node, const XmlElement& input) const; // "true" or "false"

    // "FILE:LINE: <NODE "NAME">: MESSAGE"
    [[noreturn]] void fail(const XmlElement& element, const std::string& message) const;

  private:
    // What surrounds a node: the document, or a graph of nodes in it.
    struct Scope {
        const XmlElement* nodes = nullptr;
        const XmlElement* outer = nullptr; // the node of the document whose inputs a graph has; null: none
    };
    using Names = std::map<std::string_view, const XmlElement*>;

    const XmlElement* find(const XmlElement& scope, const std::string& name) const; // null: there is none
    const XmlElement& findOrFail(const XmlElement& scope, const std::string& name, const XmlElement& asker) const;
    std::optional<MaterialXSignal> follow(const Scope& scope, const XmlElement& node, const XmlElement& input);
    std::optional<MaterialXSignal> node(const Scope& scope, const XmlElement& node, const std::string& output);
    std::optional<MaterialXSignal> inner(const Scope& scope, const XmlElement& node, const char* input);
    std::optional<MaterialXSignal> imageOf(const Scope& scope, const XmlElement& node);
    std::optional<MaterialXSignal> channelOfInner(const Scope& scope, const XmlElement& node, std::size_t channel);
    MaterialXSignal channelOf(const XmlElement& node, MaterialXSignal signal, std::size_t channel) const;
    std::optional<MaterialXSignal> swizzled(const XmlElement& node, const MaterialXSignal& signal,
                                            const std::string& channels);
    std::optional<MaterialXSignal> product(const Scope& scope, const XmlElement& node);
    std::optional<MaterialXSignal> inverse(const Scope& scope, const XmlElement& node);
    std::optional<MaterialXSignal> normalMap(const Scope& scope, const XmlElement& node);
    void placeImage(const Scope& scope, const XmlElement& node, ImageTexture& image);
    glm::dvec4 constant(const Scope& scope, const XmlElement& node, const XmlElement& input) const;
    glm::dvec4 constantOr(const Scope& scope, const XmlElement& node, const char* input, const glm::dvec4& usual);
    std::string inherited(const Scope& scope, const XmlElement& node, const XmlElement* input,
                          const char* attribute) const;
    void leaveOut(const XmlElement& node, const std::string& what);

    const XmlElement& root_;
    const std::string& file_;
    const std::filesystem::path& folder_;
    std::set<std::string>& notices_;
    std::unordered_map<const XmlElement*, Names> names_; // of the document and its graphs
    int depth_ = 0, steps_ = 0;                          // of the input that is followed
};

} // namespace rt::scene
