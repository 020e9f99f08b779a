#include "Common/Scene/MaterialX/XmlText.h"

#include <algorithm>
#include <sstream>

#ifdef RT_HAS_PUGIXML
#include <pugixml.hpp>
#endif

#include "Common/Core/Error.h"

namespace rt::scene {

const std::string* XmlElement::find(std::string_view wanted) const {
    for (const auto& [key, value] : attributes)
        if (key == wanted) return &value;
    return nullptr;
}

std::string XmlElement::attribute(std::string_view wanted) const {
    const std::string* found = find(wanted);
    return found != nullptr ? *found : std::string();
}

const XmlElement* XmlElement::child(std::string_view element, std::string_view nameAttribute) const {
    for (const XmlElement& each : children)
        if (each.name == element && each.attribute("name") == nameAttribute) return &each;
    return nullptr;
}

#ifdef RT_HAS_PUGIXML

namespace {

constexpr int kMaxXmlDepth = 64;
constexpr std::size_t kMaxXmlElements = 1'000'000;

// Elements in the order of the text, so that its lines are counted once.
class XmlTree {
  public:
    XmlTree(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    XmlElement convert(const pugi::xml_node& node, int depth) {
        XmlElement element;
        element.name = node.name();
        element.line = lineAt(node.offset_debug());
        if (depth > kMaxXmlDepth) fail(element.line, "elements are nested deeper than 64");
        if (++count_ > kMaxXmlElements) fail(element.line, "there are more than a million elements");
        for (const pugi::xml_attribute& attribute : node.attributes())
            element.attributes.emplace_back(attribute.name(), attribute.value());
        for (const pugi::xml_node& child : node.children())
            if (child.type() == pugi::node_element) element.children.push_back(convert(child, depth + 1));
        return element;
    }
    std::size_t lineAt(std::ptrdiff_t offset) {
        const std::size_t to = std::clamp(static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)), counted_,
                                          std::max(counted_, text_.size()));
        line_ += static_cast<std::size_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                                     text_.begin() + static_cast<std::ptrdiff_t>(to), '\n'));
        counted_ = to;
        return line_;
    }
    [[noreturn]] void fail(std::size_t line, const std::string& message) const {
        throw InputError(file_ + ":" + std::to_string(line) + ": " + message);
    }

  private:
    std::string_view text_;
    const std::string& file_;
    std::size_t counted_ = 0, line_ = 1; // bytes that have been looked through, and the line that they end in
    std::size_t count_ = 0;
};

void appendElement(const XmlElement& element, pugi::xml_node parent) {
    pugi::xml_node node = parent.append_child(element.name.c_str());
    for (const auto& [key, value] : element.attributes) node.append_attribute(key.c_str()) = value.c_str();
    for (const XmlElement& child : element.children) appendElement(child, node);
}

} // namespace

XmlElement parseXml(std::string_view text, const std::string& file) {
    XmlTree tree(text, file);
    pugi::xml_document document;
    // As UTF-8, which offsets are of then.
    const pugi::xml_parse_result result =
        document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!result) tree.fail(tree.lineAt(result.offset), std::string("no valid XML: ") + result.description());
    const pugi::xml_node root = document.document_element();
    if (!root) tree.fail(1, "no valid XML: there is no element");
    return tree.convert(root, 0);
}

std::string toXml(const XmlElement& root) {
    pugi::xml_document document;
    appendElement(root, document);
    std::ostringstream out;
    document.save(out, "  ", pugi::format_default, pugi::encoding_utf8);
    return out.str();
}

#else

XmlElement parseXml(std::string_view, const std::string& file) {
    throw InputError(file + ": is XML, which this build lacks: pugixml was not there when it was made");
}

std::string toXml(const XmlElement&) {
    throw InputError("this build writes no XML: pugixml was not there when it was made");
}

#endif

} // namespace rt::scene
