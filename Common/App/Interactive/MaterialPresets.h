// The library of materials: those of the scene files in the folder Assets/materials.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "Common/Scene/SceneDesc.h"

namespace rt::app {

struct MaterialPreset {
    std::string name;   // in its file
    std::string group;  // the title of the file
    std::string source; // where its numbers come from: what the file's comment says behind "NAME: "; may be empty
    std::shared_ptr<const scene::SceneDesc> scene; // which holds it, with its textures

    std::string picture() const; // the name of its thumbnail, without ".png": "brushed-aluminium"
    // Whether each word of the search is in its name, its group or what it is.
    bool matches(const std::string& search) const;
};

// Of all scene files of a folder, by the names of these; within a file in the order of the lines of its comment that
// begin with "NAME: ". A file that cannot be read is left out, and `failures` gets a line that says why.
std::vector<MaterialPreset> readMaterialPresets(const std::filesystem::path& folder,
                                                std::vector<std::string>& failures);
// The folder "materials" of the assets; empty where there is none.
std::filesystem::path materialPresetFolder();

} // namespace rt::app
