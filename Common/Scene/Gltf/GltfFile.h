// A file of glTF 2.0 as it is: parsed, and safe to follow.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "Common/Scene/Gltf/TinyGltf.h"

namespace rt::scene {

struct GltfFile {
    std::filesystem::path path;
    // What checkGltf() promises holds, and every buffer is as long as it says.
    tinygltf::Model model;
    std::vector<std::string> notices; // one line each
    std::uint64_t bytes = 0;          // of the file and its buffers

    // Throws the InputError "FILE: /ARRAY/INDEX: MESSAGE".
    [[noreturn]] void fail(const std::string& place, const std::string& message) const;

    // Of a buffer view.
    std::span<const std::byte> view(int bufferView) const;
};

// Reads .gltf and .glb, which the first bytes tell apart, and buffers in other files, as readFile() allows. Throws
// InputError naming file and place.
GltfFile readGltf(const std::filesystem::path& path);

// The file that a URI beside `path` names; throws InputError for what is no relative path.
std::filesystem::path besideGltf(const std::filesystem::path& path, const std::string& uri);

// The images inside a file of glTF.
class GltfImages {
  public:
    explicit GltfImages(const std::filesystem::path& path) : file_(readGltf(path)) {}

    // PNG or JPEG as it lies in the file; valid as long as this. Throws InputError where there is none inside.
    std::span<const std::byte> encoded(std::uint32_t image) const;

  private:
    GltfFile file_;
};

} // namespace rt::scene
