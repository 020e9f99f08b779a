#include "Common/Scene/Pbrt/PbrtFiles.h"

#include <algorithm>

#include "Common/Core/OtherCase.h"
#include "Common/Core/Printable.h"
#include "Common/Core/ReadFile.h"

namespace rt::scene {

namespace fs = std::filesystem;

PbrtFiles::PbrtFiles(const fs::path& scene) : folder_(fs::absolute(scene).parent_path()) {}

fs::path PbrtFiles::locate(const std::string& name, const PbrtPlace& place) {
    std::string text = name;
    std::replace(text.begin(), text.end(), '\\', '/');
    const fs::path file(text);
    if (text.empty() || text.find('\0') != text.npos)
        place.fail('"' + printable(name, 200) + "\": must be the path of a file");
    fs::path first;
    for (const fs::path& folder : {folder_, fs::absolute(fs::path(*place.file)).parent_path()}) {
        fs::path path = (folder / file).lexically_normal();
        // Of files that must not be read nobody learns whether they exist: they are refused when they are opened.
        if (!mayRead(path) || isFile(path)) return path;
        if (first.empty()) first = path;
    }
    fs::path other = findInOtherCase(first);
    if (other.empty() || !mayRead(other)) return first;
    inOtherCase_.insert(name);
    return other;
}

fs::path PbrtFiles::existing(const std::string& name, const PbrtPlace& place) {
    fs::path path = locate(name, place);
    if (mayRead(path) && !isFile(path))
        place.fail('"' + printable(name, 200) + "\": must be an existing file; looked for at " + path.string());
    return path;
}

} // namespace rt::scene
