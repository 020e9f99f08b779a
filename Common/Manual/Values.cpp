#include "Common/Manual/Values.h"

#include <algorithm>
#include <sstream>

namespace rt::manual {
namespace {

std::vector<std::string> partsOf(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
    return parts;
}

bool isTyped(const std::string& word) {
    return std::any_of(word.begin(), word.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
}

} // namespace

ValueForm formOf(const std::string& value) {
    ValueForm form;
    if (value == "SCENE") {
        form.kind = ValueForm::Kind::Scene;
        form.endings = {".json", ".obj", ".gltf", ".glb", ".pbrt", ".pbrt.gz"};
    } else if (value == "DIR") {
        form.kind = ValueForm::Kind::Folder;
    } else if (value == "F" || value.starts_with("F.")) {
        form.kind = ValueForm::Kind::File;
        form.endings = partsOf(value.substr(1), '|');
    } else {
        form.isList = value.find('|') == std::string::npos && value.find(',') != std::string::npos;
        form.words = partsOf(value, form.isList ? ',' : '|');
        std::erase_if(form.words, isTyped);
        if (!form.words.empty()) form.kind = ValueForm::Kind::Words;
    }
    return form;
}

} // namespace rt::manual
