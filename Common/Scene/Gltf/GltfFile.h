// A file of glTF 2.0 as it is: parsed, and safe to follow.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "Common/Scene/Gltf/TinyGltf.h"

namespace rt::scene {

// As long as its byteLength says; empty where no file, data URI or chunk holds it, and then nothing refers to it.
struct GltfBuffer {
    std::shared_ptr<const std::vector<std::byte>> content; // which others may share
    std::span<const std::byte> bytes;                      // of the content
};

// At most one of three says where it is; none: it is missing.
struct GltfImage {
    std::string name;
    int bufferView = -1;
    std::string uri; // of a file of its own
    std::vector<std::byte> content;
};

struct GltfFile {
    std::filesystem::path path;
    tinygltf::Model model; // but for buffers and images; what checkGltf() promises holds
    std::vector<GltfBuffer> buffers;
    std::vector<GltfImage> images;
    std::map<int, std::vector<std::byte>> decoded; // of views whose bytes the buffers hold compressed, or not at all
    std::vector<std::string> notices;              // one line each
    std::uint64_t bytes = 0;                       // of the file and those of its buffers

    // Throws the InputError "FILE: /ARRAY/INDEX: MESSAGE".
    [[noreturn]] void fail(const std::string& place, const std::string& message) const;

    // Of a buffer view.
    std::span<const std::byte> view(int bufferView) const;
};

// Reads .gltf and .glb, which the first bytes tell apart, and buffers in other files, as readFile() allows. Throws
// InputError naming file and place.
GltfFile readGltf(const std::filesystem::path& path);

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
