// The text of an XML document as a tree of elements with their attributes; whatever text is between them is left out.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rt::scene {

struct XmlElement {
    std::string name;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::vector<XmlElement> children;
    std::size_t line = 0; // that it begins in, from 1

    const std::string* find(std::string_view attribute) const; // null: it has none of that name
    std::string attribute(std::string_view attribute) const;   // empty likewise
    const XmlElement* child(std::string_view element, std::string_view nameAttribute) const; // null likewise
};

// The root. Throws InputError, "FILE:LINE: ...": for syntax, for elements nested deeper than 64, for more than a
// million of them, and where the build has no pugixml.
XmlElement parseXml(std::string_view text, const std::string& file);
std::string toXml(const XmlElement& root);

} // namespace rt::scene
